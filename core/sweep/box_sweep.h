// The pairs of overlapping boxes among boxes that move, from frame to frame
// (core/sweep/sweep_prune.h names the source): the ends of all boxes along each axis stay in sorted
// lists.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/scene/scene.h"

namespace farcull {

/// The pairs of overlapping boxes among those of a moving set.
class BoxSweep {
 public:
  /// All pairs a < b (indices into `boxes`) whose closed boxes overlap (touching counts), sorted,
  /// each once; valid until the next call. Empty boxes overlap nothing. Takes O(n + exchanges of
  /// ends + pairs), or where there are too many exchanges, or other boxes are empty than in the
  /// last call, the time of box_join(). Preconditions: no NaN; fewer than 2^31 boxes.
  const std::vector<TrianglePair>& update(std::span<const Box> boxes);

  /// Of the last call: how often two neighbours in a list changed places.
  std::uint64_t swaps() const { return swaps_; }
  /// Of the last call: whether the lists were sorted from scratch.
  bool sorted_from_scratch() const { return from_scratch_; }
  /// The next call starts as the first one did.
  void forget();

 private:
  struct End {
    double value;
    std::uint32_t box_and_side;  // 2 box + 1 for the upper end
  };

  static bool before(const End& e, const End& f);
  void start(std::span<const Box> boxes);
  bool sort_axis(int axis, std::span<const Box> boxes);

  std::vector<std::uint32_t> present_;  // indices of the boxes that are not empty, ascending
  std::vector<End> ends_[3];            // of those, sorted by (value, side)
  std::vector<Box> boxes_;              // of the last call
  std::vector<TrianglePair> pairs_;     // of the last call
  std::vector<TrianglePair> appeared_;  // during a call: of the pairs, those that are new, and
  std::vector<TrianglePair> vanished_;  // those that are gone; possibly several times
  std::uint64_t swaps_ = 0;
  bool from_scratch_ = false;
};

}  // namespace farcull
