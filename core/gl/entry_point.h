// An entry point of GL with another function in its place, by libepoxy's function pointers. It
// shows what becomes of an answer where a driver fails. Only core/gl and its tests include this.
#pragma once

#include <epoxy/gl.h>

#include <atomic>
#include <type_traits>

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

}  // namespace farcull
