// Uses boxes to find the places where objects of a scene can meet, and the triangles that can meet
// another object.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/scene/scene.h"

namespace farcull {

struct Regions {
  std::vector<Box> triangle_boxes;       // one per triangle of the scene
  std::vector<Box> object_boxes;         // one per object
  std::vector<Box> places;               // boxes that contain all points where objects can meet
  std::vector<std::uint32_t> triangles;  // triangles that can meet another object; ascending
};

/// If at most this many triangles remain, further views and finer offsets are left out. Exact tests
/// of these triangles take less time than the upload and the readbacks of one view.
constexpr std::uint32_t kFewTriangles = 256;
/// A further view follows only if the last view culled at least 1/kWorthAView of the triangles that
/// remained before that view. On two CPU cores, a view takes a third of the time of exact tests of
/// its triangles (docs/methods.md, "What a run leaves out").
constexpr std::uint32_t kWorthAView = 3;

struct RegionRules {
  bool self = false;     // tests objects with Object::self against themselves
  bool full = false;     // lists every triangle in Regions::triangles
  unsigned threads = 1;  // 0: one per core
};

/// Finds one place for each pair of objects whose boxes overlap: the intersection of the boxes.
/// With rules.self, the box of an object with Object::self and two or more triangles is also a
/// place, and all triangles of this object are listed. With rules.full, every triangle is listed.
/// If there is no place, the box of the scene is then the place.
Regions find_regions(const Scene& scene, const RegionRules& rules = {});

/// Returns the regions for these pairs. triangles: the triangles of the pairs. places: one for each
/// object that owns the first triangle of a pair. For each such pair, the object's place contains
/// the intersection of the two triangles' boxes. So every common point of a pair is in a place.
Regions regions_of(const Scene& scene, std::span<const TrianglePair> pairs);

}  // namespace farcull
