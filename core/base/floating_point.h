// The floating-point environment of a thread. The proofs assume rounding to nearest, ties to even,
// and that subnormal numbers are kept. A process may compute differently: a library built with
// -ffast-math sets flush-to-zero when it is loaded, and a caller may have set another rounding.
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

/// Returns the environment of the calling thread. Determines it by test operations, so the same
/// code works on every processor. May raise floating-point exceptions.
FloatingPoint floating_point();

/// Throws Error naming `where` unless the calling thread's environment is kProved. Call it after
/// foreign code, which may change the environment, and before using results of that code.
void require_proved(const std::string& where);

/// Sets kProved for the calling thread and disables floating-point traps. The destructor restores
/// the previous environment (rounding, flushing, traps, raised exceptions). Guards may be nested:
/// an inner guard must be destroyed first. Takes less than a microsecond.
///
/// A compiler may assume that the environment is constant, and move arithmetic on local variables
/// across the guard. So put important arithmetic into functions that are not inlined, or into
/// operations on memory that the guard's constructor might have changed.
class FloatingPointGuard {
 public:
  /// Throws Error if test operations show another environment than kProved. The previous
  /// environment is then restored.
  FloatingPointGuard();
  ~FloatingPointGuard();
  FloatingPointGuard(const FloatingPointGuard&) = delete;
  FloatingPointGuard& operator=(const FloatingPointGuard&) = delete;

 private:
  std::fenv_t before_;
  bool outermost_ = false;
};

/// Returns the environment that the outermost guard of the calling thread has replaced. If the
/// thread has no guard, returns floating_point().
FloatingPoint callers_floating_point();

}  // namespace farcull
