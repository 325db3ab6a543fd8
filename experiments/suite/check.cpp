// A suite read back, with every label decided anew.
#include <fmt/format.h>

#include <algorithm>

#include "core/base/error.h"
#include "core/base/parallel.h"
#include "experiments/suite/label.h"
#include "experiments/suite/writer.h"

namespace farcull {
namespace {

constexpr const char* kAgain = "correct the label, or write the suite again";

void check_pair(const SuitePair& pair, const std::string& path) {
  if (!pair.shared.empty() && pair.shared != equal_corners(pair.a, pair.b)) {
    throw Error(path, fmt::format("pair {} has equal corners that are not called shared", pair.id),
                "call all of them shared, or none", pair.line);
  }
  const SuiteKind kind = decide(pair, path);
  if (pair.kind == SuiteKind::unlabelled || pair.kind == kind) return;
  throw Error(path,
              fmt::format("pair {} is called {}, and it is {}", pair.id, to_string(pair.kind),
                          to_string(kind)),
              kAgain, pair.line);
}

void check_pairs(const SuitePairs& pairs, const std::string& path) {
  const std::size_t count = pairs.pairs.size();
  for_chunks(count, chunks_for(count, 64), [&](std::size_t, std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) check_pair(pairs.pairs[i], path);
  });
}

std::string named(const Scene& scene, const TrianglePair& pair) {
  const std::vector<std::uint32_t> owner = owners(scene);
  std::string out;
  for (const std::uint32_t t : {pair.a, pair.b}) {
    const Object& object = scene.objects[owner[t]];
    out += fmt::format("{}{},{}", out.empty() ? "" : ",", object.name, t - object.first_triangle);
  }
  return out;
}

void check_mesh(const SuiteMesh& mesh, const std::string& path) {
  const std::vector<SuiteMeshPair> right = decide_mesh(mesh.scene, path);
  if (!mesh.labelled) return;
  const auto [in_list, in_right] =
      std::mismatch(mesh.pairs.begin(), mesh.pairs.end(), right.begin(), right.end());
  if (in_list == mesh.pairs.end() && in_right == right.end()) return;
  const bool missing =
      in_right != right.end() && (in_list == mesh.pairs.end() || in_right->pair < in_list->pair);
  // The header is line 1.
  const long line = 2 + static_cast<long>(in_list - mesh.pairs.begin());
  throw Error(
      path + "/pairs.csv",
      missing
          ? fmt::format("the pair {} collides and is missing", named(mesh.scene, in_right->pair))
          : fmt::format("the pair {} does not collide", named(mesh.scene, in_list->pair)),
      kAgain, line);
}

}  // namespace

SuiteSummary check_suite(const std::string& folder, const Progress& progress) {
  SuiteSummary out;
  out.index = read_suite(folder);
  check_files(folder, out.index);
  const auto require_items = [&](const std::string& path, std::uint64_t items) {
    for (const SuiteIndex::File& file : out.index.files) {
      if (file.path != path || file.items == items) continue;
      throw Error(folder + "/" + path,
                  fmt::format("has {} items; suite.txt says {}", items, file.items), kAgain);
    }
  };
  for (const std::string& file : out.index.pair_files()) {
    if (progress) progress(file);
    const SuitePairs pairs = read_pairs(folder + "/" + file);
    require_items(file, pairs.pairs.size());
    check_pairs(pairs, folder + "/" + file);
    out.families.push_back(counts_of(pairs));
  }
  for (const std::string& name : out.index.mesh_folders()) {
    if (progress) progress(name);
    const SuiteMesh mesh = read_mesh(folder + "/" + name);
    for (const Object& object : mesh.scene.objects)
      require_items(name + "/" + object.name + ".obj", object.triangle_count);
    require_items(name + "/pairs.csv", mesh.pairs.size());
    check_mesh(mesh, folder + "/" + name);
    out.meshes.push_back(counts_of(mesh));
  }
  return out;
}

}  // namespace farcull
