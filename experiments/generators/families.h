// The families of a suite: of pairs, and of meshes. Each makes what meets and what does not, and
// most have a number that goes to an extreme.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "experiments/generators/draws.h"

namespace farcull {

struct MadePair : DrawnPair {
  bool neighbours = false;  // corners at equal positions are one vertex of a mesh
};

struct PairFamily {
  std::string name;
  std::string description;     // one line
  std::string parameter;       // the meaning of its number; "" for none
  std::vector<double> values;  // of the number; pair i has the i-th, and they come again and again
  MadePair (*make)(RandomDraws& draws, double parameter);
};

/// In the order of the files.
const std::vector<PairFamily>& pair_families();

/// A seed for one item of a suite, from the seed of the suite, a name and a number.
std::uint64_t seed_of_item(std::uint64_t seed, std::string_view name, std::uint64_t number);

/// An object of a mesh.
struct SuiteObject {
  std::vector<Vec3> vertices;                           // finite
  std::vector<std::array<std::uint32_t, 3>> triangles;  // indices into vertices; at least one

  void add(std::uint32_t i, std::uint32_t j, std::uint32_t k) { triangles.push_back({i, j, k}); }
};

/// Kinds of meshes that people have (scans, cloth, ropes, plates), or that are hard (shells, folds,
/// fans, duplicates).
struct MeshFamily {
  std::string name;
  std::string description;  // one line
  std::string parameter;    // the meaning of its number
  bool self = false;        // its objects are tested against themselves too
  /// The objects; `detail` says how fine, each family counts it in its own way.
  std::vector<SuiteObject> (*make)(RandomDraws& draws, double parameter, int detail);
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

// Parts of pair_families(): distance_families() has gaps, distances from the origin and scales,
// shape_families() random triangles, slivers, degenerate triangles and folds.
std::vector<PairFamily> distance_families();
std::vector<PairFamily> shape_families();

}  // namespace farcull
