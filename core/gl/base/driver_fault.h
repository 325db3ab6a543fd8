// Simulates faults of a GL driver, to check that farcull detects each fault (assumption A7). While
// a DriverFault object exists, some of libepoxy's pointers to GL functions point to replacements. A
// replacement can drop a call, or change the source of a shader. Only core/gl and its tests include
// this file.
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

/// Sets *Pointer to `replacement` for the lifetime of the object. Only one object per GL function
/// may exist at a time. The replacement can call the driver's function by original().
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
    // At first, original_ may be libepoxy's resolver. The first call lets the resolver store the
    // driver's function in *Pointer. Later calls do not write *Pointer: other threads may read it.
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
  static inline std::atomic<bool> resolved_ = false;  // true: original_ is the driver's function
};

enum class DriverFaultKind {
  lost_draw,           // a draw call never runs
  lost_dispatch,       // a compute dispatch never runs
  oversized_dispatch,  // a compute dispatch exceeds the device's limit
  unfinished_item,     // an invocation of a compute dispatch skips its last work items
  lost_query,          // an occlusion query is never issued
  blind_queries,       // after strike(), the result of every occlusion query is zero
};

/// Makes GL calls fail in the thread that constructs the object. Calls of other threads reach the
/// driver unchanged. The constructor waits until no other DriverFault exists. A fault of the kind
/// unfinished_item affects only programs that are compiled while the object exists.
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
