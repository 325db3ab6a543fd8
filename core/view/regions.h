// Finds by boxes the places where a scene's objects can meet, and the triangles that can take part.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/scene/scene.h"

namespace farcull {

struct Regions {
  std::vector<Box> triangle_boxes;       // per triangle of the scene
  std::vector<Box> object_boxes;         // per object
  std::vector<Box> places;               // where two objects' boxes overlap, one per pair
  std::vector<std::uint32_t> triangles;  // ascending: all that can take part, since their box meets
                                         // the box of another object
};

/// Further views and finer offsets are left out if at most this many triangles are kept: to test
/// these exactly takes less time than the upload and the readbacks of one view.
constexpr std::uint32_t kFewTriangles = 256;
/// Below this many objects none is asked as a whole: that level draws everything twice, and among
/// few overlapping objects one seldom hides all of another.
constexpr std::uint32_t kFewObjects = 16;
/// A further round follows if the last one culled at least one triangle in this many. A round costs
/// about as much as the exact tests of that many triangles, so it has to cull a good part of them
/// (docs/methods.md, "What a run leaves out").
constexpr std::uint32_t kWorthARound = 8;

struct RegionRules {
  bool self = false;  // objects that are marked so are tested against themselves
  bool full = false;  // leave nothing out: every triangle takes part
};

/// With `self` the box of a marked object of two triangles or more is a region of its own, and all
/// of its triangles take part. With `full` every triangle takes part. The regions, and so the
/// views, stay the same, except that the box of the scene is the region if there is no other.
Regions find_regions(const Scene& scene, const RegionRules& rules = {});

/// The regions that drawing needs to decide about these pairs. triangles: those of the pairs.
/// places: one for each object that owns the first triangle of a pair; it contains the overlaps of
/// the boxes of these pairs. So every common point of a pair is in one of the places.
Regions regions_of(const Scene& scene, std::span<const TrianglePair> pairs);

}  // namespace farcull
