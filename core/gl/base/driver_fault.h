// Simulated faults of a GL driver. With them `farcull doctor` and the tests check that faults are
// noticed (assumption A7). While an object lives, failing functions replace GL's entry points
// (libepoxy's function pointers), and shader sources are changed on their way to the compiler. Only
// core/gl and its tests include this.
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

/// Puts `replacement` in place of *Pointer for the lifetime of the object. An entry point can have
/// only one such object at a time. The replacement calls the driver by original().
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
    // On the first call libepoxy looks up the driver's function and writes it to *Pointer. Later
    // calls do not touch *Pointer, since other threads may be calling it.
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
  oversized_dispatch,  // a compute dispatch exceeds the device's limit
  unfinished_item,     // an invocation of a dispatch ends before one of its work items is done
  lost_query,          // an occlusion query is never issued
  blind_queries,       // all occlusion queries answer zero, from strike() on
};

/// Makes GL calls fail in the thread that made the object. Calls of other threads reach the driver
/// unchanged. The constructor waits until no other object exists. For unfinished_item, compile the
/// programs while the object lives.
class DriverFault {
 public:
  explicit DriverFault(DriverFaultKind kind);
  ~DriverFault();
  DriverFault(const DriverFault&) = delete;
  DriverFault& operator=(const DriverFault&) = delete;

  /// Makes a later draw, dispatch or query fail, depending on the kind of fault. `call` is its
  /// number, counted from 0 after strike(). No call fails before strike().
  void strike(std::size_t call = 0);

 private:
  std::unique_lock<std::mutex> alone_;
  std::vector<std::shared_ptr<void>> replaced_;
};

}  // namespace farcull
