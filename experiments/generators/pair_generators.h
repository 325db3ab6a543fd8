// Pairs of triangles that are hard to decide: generators by name, for tests and for running the
// exact oracles against each other.
#pragma once

#include <string>
#include <vector>

#include "experiments/generators/draws.h"

namespace farcull {

struct PairGenerator {
  std::string name;
  std::string description;  // one line
  DrawnPair (*make)(RandomDraws&);
};

/// Each makes pairs that meet and pairs that do not; in every one, either is at least one in fifty.
const std::vector<PairGenerator>& pair_generators();

}  // namespace farcull
