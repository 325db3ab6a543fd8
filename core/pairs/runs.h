// Runs of triangles: those that stand together in a file mostly lie together, so the box of a run
// speaks for all of them, and most are never touched one by one. Where they do not, they are put in
// an order by which they do.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "core/base/uninitialized.h"
#include "core/pairs/box_block.h"
#include "core/scene/scene.h"

namespace farcull {

/// Consecutive triangles of one object, in the order of Runs.
struct Run {
  std::uint32_t first, count;
};

/// The runs of all objects of a scene, and their boxes, grown by half the clearance.
struct Runs {
  std::vector<Run> runs;
  std::vector<Box> boxes;            // of the runs; of a gathered object only where all are
  std::vector<std::uint32_t> first;  // per object, and one behind the last: its first run
  std::vector<Box> objects;          // empty where an object has no triangle
  std::vector<std::uint32_t> order;  // triangles in the order of the runs; empty: that of the file
  Vec3 origin = Vec3::Zero();        // of boxes as floats; finite

  /// Where an object's triangles were put in an order of their own.
  struct Gathered {
    std::uint32_t first = 0;  // block of its first run
    std::uint32_t count = 0;  // runs with a block; the triangles of the others meet nothing
    bool any = false;
  };
  std::vector<Gathered> gathered;        // per object; empty: none was
  std::vector<std::uint8_t> stretched;   // per object; empty: none is
  UninitializedVector<RunBlock> blocks;  // of the runs of gathered objects

  bool is_gathered(std::uint32_t object) const { return !gathered.empty() && gathered[object].any; }
  /// Runs of an object that can meet anything.
  std::uint32_t count(std::uint32_t object) const {
    return is_gathered(object) ? gathered[object].count : first[object + 1] - first[object];
  }
  /// The box of run k of an object, relative to the origin. Precondition: k < count(object).
  FloatBox bound(std::uint32_t object, std::uint32_t k) const {
    return is_gathered(object) ? blocks[gathered[object].first + k].bound
                               : relative(boxes[first[object] + k], origin);
  }
  /// The triangle at a position, Run::first + k.
  std::uint32_t triangle(std::uint32_t position) const {
    return order.empty() ? position : order[position];
  }
};

/// The boxes of all triangles of some objects, one object after the other.
struct ScatteredBoxes {
  Vec3 origin = Vec3::Zero();
  std::vector<std::uint32_t> objects;  // ascending
  std::vector<std::size_t> first;      // of each of them, into boxes
  UninitializedVector<FloatBox> boxes;
};

/// Runs in the order of the file. threads: 0 for as many as there are cores.
/// An object's runs are scattered where they are more than kScattered times as long as those of a
/// smooth surface. Where `scattered` is not null, such objects are put there and have no boxes of
/// runs; large ones are judged by a sample.
Runs make_runs(const Scene& scene, double clearance, unsigned threads,
               ScatteredBoxes* scattered = nullptr);
/// An object is stretched where its box is more than kStretched times as long as the one around
/// most of its triangles, by a sample: grids over its box, and boxes of runs as floats, are of no
/// use then. Objects of a few runs are not judged. make_runs() with `scattered` tells which are.
constexpr double kStretched = 8;
/// Chooses the origin, and puts the triangles of scattered objects that meet the object's region in
/// Morton order, as runs with blocks.
/// regions: per object, contains the boxes of all its triangles, grown, that can meet anything;
/// empty: none.
void gather_scattered(const Scene& scene, double clearance, std::span<const Box> regions,
                      unsigned threads, ScatteredBoxes& scattered, Runs& runs);
constexpr double kScattered = 3;

/// Runs in the order of the file, or, of scattered objects, of all their triangles in Morton order,
/// with a block and a box each. Of stretched objects the order is that of spatial_order().
Runs make_ordered_runs(const Scene& scene, double clearance, unsigned threads);
/// The boxes and blocks of such runs anew where the corners of their triangles moved, and the boxes
/// of the objects. moved: per run.
void update_boxes(const Scene& scene, double clearance, std::span<const std::uint8_t> moved,
                  unsigned threads, Runs& runs);

}  // namespace farcull
