// Faults of a GL driver for `farcull doctor` and the tests: both see by them that a fault is
// noticed (assumption A7). While an object lives, functions that fail stand in place of GL's entry
// points, and texts of shaders are changed on their way to the compiler.
#pragma once

#include <cstddef>
#include <memory>
#include <mutex>
#include <vector>

namespace farcull {

enum class DriverFaultKind {
  lost_draw,           // a draw call never runs
  lost_dispatch,       // a compute dispatch never runs
  oversized_dispatch,  // a compute dispatch beyond the device's limit
  unfinished_item,     // a work item of a dispatch, and those after it of its invocation, never run
  lost_query,          // an occlusion query is never issued
  blind_queries,       // all occlusion queries answer zero, from strike() on
  wrong_count,         // far-pairs: the count of a list is one too large
  kept_bits,           // far-pairs: bits of pairs that shall be set to 0 keep their values
};

/// Only calls of the thread that made the object are at fault; those of other threads reach the
/// driver unchanged. A second object, of another thread, waits for the first. Programs must be
/// compiled while the object lives for unfinished_item, wrong_count and kept_bits.
class DriverFault {
 public:
  /// at: of wrong_count the number of the bin, modulo the number of bins.
  explicit DriverFault(DriverFaultKind kind, std::size_t at = 0);
  ~DriverFault();
  DriverFault(const DriverFault&) = delete;
  DriverFault& operator=(const DriverFault&) = delete;

  /// The call with this number, counted from now on and from 0, is at fault: of the draws, the
  /// dispatches or the queries. Before, none is.
  void strike(std::size_t call = 0);

 private:
  std::unique_lock<std::mutex> alone_;
  std::vector<std::shared_ptr<void>> replaced_;
};

}  // namespace farcull
