// Pairs of overlapping boxes, by a tree: all at once, or in order and some at a time, so that the
// memory does not grow with their number.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "core/boxes/block.h"
#include "core/scene/scene.h"

namespace farcull {

/// All pairs a < b of `items` (indices into boxes and owners) of different owners whose closed
/// boxes overlap, sorted. Exact: compares doubles only. Empty boxes overlap nothing. If there are
/// more than `most`, returns most + 1 of them.
std::vector<TrianglePair> box_join(std::span<const Box> boxes,
                                   std::span<const std::uint32_t> owners,
                                   std::span<const std::uint32_t> items,
                                   std::size_t most = SIZE_MAX);

/// Owners for box_join() that count pairs inside objects marked `self` too: a triangle of one is an
/// owner by itself.
std::vector<std::uint32_t> join_owners(const Scene& scene);

/// All pairs a < b of items of different owners whose closed boxes overlap, in ascending order.
class OrderedPairs {
 public:
  /// Of triangles of different objects, and of one object where it is `self`, whose boxes are grown
  /// by half the clearance. Two triangles at the clearance or less are such a pair
  /// (core/boxes/block.h), so none that collides is left out.
  /// clearance: world units, finite, >= 0. ignored: as in_order() gives them; their pairs are left
  /// out. threads: 0 for as many as there are cores; changes no answer. Memory O(items).
  OrderedPairs(const Scene& scene, double clearance, std::span<const ObjectPair> ignored,
               unsigned threads);
  /// Of `items`, as box_join(); their boxes and owners are copied. threads: as above.
  OrderedPairs(std::span<const Box> boxes, std::span<const std::uint32_t> owners,
               std::span<const std::uint32_t> items, unsigned threads);

  /// Replaces `out` by the next pairs: about `most` of them, fewer at the end, and at most all of
  /// one item more for each thread. May leave it empty before the end. Precondition: most > 0.
  void next(std::size_t most, std::vector<TrianglePair>& out);
  bool at_end() const { return next_ == boxes_.size(); }
  /// Blocks of sixteen boxes that the items asked about were compared with; the same whatever
  /// the threads and `most`.
  std::uint64_t compared() const { return compared_; }

 private:
  std::uint64_t append(std::uint32_t a, std::vector<std::uint32_t>& found,
                       std::vector<std::uint64_t>& marks, std::vector<TrianglePair>& out) const;

  void plant();  // the tree

  std::optional<IgnoredObjects> ignored_;
  unsigned threads_;
  std::vector<std::uint32_t> owner_;  // per item
  std::vector<std::uint32_t> items_;  // ascending
  std::vector<Box> boxes_;            // per item, grown
  std::vector<std::uint32_t> order_;  // the item of each leaf of the tree, by its place in items_
  std::vector<WideBoxes<double>> blocks_;
  BoxTree<double> tree_;
  std::uint64_t compared_ = 0;
  std::uint32_t next_ = 0;      // the first item whose pairs have not been given
  std::uint32_t asked_ = 1024;  // to ask about at a time
};

}  // namespace farcull
