// Rounds the numbers that offsets fit from double to float, and bounds the errors of the doubles.
#pragma once

namespace farcull {

/// The nearest float. Goes through memory: if GCC 12 packs two conversions double -> float ->
/// double into a vector, it drops them with their rounding, and a value measured against the float
/// would not be the stored one.
inline float nearest(double x) {
  const volatile float f = static_cast<float>(x);
  return f;
}

// Bounds of the errors of doubles when solids are fitted (offsets/fit.inl). docs/budget.md,
// "offset", derives the constants; tests/proofs proves them.

/// Half a unit in the last place of a float, relative to it, and a little more for the doubles that
/// multiply and add it.
constexpr double kFitHalfUlp = 0x1.00001p-24;
/// The smallest float above 0.
constexpr double kFitSubnormal = 0x1p-149;
/// Error of a depth minus or plus a radius, relative to the sum of their magnitudes.
constexpr double kFitDepth = 0x1p-50;
/// Error of a projection onto a direction of the box, relative to the sum of the magnitudes of its
/// terms; also of an upper bound of a direction's length.
constexpr double kFitBox = 0x1p-48;
/// Error of the difference of a corner and the centre, relative to its length.
constexpr double kFitCorner = 0x1p-50;
/// Error of that difference if squares underflow (px).
constexpr double kFitUnderflow = 0x1p-500;
/// Error of the radius after it grows by the largest displacement of a corner.
constexpr double kFitRadius = 0x1p-48;

}  // namespace farcull
