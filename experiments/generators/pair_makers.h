// The families of pairs of a suite. Each makes pairs that meet and pairs that do not, and most have
// a number that goes to an extreme.
#pragma once

#include <string>
#include <vector>

#include "experiments/generators/draws.h"

namespace farcull {

/// Two triangles before anything is decided about them.
struct MadePair {
  std::array<Vec3, 3> a, b;  // finite
  bool neighbours = false;   // corners at equal positions are one vertex of a mesh
};

struct PairFamily {
  std::string name;
  std::string description;     // one line
  std::string parameter;       // the meaning of its number; "" for none
  std::vector<double> values;  // of the number; pair i has the i-th, and they come again and again
  MadePair (*make)(SuiteDraws& draws, double parameter);
};

/// In the order of the files.
const std::vector<PairFamily>& pair_families();

/// A seed for one item of a suite, from the seed of the suite, a name and a number.
std::uint64_t seed_of_item(std::uint64_t seed, std::string_view name, std::uint64_t number);

// The families by their files.
std::vector<PairFamily> contact_families();   // one common point, and what lies in one plane
std::vector<PairFamily> distance_families();  // gaps, distances from the origin, scales
std::vector<PairFamily> shape_families();     // random, slivers, degenerate triangles, folds

}  // namespace farcull
