// Blocks of triangles. Triangles that follow one another in a file are mostly close, so one box can
// rule out a whole block, and most triangles are never examined one by one. Scattered triangles
// are sorted first, so that the triangles of a block are close and of similar size.
#pragma once

#include <cstdint>
#include <numeric>
#include <span>
#include <vector>

#include "core/base/uninitialized.h"
#include "core/boxes/block.h"
#include "core/scene/scene.h"

namespace farcull {

/// At most kWide consecutive triangles of one object, in the order of TriangleBlocks.
struct TriangleBlock {
  std::uint32_t first, count;
};

/// The blocks of all objects of a scene, and their boxes, grown by half the clearance.
struct TriangleBlocks {
  std::vector<TriangleBlock> ranges;
  std::vector<Box> boxes;  // per block; valid for gathered objects only after update_boxes()
  std::vector<std::uint32_t> first;  // per object and one past the last: its first block
  std::vector<Box> objects;          // per object: its box; empty if it has no triangle
  std::vector<std::uint32_t> order;  // triangles in the order of the blocks; empty: as in the file
  Vec3 origin = Vec3::Zero();        // finite; boxes in floats are relative to this point

  /// A gathered object: its triangles were put in a new order.
  struct Gathered {
    std::uint32_t first = 0;  // index of its first block in `lanes`
    std::uint32_t count =
        0;  // number of its blocks with lanes; triangles of other blocks meet nothing
    bool any = false;
  };
  std::vector<Gathered> gathered;  // per object; empty: no object was gathered
  std::vector<float> stretched;    // per object, see stretch(); empty: no object is stretched
  UninitializedVector<BlockLanes> lanes;  // of the blocks of gathered objects

  bool is_gathered(std::uint32_t object) const { return !gathered.empty() && gathered[object].any; }
  /// Returns how many times longer the box of an object is than the box around most of its
  /// triangles. Returns 0 if the object is not stretched.
  float stretch(std::uint32_t object) const { return stretched.empty() ? 0 : stretched[object]; }
  /// Returns the number of blocks of an object that can meet anything.
  std::uint32_t count(std::uint32_t object) const {
    return is_gathered(object) ? gathered[object].count : first[object + 1] - first[object];
  }
  /// Returns the box of an object's block k, relative to the origin. k < count(object).
  FloatBox bound(std::uint32_t object, std::uint32_t k) const {
    return is_gathered(object) ? lanes[gathered[object].first + k].bound
                               : relative(boxes[first[object] + k], origin);
  }
  /// Returns for each block the index of its lanes in `lanes`, or kNoLanes.
  std::vector<std::uint32_t> lane_places() const {
    std::vector<std::uint32_t> out(ranges.size(), kNoLanes);
    for (std::uint32_t o = 0; o < objects.size(); ++o) {
      if (!is_gathered(o)) continue;
      std::iota(out.begin() + first[o], out.begin() + first[o] + count(o), gathered[o].first);
    }
    return out;
  }
  static constexpr std::uint32_t kNoLanes = UINT32_MAX;
  /// Returns the triangle at a position in the order of the blocks.
  std::uint32_t triangle(std::uint32_t position) const {
    return order.empty() ? position : order[position];
  }
};

/// An object's blocks are scattered if their boxes are more than kScattered times as long as those
/// of a smooth surface.
constexpr double kScattered = 3;
/// An object is stretched if its box is more than kStretched times as long as the box around most
/// of its triangles (judged by a sample). Grids over such a box are of no use. Objects of a few
/// blocks are not judged.
constexpr float kStretched = 8;
/// If an object is stretched beyond kUneven, boxes of its blocks in floats are of no use. A block
/// of a surface with a million triangles is 1/256 as long as the surface. At least 64 float steps
/// should fit into a block. A float step is 2^-24 of the object's box.
constexpr float kUneven = 0x1p24f / (256 * 64);

/// Sets blocks.ranges and blocks.first. Precondition: blocks.ranges is empty.
void divide(const Scene& scene, TriangleBlocks& blocks);
/// Makes blocks in the order of the file, and marks stretched objects. threads: 0 for as many as
/// there are cores.
TriangleBlocks make_blocks(const Scene& scene, double clearance, unsigned threads);
/// Chooses the origin. Sorts triangles into blocks with lanes. In a scattered object these are the
/// triangles that meet the object's region, sorted by size class and Morton code. In a stretched
/// object these are all triangles, in the order of spatial_order(). regions: per object a box that
/// contains the grown boxes of all its triangles that can meet anything; empty if no triangle can.
void gather_scattered(const Scene& scene, double clearance, std::span<const Box> regions,
                      unsigned threads, TriangleBlocks& blocks);

/// Makes blocks. The triangles of scattered objects are in Morton order, the triangles of stretched
/// objects in the order of spatial_order(), and all others in the order of the file.
TriangleBlocks make_ordered_blocks(const Scene& scene, double clearance, unsigned threads);
/// Brings blocks from make_ordered_blocks() up to date: recomputes the boxes and lanes of blocks
/// with a moved corner, and the boxes of all objects. moved: per block, 1 if a corner moved.
void update_boxes(const Scene& scene, double clearance, std::span<const std::uint8_t> moved,
                  unsigned threads, TriangleBlocks& blocks);

}  // namespace farcull
