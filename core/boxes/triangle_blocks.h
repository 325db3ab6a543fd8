// Blocks of triangles. Consecutive triangles of a file are usually close to each other. So one box
// around a block of them can rule out the whole block, and few triangles are examined one by one.
// Scattered triangles are sorted first, so that a block has close triangles of similar size.
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
  std::vector<Box> boxes;  // per block; for gathered objects, valid only after update_boxes()
  std::vector<std::uint32_t> first;  // per object and one past the last: its first block
  std::vector<Box> objects;          // per object: its box; empty: the object has no triangle
  std::vector<std::uint32_t> order;  // triangles in the order of the blocks; empty: file order
  Vec3 origin = Vec3::Zero();        // finite; boxes in floats are relative to this point

  /// If `any` is true, the object is gathered: its triangles are sorted, and blocks have lanes.
  struct Gathered {
    std::uint32_t first = 0;  // index of its first block in `lanes`
    std::uint32_t count =
        0;  // number of its blocks with lanes; its other blocks cannot be in a pair
    bool any = false;
  };
  std::vector<Gathered> gathered;  // per object; empty: no object is gathered
  std::vector<float> stretched;    // per object, see stretch(); empty: no object is stretched
  UninitializedVector<BlockLanes> lanes;  // the lanes of the blocks of gathered objects

  bool is_gathered(std::uint32_t object) const { return !gathered.empty() && gathered[object].any; }
  /// Returns how many times longer the box of an object is than the box around most of its
  /// triangles. Returns 0 if the object is not stretched.
  float stretch(std::uint32_t object) const { return stretched.empty() ? 0 : stretched[object]; }
  /// Returns the number of blocks of an object that can be in a pair.
  std::uint32_t count(std::uint32_t object) const {
    return is_gathered(object) ? gathered[object].count : first[object + 1] - first[object];
  }
  /// Returns the box of block k of an object, relative to `origin`. k: below count(object).
  FloatBox bound(std::uint32_t object, std::uint32_t k) const {
    return is_gathered(object) ? lanes[gathered[object].first + k].bound
                               : relative(boxes[first[object] + k], origin);
  }
  /// Returns for each block the index of its lanes in `lanes`. kNoLanes: the block has no lanes.
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

/// The triangles of an object are scattered if the boxes of its blocks are more than kScattered
/// times as long as they would be for a smooth surface.
constexpr double kScattered = 3;
/// An object is stretched if its box is more than kStretched times as long as the box around most
/// of its triangles, estimated from a sample. A grid over the object's box would put most triangles
/// into few cells. Objects with few triangles never count as stretched.
constexpr float kStretched = 8;
/// If stretch() is above kUneven, floats are too coarse for the boxes of the object's blocks. For a
/// surface with a million triangles, a block is 1/256 as long as the surface. A block should be at
/// least 64 float steps long. A float step is 2^-24 of the length of the object's box.
constexpr float kUneven = 0x1p24f / (256 * 64);

/// Sets blocks.ranges and blocks.first. Precondition: blocks.ranges is empty.
void divide(const Scene& scene, TriangleBlocks& blocks);
/// Makes blocks of triangles in the order of the file, and finds stretched objects. threads: 0 for
/// one per core.
TriangleBlocks make_blocks(const Scene& scene, double clearance, unsigned threads);
/// Chooses the origin. Sorts triangles into blocks with lanes: in a scattered object the triangles
/// whose boxes overlap its region, by size class and Morton code; in a stretched object all
/// triangles, by spatial_order(). regions: per object. A triangle whose box is outside its object's
/// region must not be in any pair. Objects with an empty region are not sorted.
void gather_scattered(const Scene& scene, double clearance, std::span<const Box> regions,
                      unsigned threads, TriangleBlocks& blocks);

/// Makes blocks. Sorts the triangles of scattered objects by size class and Morton code, and those
/// of stretched objects by spatial_order(). Other objects keep the order of the file.
TriangleBlocks make_ordered_blocks(const Scene& scene, double clearance, unsigned threads);
/// Updates blocks of make_ordered_blocks() after a motion. Recomputes the boxes and lanes of blocks
/// with a moved corner, and the boxes of all objects. moved: per block, 1 if a corner moved.
void update_boxes(const Scene& scene, double clearance, std::span<const std::uint8_t> moved,
                  unsigned threads, TriangleBlocks& blocks);

}  // namespace farcull
