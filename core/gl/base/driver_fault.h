// Faults of a GL driver, with which `farcull doctor` and the tests check that a fault is noticed
// (assumption A7). While an object lives, failing functions replace GL's entry points (libepoxy's
// function pointers), and shader sources are changed on their way to the compiler. Only core/gl and
// its tests include this.
#pragma once

#include <epoxy/gl.h>

#include <atomic>
#include <cstddef>
#include <memory>
#include <mutex>
#include <type_traits>
#include <vector>

namespace farcull {

template <auto* Pointer, class Function = std::remove_pointer_t<decltype(Pointer)>>
class GlEntryPoint;

/// Puts `replacement` in place of *Pointer for the lifetime of the object; one object per entry
/// point at a time. The replacement reaches the driver by original().
template <auto* Pointer, class Result, class... Arguments>
class GlEntryPoint<Pointer, Result (*)(Arguments...)> {
 public:
  using Function = Result (*)(Arguments...);

  explicit GlEntryPoint(Function replacement) {
    original_ = *Pointer;
    resolved_ = false;
    replacement_ = replacement;
    *Pointer = replacement;
  }
  ~GlEntryPoint() { *Pointer = original_; }
  GlEntryPoint(const GlEntryPoint&) = delete;
  GlEntryPoint& operator=(const GlEntryPoint&) = delete;

  static Result original(Arguments... arguments) {
    if (resolved_) return original_(arguments...);
    // The first call of a function resolves it: libepoxy puts what it found into its pointer, and
    // calls it from there. Then the pointer is left alone, since other threads may be calling.
    *Pointer = original_;
    struct Again {
      ~Again() {
        original_ = *Pointer;
        resolved_ = true;
        *Pointer = replacement_;
      }
    } again;
    return original_(arguments...);
  }

 private:
  static inline Function original_ = nullptr, replacement_ = nullptr;
  static inline std::atomic<bool> resolved_ = false;  // original_ is the driver's own function
};

enum class DriverFaultKind {
  lost_draw,           // a draw call never runs
  lost_dispatch,       // a compute dispatch never runs
  oversized_dispatch,  // a compute dispatch beyond the device's limit
  unfinished_item,     // a work item of a dispatch, and those after it of its invocation, never run
  lost_query,          // an occlusion query is never issued
  blind_queries,       // all occlusion queries answer zero, from strike() on
};

/// Only calls of the thread that made the object are at fault; those of other threads reach the
/// driver unchanged. A second object, of another thread, waits for the first. Programs must be
/// compiled while the object lives for unfinished_item.
class DriverFault {
 public:
  explicit DriverFault(DriverFaultKind kind);
  ~DriverFault();
  DriverFault(const DriverFault&) = delete;
  DriverFault& operator=(const DriverFault&) = delete;

  /// Makes the call with this number fail: a draw, a dispatch or a query, by the kind of fault. The
  /// calls are counted from 0 and from now on. No call fails before strike().
  void strike(std::size_t call = 0);

 private:
  std::unique_lock<std::mutex> alone_;
  std::vector<std::shared_ptr<void>> replaced_;
};

}  // namespace farcull
