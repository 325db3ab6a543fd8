// Simulates faults of a GL driver. `farcull doctor` and the tests check that each fault is noticed
// (assumption A7). While a DriverFault object exists, some of libepoxy's pointers to GL functions
// point to replacements. A replacement can let a call fail, or change the source of a shader. Only
// core/gl and its tests include this file.
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

/// Sets *Pointer to `replacement` for the lifetime of the object. For each GL function, only one
/// such object may exist. The replacement calls the driver's function by original().
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
    // The first call restores libepoxy's own function, which then stores the driver's function in
    // *Pointer. Later calls do not change *Pointer, since other threads may be calling it.
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
  static inline std::atomic<bool> resolved_ = false;  // original_ is the driver's function
};

enum class DriverFaultKind {
  lost_draw,           // a draw call never runs
  lost_dispatch,       // a compute dispatch never runs
  oversized_dispatch,  // a compute dispatch exceeds the device's limit
  unfinished_item,     // an invocation of a dispatch ends before one of its work items is done
  lost_query,          // an occlusion query is never issued
  blind_queries,       // all occlusion queries answer zero, from strike() on
};

/// Makes GL calls fail in the thread that constructs the object. Calls of other threads reach the
/// driver unchanged. The constructor waits until no other DriverFault exists. For the kind
/// unfinished_item, programs must be compiled while the object exists.
class DriverFault {
 public:
  explicit DriverFault(DriverFaultKind kind);
  ~DriverFault();
  DriverFault(const DriverFault&) = delete;
  DriverFault& operator=(const DriverFault&) = delete;

  /// Makes a later draw, dispatch or query fail, depending on the kind of fault. call: number of
  /// the failing call, counted from 0 after strike(). No call fails before strike().
  void strike(std::size_t call = 0);

 private:
  std::unique_lock<std::mutex> alone_;
  std::vector<std::shared_ptr<void>> replaced_;
};

}  // namespace farcull
