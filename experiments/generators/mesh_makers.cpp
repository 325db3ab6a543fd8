// The list of all families of meshes, and the joining of vertices at one position.
#include "experiments/generators/mesh_makers.h"

#include <algorithm>
#include <iterator>
#include <map>
#include <utility>

#include "experiments/generators/pair_makers.h"

namespace farcull {
namespace {

/// Vertices at one position become the first of them, and those that no triangle uses are left out.
void join_vertices(SuiteObject& object) {
  std::map<std::array<double, 3>, std::uint32_t> first;
  std::vector<Vec3> kept;
  for (auto& triangle : object.triangles) {
    for (std::uint32_t& v : triangle) {
      const Vec3& p = object.vertices[v];
      const auto [at, is_new] = first.try_emplace({p.x(), p.y(), p.z()}, kept.size());
      if (is_new) kept.push_back(p);
      v = at->second;
    }
  }
  object.vertices = std::move(kept);
}

}  // namespace

const std::vector<MeshFamily>& mesh_families() {
  static const std::vector<MeshFamily> families = [] {
    std::vector<MeshFamily> out = surface_families();
    std::vector<MeshFamily> more = self_families();
    out.insert(out.end(), std::make_move_iterator(more.begin()),
               std::make_move_iterator(more.end()));
    std::sort(out.begin(), out.end(),
              [](const MeshFamily& x, const MeshFamily& y) { return x.name < y.name; });
    return out;
  }();
  return families;
}

std::vector<SuiteObject> make_suite_mesh(const MeshFamily& family, std::uint64_t seed,
                                         std::size_t index) {
  SuiteDraws draws(seed_of_item(seed, "mesh " + family.name, index));
  const MeshFamily::Member& member = family.members.at(index);
  std::vector<SuiteObject> out = family.make(draws, member.parameter, member.detail);
  if (family.self) {
    for (SuiteObject& object : out) join_vertices(object);
  }
  return out;
}

}  // namespace farcull
