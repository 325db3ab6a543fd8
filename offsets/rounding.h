// Rounds the numbers of fitted offsets from double to float, and bounds the errors in double.
#pragma once

namespace farcull {

/// Returns the nearest float. The variable must be volatile: if GCC 12 packs two conversions double
/// -> float -> double into a vector, it drops the conversions and their rounding.
inline float nearest(double x) {
  const volatile float f = static_cast<float>(x);
  return f;
}

// Bounds of the errors of doubles when solids are fitted (offsets/fit.inl). docs/budget.md,
// "offset", derives the constants; tests/proofs proves them.

/// Half a unit in the last place of a float, relative to the float. The constant is a little
/// larger, since the products and sums with it are rounded to double.
constexpr double kFitHalfUlp = 0x1.00001p-24;
/// The smallest float above 0.
constexpr double kFitSubnormal = 0x1p-149;
/// Error of `depth - radius` and `depth + radius`, relative to |depth| + radius.
constexpr double kFitDepth = 0x1p-50;
/// Error of a projection onto a direction of the box, relative to the sum of the magnitudes of its
/// terms. The same constant bounds the relative error of the upper bound of a direction's length.
constexpr double kFitBox = 0x1p-48;
/// Error of the difference of a corner and the centre, relative to its length.
constexpr double kFitCorner = 0x1p-50;
/// Error of the difference of a corner and the centre if squares underflow (px).
constexpr double kFitUnderflow = 0x1p-500;
/// Relative error of the radius after it grows by the largest displacement of a corner.
constexpr double kFitRadius = 0x1p-48;

}  // namespace farcull
