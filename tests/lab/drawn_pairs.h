// Pairs of triangles that are hard to decide, by generators with names.
#pragma once

#include "experiments/generators/pair_generators.h"

namespace farcull {

struct PairGenerator {
  std::string name;
  DrawnPair (*make)(RandomDraws&);
};

/// Each generator makes pairs that meet and pairs that do not, at least one in fifty of each kind.
const std::vector<PairGenerator>& pair_generators();

}  // namespace farcull
