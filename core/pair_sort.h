// Sorting pairs of triangle indices: the one order in which FAR pairs answers.
#pragma once

#include <span>
#include <vector>

#include "core/scene.h"

namespace farcull {

/// All pairs of the parts, sorted by (a, b), each once. Linear in the pairs and the range of a
/// where there are many pairs. The answer does not depend on `threads` (0: as many as there are
/// cores).
std::vector<TrianglePair> sorted_unique(std::span<const std::vector<TrianglePair>> parts,
                                        unsigned threads);

}  // namespace farcull
