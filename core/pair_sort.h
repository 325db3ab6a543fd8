// Sorting pairs of triangle indices: the one order in which FAR pairs answers.
#pragma once

#include <cstdint>
#include <vector>

#include "core/scene.h"

namespace farcull {

/// Sorts by (a, b) and drops duplicates. `triangles` bounds the indices. Linear in pairs +
/// triangles where there are many pairs.
void sort_unique(std::vector<TrianglePair>& pairs, std::size_t triangles);

}  // namespace farcull
