// How much work threads may do together, before they give up.
#pragma once

#include <atomic>
#include <cstdint>

namespace farcull {

/// Counts work of several threads. Whether all of it is beyond the limit does not depend on their
/// order, and each of them sees it soon.
class WorkLimit {
 public:
  explicit WorkLimit(std::uint64_t most = UINT64_MAX) : most_(most) {}
  void add(std::uint64_t work) { done_.fetch_add(work, std::memory_order_relaxed); }
  bool exceeded() const { return done_.load(std::memory_order_relaxed) > most_; }
  std::uint64_t left() const {
    const std::uint64_t done = done_.load(std::memory_order_relaxed);
    return done > most_ ? 0 : most_ - done;
  }

 private:
  std::uint64_t most_;
  std::atomic<std::uint64_t> done_ = 0;
};

}  // namespace farcull
