// Runs of triangles: those that stand together in a file mostly lie together, so the box of a run
// speaks for all of them, and most are never touched one by one. Where they do not, they are put in
// an order by which they do.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "core/scene/scene.h"

namespace farcull {

/// By how much each of two triangles grows so that they meet at that distance: half of it, rounded
/// up.
double half_of(double clearance);
/// The box grown outward by at least `half` (world units, >= 0) on every side; an empty one and
/// half 0 change nothing. Never decreasing in the box's coordinates.
Box grow(const Box& box, double half);
/// The closed box of a triangle, grown outward by at least half the clearance on every side.
Box grown_box(const Scene& scene, std::uint32_t triangle, double clearance);

/// Triangles of a run at most.
constexpr std::uint32_t kRun = 16;

/// Consecutive triangles of one object, in the order of Runs.
struct Run {
  std::uint32_t first, count;
};

/// The runs of all objects of a scene, and their boxes, grown by half the clearance.
struct Runs {
  std::vector<Run> runs;
  std::vector<Box> boxes;            // of the runs
  std::vector<std::uint32_t> first;  // per object, and one behind the last: its first run
  std::vector<Box> objects;          // empty where an object has no triangle
  std::vector<std::uint32_t> order;  // triangles in the order of the runs; empty: that of the file

  std::uint32_t count(std::uint32_t object) const { return first[object + 1] - first[object]; }
  /// The triangle at a position, Run::first + k.
  std::uint32_t triangle(std::uint32_t position) const {
    return order.empty() ? position : order[position];
  }
};
/// Runs in the order of the file. threads: 0 for as many as there are cores.
Runs make_runs(const Scene& scene, double clearance, unsigned threads);
/// Where the runs of an object are scattered, more than kScattered times as long as those of a
/// smooth surface, its triangles that meet the object's region are put in Morton order of their
/// first corners, and its runs are made anew; runs without such a triangle get an empty box.
/// regions: per object, contains the boxes of all its triangles, grown, that can meet anything;
/// empty: none.
void gather_scattered(const Scene& scene, double clearance, std::span<const Box> regions,
                      unsigned threads, Runs& runs);
constexpr double kScattered = 3;

}  // namespace farcull
