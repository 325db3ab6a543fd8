// Boxes before pixels: FAR draws no triangle whose box meets no box of a triangle that it can
// collide with (docs/reliability.md, "Boxes before pixels").
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "core/scene/scene.h"
#include "core/view/regions.h"

namespace farcull {

/// All pairs a < b of triangles whose boxes overlap: of different objects that are not ignored, and
/// of one object that is tested against itself. Sorted, each once. Empty where boxes of blocks do
/// not decide the whole scene, because too many of them overlap or triangles lie too unevenly
/// (core/pairs/regions.h). neighbours: false leaves out pairs of one object that share a vertex
/// index. threads: 0 for as many as there are cores.
std::optional<std::vector<TrianglePair>> pairs_of_boxes(const Scene& scene,
                                                        std::span<const ObjectPair> ignored,
                                                        bool neighbours, unsigned threads);

/// The regions that drawing needs to decide about these pairs: their triangles, and the places in
/// which boxes of two overlap, one for each object that is the first one of a pair. Every common
/// point of a pair is in one of the places.
Regions regions_of(const Scene& scene, std::span<const TrianglePair> pairs);

}  // namespace farcull
