// Rounds the numbers of fitted offsets from double to float, and bounds the errors in double.
#pragma once

namespace farcull {

/// Returns the nearest float. The variable must be volatile: GCC 12 may pack two conversions double
/// -> float -> double into a vector and then drop the conversions with their rounding.
inline float nearest(double x) {
  const volatile float f = static_cast<float>(x);
  return f;
}

// Bounds of rounding errors in double when solids are fitted (offsets/fit.inl). docs/budget.md,
// "offset", derives the constants; tests/proofs proves them.

/// Half a unit in the last place of a float, relative to the float. The constant is a little
/// larger, since products and sums with the constant are rounded to double.
constexpr double kFitHalfUlp = 0x1.00001p-24;
/// The smallest positive float.
constexpr double kFitSubnormal = 0x1p-149;
/// Error of `depth - radius` and `depth + radius`, relative to |depth| + radius.
constexpr double kFitDepth = 0x1p-50;
/// Error of a projection onto a direction of the box, relative to the sum of the magnitudes of the
/// summands. Also the relative error of the upper bound of a direction's length.
constexpr double kFitBox = 0x1p-48;
/// Error of the vector from the centre to a corner, relative to the length of the vector.
constexpr double kFitCorner = 0x1p-50;
/// Error of the vector from the centre to a corner if the squared components underflow (px).
constexpr double kFitUnderflow = 0x1p-500;
/// Relative error of the sum of the radius and the largest displacement of a corner.
constexpr double kFitRadius = 0x1p-48;

}  // namespace farcull
