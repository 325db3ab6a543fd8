// The floating-point environment of a thread. The proofs assume rounding to nearest, ties to even,
// and that subnormal numbers are kept. A process may compute differently: loading a library built
// with -ffast-math sets flush-to-zero, and a caller may have chosen another rounding.
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
  bool flushes_results = false;   // a result below the normal numbers becomes 0 (x86: FTZ)
  bool flushes_operands = false;  // a subnormal operand counts as 0 (x86: DAZ)

  bool operator==(const FloatingPoint&) const = default;
};

/// The floating-point environment that all proofs assume.
inline constexpr FloatingPoint kProved;

/// Returns for example "rounds to nearest, keeps subnormals".
std::string to_string(const FloatingPoint& floating_point);

/// Returns the environment of the calling thread. Finds it by test operations, so the same code
/// works on every processor. May raise floating-point exceptions.
FloatingPoint floating_point();

/// Throws Error naming `where` unless the calling thread computes as kProved says. Call it after
/// foreign code, which may change the environment, and before using results of that code.
void require_proved(const std::string& where);

/// Sets kProved for the calling thread and turns floating-point traps off. Restores the previous
/// environment (rounding, flushing, traps, raised exceptions) at the end of its scope. Guards may
/// be nested: an inner one ends before the outer one. Takes less than a microsecond.
///
/// A compiler may ignore that the environment changes and move arithmetic on local variables across
/// the guard. So put arithmetic that matters into functions that are called and not inlined, or do
/// it on memory that the guard's constructor might have changed.
class FloatingPointGuard {
 public:
  /// Throws Error if test operations show that the thread does not compute as kProved says. Then
  /// restores the previous environment.
  FloatingPointGuard();
  ~FloatingPointGuard();
  FloatingPointGuard(const FloatingPointGuard&) = delete;
  FloatingPointGuard& operator=(const FloatingPointGuard&) = delete;

 private:
  std::fenv_t before_;
  bool outermost_ = false;
};

/// Returns the environment that the outermost guard of the calling thread found. If the thread has
/// no guard, returns floating_point().
FloatingPoint callers_floating_point();

}  // namespace farcull
