// The floating-point environment of a thread. The proofs assume rounding to nearest, ties to even,
// and that subnormal numbers are not flushed to zero. A process may violate this: a library built
// with -ffast-math sets flush-to-zero when it is loaded, and a caller may change the rounding mode.
#pragma once

#include <cfenv>
#include <cstdint>
#include <string>

namespace farcull {

enum class Rounding : std::uint8_t { to_nearest, upward, downward, toward_zero, unknown };
std::string to_string(Rounding rounding);

/// How a thread computes in float and in double.
struct FloatingPoint {
  Rounding rounding = Rounding::to_nearest;
  bool flushes_results = false;   // a result below the normal range becomes 0 (x86: FTZ)
  bool flushes_operands = false;  // a subnormal operand counts as 0 (x86: DAZ)

  bool operator==(const FloatingPoint&) const = default;
};

/// The floating-point environment that all proofs assume.
inline constexpr FloatingPoint kProved;

/// Returns for example "rounds to nearest, keeps subnormals".
std::string to_string(const FloatingPoint& floating_point);

/// Returns the environment of the calling thread. Determines it by arithmetic alone, so the same
/// code works on every processor. May raise floating-point exceptions.
FloatingPoint floating_point();

/// Throws Error if the calling thread's environment differs from kProved. Foreign code may change
/// the environment, so call this function after such code. where: Error::where of the error.
void require_proved(const std::string& where);

/// Sets kProved for the calling thread and disables floating-point traps. The destructor restores
/// the previous environment (rounding, flushing, traps, raised exceptions). Guards may be nested:
/// an inner guard must be destroyed first. Takes less than a microsecond.
///
/// A compiler may assume that the environment is constant, and may move arithmetic on local
/// variables across the guard. To prevent this, put the arithmetic into functions that are not
/// inlined, or operate on memory that the guard's constructor might have changed.
class FloatingPointGuard {
 public:
  /// Throws Error if test operations show that kProved could not be set. Restores the previous
  /// environment before throwing.
  FloatingPointGuard();
  ~FloatingPointGuard();
  FloatingPointGuard(const FloatingPointGuard&) = delete;
  FloatingPointGuard& operator=(const FloatingPointGuard&) = delete;

 private:
  std::fenv_t before_;
  bool outermost_ = false;
};

/// Returns the environment that the calling thread had before its outermost guard. Returns
/// floating_point() if the thread has no guard.
FloatingPoint callers_floating_point();

}  // namespace farcull
