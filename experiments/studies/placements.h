// How often FAR misses a pair at a radius: many small patches of triangles, placed into each other
// at random. A patch is a few neighbouring triangles of a built-in scene, scaled and turned at
// random. A scene holds thousands of placements, far enough from each other that in each of the
// views x, y and z every placement has pixels of its own, so that one run of FAR decides them all.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "core/scene/scene.h"
#include "experiments/measure/lab.h"
#include "experiments/studies/counts.h"
#include "experiments/studies/point.h"

namespace farcull {

constexpr std::uint32_t kPatchTriangles = 8;

/// Placements in one scene: two objects, the first and the second patch of each placement in the
/// order of the placements, kPatchTriangles triangles each. A unit is about a pixel.
struct PlacedPatches {
  Scene scene;
  std::uint64_t placements = 0;
};

/// Cuts patches from the first two objects of a scene, which has two or more.
class PatchSource {
 public:
  explicit PatchSource(Scene from);

  /// As many placements as a window of that many pixels holds, at least one and at most `most`,
  /// drawn with this seed. grazing, side: as in PlacementPoint. Throws std::logic_error where none
  /// fits.
  PlacedPatches place(bool grazing, double side, int resolution, std::uint64_t most,
                      std::uint64_t seed) const;

 private:
  Scene from_;
  std::array<std::vector<std::vector<std::uint32_t>>, 2> around_;  // of each object: triangles by
                                                                   // vertex of the scene
};

/// The seed of a window of a point: the same for every radius and number of subpixel bits, which so
/// look at the same placements; another one for another size of triangles, resolution, kind of
/// contact or window, so that rows which differ in these can be added up.
std::uint64_t placement_seed(const PlacementPoint& point, std::uint64_t window);

/// px; the longest segment in which two triangles meet, in double; 0 where it finds none.
double intersection_length(const std::array<Vec3, 3>& a, const std::array<Vec3, 3>& b);

/// Runs FAR with oriented boxes and fragment depth in the views x, y, z on scene after scene, until
/// all placements of the point are placed, on the native canvas. With subpixel bits the corners of
/// proxies are snapped to multiples of 2^-bits px before they are drawn, as devices do. Which pairs
/// collide, exact predicates say. The counts are PlacementCounts.
PointResult measure_placements(const PlacementPoint& point, Lab& lab);

}  // namespace farcull
