// I-COLLIDE: sweep and prune on axis-aligned boxes with temporal coherence. Culling by pixels is
// compared with this object-space method.
//
// Source: Cohen, Lin, Manocha, Ponamgi, I-COLLIDE: An Interactive and Exact Collision Detection
// System for Large-Scale Environments (I3D 1995), section 4. The ends of all boxes along each axis
// stay in a sorted list between frames. If little moved, insertion sort takes linear time. Where
// the ends of two boxes change places, the boxes may begin or cease to overlap. For two objects
// whose boxes overlap, I-COLLIDE tracks features of convex bodies. farcull accepts any triangles.
// It sweeps the triangles of such objects along one axis, in columns that divide the other two
// axes. The order of the triangles along the sweep axis is kept between frames.
//
// Reliable: the sweep loses no pair of overlapping boxes, since doubles are only compared. The kept
// order affects the time and the counts of swaps and sorts, but no answer. Each call may get a
// different scene.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "core/scene/scene.h"

namespace farcull {

/// Finds the overlapping pairs of a set of moving boxes, from frame to frame.
class BoxSweep {
 public:
  /// Returns all pairs a < b (indices into `boxes`) whose closed boxes share a point, sorted and
  /// distinct; valid until the next call. Empty boxes overlap nothing. Time: O(n + exchanges of
  /// ends + pairs), or that of box_join() if sorted_from_scratch(). Preconditions: no NaN; fewer
  /// than 2^31 boxes.
  const std::vector<TrianglePair>& update(std::span<const Box> boxes);

  /// Returns how often two neighbours in a list of ends changed places in the last update().
  std::uint64_t swaps() const { return swaps_; }
  /// True if the last update() sorted the lists from scratch. This happens if there were too many
  /// exchanges, or if the set of empty boxes changed.
  bool sorted_from_scratch() const { return from_scratch_; }
  /// Drops all state, so that the next update() sorts from scratch.
  void forget() { *this = BoxSweep(); }

 private:
  struct End {
    double value;
    std::uint32_t box_and_side;  // 2 * box for the lower end, 2 * box + 1 for the upper end
    // At equal values, lower ends come first, since boxes that touch overlap.
    bool operator<(const End& f) const {
      return value < f.value || (value == f.value && (box_and_side & 1) < (f.box_and_side & 1));
    }
  };

  void start(std::span<const Box> boxes);
  bool sort_axis(int axis, std::span<const Box> boxes);

  std::vector<std::uint32_t> present_;  // indices of the boxes that are not empty, ascending
  std::vector<End> ends_[3];            // the ends of these boxes, sorted by (value, side)
  std::vector<Box> boxes_;              // the boxes of the last update()
  std::vector<TrianglePair> pairs_;     // the result of the last update()
  std::vector<TrianglePair> appeared_;  // pairs that began to overlap in this call; may repeat
  std::vector<TrianglePair> vanished_;  // pairs that ceased to overlap in this call; may repeat
  std::uint64_t swaps_ = 0;
  bool from_scratch_ = false;
  bool is_whole_ = false;  // false if an update() did not finish
};

/// Numbers of objects and triangles that remain after culling, and counts of the work.
struct SweepPruneCounts {
  std::uint64_t objects = 0;         // objects in object_pairs, or `self` with 2 or more triangles
  std::uint64_t object_pairs = 0;    // pairs of objects whose boxes overlap
  std::uint64_t triangles = 0;       // triangles in a candidate pair
  std::uint64_t triangle_pairs = 0;  // candidate pairs of triangles
  std::uint64_t swaps = 0;           // exchanges of neighbours in a sorted list
  std::uint64_t sorts = 0;           // lists that were sorted from scratch
};

struct SweepPruneResult {
  std::vector<TrianglePair> object_pairs;  // a < b, indices of objects; sorted, distinct
  std::vector<std::uint32_t> triangles;    // triangles in a candidate pair; ascending
  std::vector<TrianglePair> candidates;    // sorted, distinct
  SweepPruneCounts counts;
};

/// Sweep and prune from frame to frame, in the calling thread. Memory: about 200 bytes, and at most
/// 340 bytes, for each triangle that is swept.
class SweepPrune {
 public:
  /// Finds as candidates all pairs of triangles whose closed boxes overlap. The two triangles
  /// belong to different objects, or to one object marked `self`; then neighbours are included.
  /// box_join() with join_owners() finds the same pairs. Preconditions: validate(scene); fewer than
  /// 2^31 triangles and objects.
  SweepPruneResult find(const Scene& scene);
  /// Does the same with given boxes, such as boxes grown by a margin. Throws std::logic_error if
  /// there are not as many boxes as triangles.
  SweepPruneResult find(const Scene& scene, std::span<const Box> boxes);
  void forget();  // see BoxSweep::forget()

 private:
  /// The columns that the box of a triangle meets: u0 to u1 along one axis, v0 to v1 along another.
  struct Range {
    std::uint16_t u0, u1, v0, v1;
    std::uint64_t columns() const {
      return std::uint64_t(u1 - u0 + 1) * std::uint64_t(v1 - v0 + 1);
    }
  };
  /// A triangle and its box, in one cache line. lo[0], hi[0] are along the axis of the sweep.
  struct Item {
    double lo[3];
    double hi[3];
    std::uint32_t triangle;
    std::uint32_t group;  // two triangles of one group are no candidate pair
    Range range;
  };

  std::uint64_t find_survivors(const Scene& scene, std::span<const Box> boxes,
                               std::span<const Box> object_boxes,
                               std::span<const TrianglePair> object_pairs);
  void renew_order(std::size_t triangles);
  void choose_columns(std::span<const Box> boxes);
  void fill_columns(std::span<const Box> boxes);
  std::vector<TrianglePair> sweep_columns(SweepPruneCounts& counts);
  void sort_order();

  BoxSweep objects_;
  std::array<int, 3> axes_ = {0, 1, 2};  // the triangles' sweep axis, then the other two axes
  // Triangles in the order of the last sort along axes_[0].
  std::vector<std::uint32_t> order_;

  // Values of the running call. They are members so that their memory is reused.
  std::vector<std::uint32_t> survivors_;  // triangles that may have candidates; ascending
  std::vector<std::uint32_t> groups_;     // group of each triangle (Item::group)
  std::vector<std::uint8_t> marks_;       // Mark of each triangle
  std::array<double, 2> from_ = {0, 0};   // where the first column begins along axes_[1], axes_[2]
  std::array<double, 2> scale_ = {0, 0};  // 2^10 / extent along axes_[1], axes_[2]
  std::array<int, 2> bits_ = {0, 0};      // there are 2^bits_[k] columns along axes_[1 + k]
  std::vector<Item> items_;               // one for each triangle in order_
  std::vector<std::size_t> starts_;       // start of each column in entries_
  std::vector<Item> entries_;             // the items of each column, one column after the other
};

}  // namespace farcull
