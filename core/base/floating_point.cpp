// floating_point() determines the environment by test operations. Their operands are volatile, so
// the operations run at run time, not in the compiler. FloatingPointGuard uses <cfenv>. In most C
// libraries fenv_t includes the flush-to-zero mode, and FE_DFL_ENV turns this mode off. The guard
// repeats the test operations, so it notices a C library that behaves differently.
#include "core/base/floating_point.h"

#include <array>
#include <bit>
#include <cstddef>
#include <limits>
#include <optional>

#include "core/base/error.h"

namespace farcull {
namespace {

static_assert(0.1 != 0.1f, "farcull: -fsingle-precision-constant breaks its proofs");

thread_local std::optional<FloatingPoint> callers;

// Let u be the distance from 1 to the next larger number. Rounding to nearest gives 1 for 1 + u/4,
// -1 for -1 - u/4, and 1 + u for 1 + 3u/4. `above` and `below` identify rounding upward and
// downward. `far` distinguishes rounding to nearest from rounding toward zero.
template <class Real>
Rounding rounding() {
  constexpr Real kUnit = std::numeric_limits<Real>::epsilon();
  const volatile Real one = 1, minus_one = -1, quarter = kUnit / 4, rest = 3 * (kUnit / 4);
  const volatile Real above = one + quarter, below = minus_one - quarter, far = one + rest;
  if (above == 1 && below == -1) {
    return far == 1 + kUnit ? Rounding::to_nearest
           : far == 1       ? Rounding::toward_zero
                            : Rounding::unknown;
  }
  if (above == 1 + kUnit && below == -1) return Rounding::upward;
  if (above == 1 && below == -1 - kUnit) return Rounding::downward;
  return Rounding::unknown;
}

// Two products reveal flushing. The first has normal operands and a subnormal result. The second
// has a subnormal operand and a normal result. The bits of the first result are examined, because a
// comparison of floats might flush it.
template <class Real>
void find_flushing(FloatingPoint& found) {
  using Limits = std::numeric_limits<Real>;
  const volatile Real least = Limits::min(), half = Real(0.5);
  const volatile Real subnormal = Limits::denorm_min(), large = 4 / Limits::epsilon();
  const volatile Real result = least * half, operand = subnormal * large;
  using Bytes = std::array<std::byte, sizeof(Real)>;
  const Real stored = result;
  found.flushes_results |= std::bit_cast<Bytes>(stored) == Bytes{};
  found.flushes_operands |= operand == 0;
}

}  // namespace

std::string to_string(Rounding rounding) {
  constexpr std::array kWords = {"to nearest", "upward", "downward", "toward zero",
                                 "in no known way"};
  return kWords.at(static_cast<std::size_t>(rounding));
}

std::string to_string(const FloatingPoint& floating_point) {
  const auto& [rounding, results, operands] = floating_point;
  return "rounds " + to_string(rounding) +
         (!results && !operands
              ? ", keeps subnormals"
              : std::string(", flushes subnormal ") +
                    (!operands ? "results" : (!results ? "operands" : "results and operands")) +
                    " to zero");
}

FloatingPoint floating_point() {
  FloatingPoint found;
  const Rounding in_float = rounding<float>(), in_double = rounding<double>();
  found.rounding = in_float == in_double ? in_double : Rounding::unknown;
  find_flushing<float>(found);
  find_flushing<double>(found);
  return found;
}

void require_proved(const std::string& where) {
  const FloatingPoint now = floating_point();
  if (now == kProved) return;
  throw Error(where, "this thread " + to_string(now) + ", which the proofs are not about",
              "find out which library of this process changes the floating-point environment, and "
              "run without it");
}

FloatingPointGuard::FloatingPointGuard() {
  std::feholdexcept(&before_);  // also disables traps, before any arithmetic
  const FloatingPoint found = floating_point();
  std::fesetenv(FE_DFL_ENV);
  try {
    require_proved("arithmetic");
  } catch (...) {
    std::fesetenv(&before_);
    throw;
  }
  outermost_ = !callers;
  if (outermost_) callers = found;
}

FloatingPointGuard::~FloatingPointGuard() {
  if (outermost_) callers.reset();
  std::fesetenv(&before_);
}

FloatingPoint callers_floating_point() { return callers ? *callers : floating_point(); }

}  // namespace farcull
