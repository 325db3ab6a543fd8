// Collects pairs (a, b) of triangle indices, in bounded memory even if many repeat, and sorts them.
#pragma once

#include <atomic>
#include <cstddef>
#include <mutex>
#include <span>
#include <utility>
#include <vector>

#include "core/scene/scene.h"

namespace farcull {

/// All pairs of the parts, sorted by (a, b), without repeats. If there are many pairs, the time is
/// linear in their number plus the range of a. The answer does not depend on `threads` (0: as many
/// as there are cores).
std::vector<TrianglePair> sorted_unique(std::span<const std::vector<TrianglePair>> parts,
                                        unsigned threads);
/// As above; empties the parts as soon as it has read them, to make room.
std::vector<TrianglePair> sorted_unique(std::vector<std::vector<TrianglePair>>&& parts,
                                        unsigned threads);

/// Collects pairs that arrive in groups, unsorted and perhaps repeated. Keeps them in parts of one
/// size, because a single list would be copied each time it grows.
class GatheredPairs {
 public:
  void add(std::span<const TrianglePair> some);
  /// As sorted_unique(). This object is empty afterwards.
  std::vector<TrianglePair> sorted(unsigned threads) && {
    return sorted_unique(std::move(parts_), threads);
  }

 private:
  static constexpr std::size_t kPart = std::size_t{1} << 14;
  std::vector<std::vector<TrianglePair>> parts_;
};

/// Collects pairs from several threads; a pair may come several times. Each thread adds to its own
/// list. A list that reaches its share of `buffer` (or of the number of distinct pairs, if that is
/// larger) is sorted and merged into a common list of distinct pairs. So the threads' lists hold at
/// most `buffer` pairs, or as many as are distinct, and the work stays linear in the pairs that are
/// added.
class PairPool {
 public:
  /// lists: number of threads that add at once. buffer: most pairs in all their lists together.
  PairPool(std::size_t lists, std::size_t buffer);

  void add(std::size_t list, const TrianglePair& pair) {
    std::vector<TrianglePair>& pairs = lists_[list].pairs;
    pairs.push_back(pair);
    if (pairs.size() >= limit_.load(std::memory_order_relaxed)) shrink(list);
  }
  /// Number of pairs in memory, distinct ones included. Call it only while no thread adds.
  std::size_t held() const;
  /// All pairs, sorted, each once. The pool cannot be used afterwards.
  std::vector<TrianglePair> take(unsigned threads);

 private:
  void shrink(std::size_t list);

  struct alignas(64) List {  // aligned so that no two threads write to one cache line
    std::vector<TrianglePair> pairs;
  };
  std::size_t buffer_;
  std::atomic<std::size_t> limit_;  // a list of this many pairs is merged
  std::vector<List> lists_;
  std::mutex mutex_;  // guards distinct_
  std::vector<TrianglePair> distinct_;
};

}  // namespace farcull
