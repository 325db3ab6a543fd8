// The families and meshes of a suite with their labels. Pairs are decided on all cores; each stands
// in its own place, so the order is that of their IDs.
#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>

#include "core/base/parallel.h"
#include "experiments/generators/mesh_makers.h"
#include "experiments/generators/pair_makers.h"
#include "experiments/scenes/mesh/scene_build.h"
#include "experiments/scenes/mesh/shapes.h"
#include "experiments/suite/label.h"
#include "experiments/suite/writer.h"

namespace farcull {
namespace {

/// Of 19 families: 10070 pairs, and 1007000.
std::uint64_t pairs_per_family(SuiteSize size) { return size == SuiteSize::small ? 530 : 53000; }

std::size_t members(const MeshFamily& family, SuiteSize size) {
  return size == SuiteSize::full ? family.members.size() : family.small ? 1 : 0;
}

std::string mesh_name(const MeshFamily& family, std::size_t index) {
  return fmt::format("{}-{}", family.name, index + 1);
}

void shuffle(SuiteDraws& draws, std::array<Vec3, 3>& t) {
  std::swap(t[0], t[draws.below(3)]);
  std::swap(t[1], t[1 + draws.below(2)]);
}

}  // namespace

SuiteCounts counts_of(const SuitePairs& pairs) {
  SuiteCounts out;
  out.name = pairs.family;
  out.pairs = pairs.pairs.size();
  for (const SuitePair& pair : pairs.pairs) {
    ++out.kinds[static_cast<std::size_t>(pair.kind)];
    out.colliding += pair.kind != SuiteKind::unlabelled && collides(pair.kind);
  }
  return out;
}

SuiteCounts counts_of(const SuiteMesh& mesh) {
  SuiteCounts out;
  out.name = mesh.name;
  out.triangles = mesh.scene.triangles.size();
  out.pairs = out.colliding = mesh.pairs.size();
  for (const SuiteMeshPair& pair : mesh.pairs) out.neighbours += pair.shared > 0;
  return out;
}

SuitePair make_suite_pair(const PairFamily& family, std::uint64_t seed, std::uint64_t id) {
  SuiteDraws draws(seed_of_item(seed, family.name, id));
  SuitePair out;
  out.id = id;
  out.parameter = family.values[id % family.values.size()];
  MadePair made = family.make(draws, out.parameter);
  shuffle(draws, made.a);
  shuffle(draws, made.b);
  if (draws.chance(2)) std::swap(made.a, made.b);
  out.a = made.a;
  out.b = made.b;
  if (made.neighbours) out.shared = equal_corners(out.a, out.b);
  return out;
}

SuitePairs make_pairs(const std::string& family, const SuiteSettings& settings) {
  const std::vector<PairFamily>& all = pair_families();
  const auto found =
      std::find_if(all.begin(), all.end(), [&](const PairFamily& x) { return x.name == family; });
  if (found == all.end()) throw std::logic_error("make_pairs: no family " + family);
  SuitePairs out;
  out.family = family;
  out.pairs.resize(pairs_per_family(settings.size));
  const std::size_t count = out.pairs.size();
  for_chunks(count, chunks_for(count, 64), [&](std::size_t, std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      SuitePair pair = make_suite_pair(*found, settings.seed, i);
      pair.kind = decide(pair, fmt::format("pair {} of {}", i, family));
      out.pairs[i] = std::move(pair);
    }
  });
  return out;
}

std::vector<std::string> mesh_names(SuiteSize size) {
  std::vector<std::string> out;
  for (const MeshFamily& family : mesh_families()) {
    for (std::size_t i = 0; i < members(family, size); ++i) out.push_back(mesh_name(family, i));
  }
  std::sort(out.begin(), out.end());
  return out;
}

SuiteMesh make_mesh(const std::string& name, const SuiteSettings& settings) {
  for (const MeshFamily& family : mesh_families()) {
    for (std::size_t i = 0; i < members(family, settings.size); ++i) {
      if (mesh_name(family, i) != name) continue;
      SuiteMesh out;
      out.name = name;
      out.family = family.name;
      out.parameter = family.members[i].parameter;
      out.self = family.self;
      SceneBuilder builder(name, name);
      int number = 0;
      for (SuiteObject& object : make_suite_mesh(family, settings.seed, i)) {
        builder.add(shapes::finished(std::move(object.vertices), std::move(object.triangles)),
                    std::to_string(number++), Split::kNone, {}, family.self);
      }
      out.scene = builder.finish();
      out.pairs = decide_mesh(out.scene, name);
      return out;
    }
  }
  throw std::logic_error("make_mesh: no mesh " + name);
}

}  // namespace farcull
