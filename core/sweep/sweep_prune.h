// I-COLLIDE: sweep and prune on axis-aligned boxes with temporal coherence, the object-space method
// that culling by pixels is compared with.
//
// Source: Cohen, Lin, Manocha, Ponamgi, I-COLLIDE: An Interactive and Exact Collision Detection
// System for Large-Scale Environments (I3D 1995), section 4. The ends of all boxes along each axis
// stay in a sorted list between frames. If little moved, insertion sort takes linear time; if two
// ends of different boxes change places, the state of that pair changes. Inside objects I-COLLIDE
// follows features of convex bodies. farcull takes triangles of any kind instead: those of the
// remaining objects are swept along one axis, in columns across the other two, and their order
// along that axis is kept as well.
//
// Reliable: only doubles are compared, so no pair of closed boxes that overlap is lost. The order
// that is kept between calls is a guess at the next one. It changes no answer, only the time taken
// (and the counts of swaps and sorts). Two calls may be about different scenes.
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
  /// All pairs a < b (indices into `boxes`) whose closed boxes overlap (touching counts), sorted,
  /// each once; valid until the next call. Empty boxes overlap nothing. Takes O(n + exchanges of
  /// ends + pairs). If there are too many exchanges, or other boxes are empty than in the last
  /// call, takes the time of box_join(). Preconditions: no NaN; fewer than 2^31 boxes.
  const std::vector<TrianglePair>& update(std::span<const Box> boxes);

  /// How often two neighbours in a list changed places in the last call.
  std::uint64_t swaps() const { return swaps_; }
  /// True if the last call sorted the lists from scratch.
  bool sorted_from_scratch() const { return from_scratch_; }
  /// Makes the next call start as the first one did.
  void forget() { *this = BoxSweep(); }

 private:
  struct End {
    double value;
    std::uint32_t box_and_side;  // 2 box + 1 for the upper end
    // At equal values lower ends come first, since touching boxes overlap.
    bool operator<(const End& f) const {
      return value < f.value || (value == f.value && (box_and_side & 1) < (f.box_and_side & 1));
    }
  };

  void start(std::span<const Box> boxes);
  bool sort_axis(int axis, std::span<const Box> boxes);

  std::vector<std::uint32_t> present_;  // indices of the boxes that are not empty, ascending
  std::vector<End> ends_[3];            // their ends, sorted by (value, side)
  std::vector<Box> boxes_;              // of the last call
  std::vector<TrianglePair> pairs_;     // of the last call
  std::vector<TrianglePair> appeared_;  // in this call: pairs that began to overlap; may repeat
  std::vector<TrianglePair> vanished_;  // in this call: pairs that ceased to overlap; may repeat
  std::uint64_t swaps_ = 0;
  bool from_scratch_ = false;
  bool is_whole_ = false;  // all members describe the same boxes
};

/// Counts of the survivors, in the units in which all methods are compared, and of the work done.
struct SweepPruneCounts {
  std::uint64_t objects = 0;         // in object_pairs, or `self` with two triangles or more
  std::uint64_t object_pairs = 0;    // pairs of objects whose boxes overlap
  std::uint64_t triangles = 0;       // live: in a candidate pair
  std::uint64_t triangle_pairs = 0;  // candidates
  std::uint64_t swaps = 0;  // neighbours that changed places, in the lists of ends and of triangles
  std::uint64_t sorts = 0;  // lists sorted from scratch: 3 of objects, columns, all triangles
};

struct SweepPruneResult {
  std::vector<TrianglePair> object_pairs;  // a < b, indices of objects; sorted, each once
  std::vector<std::uint32_t> triangles;    // live: in a candidate pair; ascending
  std::vector<TrianglePair> candidates;    // sorted, each once
  SweepPruneCounts counts;
};

/// Sweep and prune from frame to frame, in the calling thread. Keeps some 200 bytes, at most 340,
/// for each triangle that gets to the sweep.
class SweepPrune {
 public:
  /// The candidates are all pairs of triangles whose closed boxes overlap, of two different objects
  /// or both of one object marked `self`, neighbours included. box_join() with join_owners() finds
  /// the same. Precondition: validate(scene); fewer than 2^31 triangles and objects.
  SweepPruneResult find(const Scene& scene);
  /// As above, with the boxes given: triangle_boxes(), or boxes grown by a margin. The candidates
  /// are then the pairs whose given boxes overlap. Throws std::logic_error if there are not as many
  /// boxes as triangles.
  SweepPruneResult find(const Scene& scene, std::span<const Box> boxes);
  void forget();  // as BoxSweep::forget()

 private:
  /// The columns that the box of a triangle meets, first to last along two axes.
  struct Range {
    std::uint16_t u0, u1, v0, v1;
    std::uint64_t columns() const {
      return std::uint64_t(u1 - u0 + 1) * std::uint64_t(v1 - v0 + 1);
    }
  };
  /// A triangle as the sweep compares it, in one cache line.
  struct Item {
    double lo[3];  // of its box, the axis of the sweep first
    double hi[3];
    std::uint32_t triangle;
    std::uint32_t group;  // two of one group make no candidate
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
  std::array<int, 3> axes_ = {0, 1, 2};  // the axis of the sweep of triangles, then the others
  // The survivors of the last call, in the order along axes_[0] of the last sort.
  std::vector<std::uint32_t> order_;

  // Values of the running call. They are members so that their memory is reused.
  std::vector<std::uint32_t> survivors_;  // triangles that may have candidates; ascending
  std::vector<std::uint32_t> groups_;     // of each triangle
  std::vector<std::uint8_t> marks_;       // per triangle: its Mark
  std::array<double, 2> from_ = {0, 0};   // where columns begin along their axes
  std::array<double, 2> scale_ = {0, 0};  // 2^10 / extent along these axes
  std::array<int, 2> bits_ = {0, 0};      // 2^bits_ columns along each of their axes
  std::vector<Item> items_;               // one for each triangle in order_
  std::vector<std::size_t> starts_;       // per column: its start in entries_
  std::vector<Item> entries_;             // of the columns, one after the other
};

}  // namespace farcull
