// Collects and sorts pairs (a, b) of triangle indices. Memory is bounded even if many pairs repeat.
#pragma once

#include <atomic>
#include <cstddef>
#include <mutex>
#include <span>
#include <utility>
#include <vector>

#include "core/scene/scene.h"

namespace farcull {

/// Returns the pairs of all parts, sorted by (a, b), without repeats. With many pairs, the time is
/// linear in their number plus the range of `a`. The answer does not depend on `threads` (0: one
/// per core).
std::vector<TrianglePair> sorted_unique(std::span<const std::vector<TrianglePair>> parts,
                                        unsigned threads);
/// Does the same. Also empties the parts after reading them, to free memory.
std::vector<TrianglePair> sorted_unique(std::vector<std::vector<TrianglePair>>&& parts,
                                        unsigned threads);

/// Collects pairs that arrive in groups, unsorted and perhaps repeated. The pairs are kept in parts
/// of fixed size, because a single list would be copied each time it grows.
class GatheredPairs {
 public:
  void add(std::span<const TrianglePair> some);
  /// Returns the distinct pairs, sorted. This object is empty afterwards.
  std::vector<TrianglePair> sorted(unsigned threads) && {
    return sorted_unique(std::move(parts_), threads);
  }

 private:
  static constexpr std::size_t kPart = std::size_t{1} << 14;
  std::vector<std::vector<TrianglePair>> parts_;
};

/// Collects pairs from several threads. A pair may be added several times. Each thread adds to its
/// own list. All threads' lists together hold at most max(`buffer`, number of distinct pairs)
/// pairs. A list that reaches its share of this limit is sorted and merged into a common list of
/// distinct pairs. So the work stays linear in the number of added pairs.
class PairPool {
 public:
  /// lists: number of threads that add at once. buffer: limits the pairs in all threads' lists.
  PairPool(std::size_t lists, std::size_t buffer);

  void add(std::size_t list, const TrianglePair& pair) {
    std::vector<TrianglePair>& pairs = lists_[list].pairs;
    pairs.push_back(pair);
    if (pairs.size() >= limit_.load(std::memory_order_relaxed)) shrink(list);
  }
  /// Returns the number of pairs in all lists, the common list included. Precondition: no thread
  /// adds pairs during the call.
  std::size_t held() const;
  /// Returns the distinct pairs, sorted. The pool cannot be used afterwards.
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
