// The meshes of a suite: kinds that people have (scans, cloth, ropes, plates) and kinds that are
// hard (shells, folds, fans, duplicates), each with a number that goes to an extreme.
#pragma once

#include <string>
#include <vector>

#include "experiments/generators/draws.h"

namespace farcull {

/// An object of a mesh.
struct SuiteObject {
  std::vector<Vec3> vertices;                           // finite
  std::vector<std::array<std::uint32_t, 3>> triangles;  // indices into vertices; at least one

  void add(std::uint32_t i, std::uint32_t j, std::uint32_t k) { triangles.push_back({i, j, k}); }
};

struct MeshFamily {
  std::string name;
  std::string description;  // one line
  std::string parameter;    // the meaning of its number
  bool self = false;        // its objects are tested against themselves too
  /// The objects; `detail` says how fine, each family counts it in its own way.
  std::vector<SuiteObject> (*make)(SuiteDraws& draws, double parameter, int detail);
  struct Member {
    double parameter = 0;
    int detail = 0;
  };
  std::vector<Member> members;
  bool small = false;  // the first member is in a small suite too
};

/// In the order of the names.
const std::vector<MeshFamily>& mesh_families();

/// The objects of member `index` of a family. They depend on the seed and these two alone. In a
/// mesh that is tested against itself, vertices at one position are one vertex.
std::vector<SuiteObject> make_suite_mesh(const MeshFamily& family, std::uint64_t seed,
                                         std::size_t index);

// The families by their files.
std::vector<MeshFamily> surface_families();  // of two or three objects
std::vector<MeshFamily> self_families();     // of one that is tested against itself

}  // namespace farcull
