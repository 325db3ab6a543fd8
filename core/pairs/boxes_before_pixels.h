// Boxes before pixels: what the boxes of triangles settle is neither fattened nor drawn.
#pragma once

#include <cstdint>
#include <span>

#include "core/scene/scene.h"
#include "core/view/regions.h"

namespace farcull {

struct NarrowedRegions {
  /// False: boxes of blocks decide little here (too many of them overlap, or triangles lie too
  /// unevenly), so the regions are as they were.
  bool narrowed = false;
  std::uint64_t pairs = 0;  // of triangles of different objects whose boxes overlap; those of
                            // objects that boxes of blocks do not decide are not counted
};

/// Takes out of the regions the triangles whose boxes meet no box of a triangle of another object,
/// and makes the places those in which the boxes of two that stay meet. No triangle of a colliding
/// pair is taken out, and every common point of one lies in a place; where two objects are compared
/// by boxes of objects alone, that is so already. Preconditions: regions are those of the scene,
/// without `self` and `full`; ignored: as in_order() gives them, whose pairs do not count.
/// threads: 0 for as many as there are cores.
NarrowedRegions narrow_regions(const Scene& scene, std::span<const ObjectPair> ignored,
                               unsigned threads, Regions& regions);

}  // namespace farcull
