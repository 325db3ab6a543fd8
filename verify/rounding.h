// Bounds on the rounding of what the verification computes in doubles: of the filters
// (verify/filter.h), and of points that are compared.
#pragma once

#include <cstdint>

namespace farcull {

enum class Triage : std::uint8_t { no, yes, unknown };

/// The proved bounds, derived in filter_scalars.h. The filters take them
/// as a type: tests show with smaller ones that they are needed.
struct FilterBounds {
  static constexpr double side =
      9 * 0x1p-53;  // of a determinant, in its permanent; of a projection
  static constexpr double normals = 12 * 0x1p-53;  // of the product of two normals
  static constexpr double point =
      64 * 0x1p-53;  // of a constructed difference of points, in their extent
  static constexpr double gap =
      16 * 0x1p-53;  // of a gap along a direction, in the magnitudes projected
  static constexpr double absolute =
      0x1p-1000;  // underflow, per unit of what is multiplied last, plus one
};

/// Error of the length of a normal that is used as an upper bound, relative to the sum of its
/// magnitudes; and the rounding of that bound.
constexpr double kNormalLength = 0x1p-50;
constexpr double kNormalRounding = 0x1p-49;
/// The least square of a length whose root is accurate; smaller ones count as this one.
constexpr double kLeastSquare = 0x1p-900;
/// Rounding of a clearance times a length.
constexpr double kNeededRounding = 0x1p-50;

// ---- of SamePoints (verify/closest_points.cpp, which derives them) ----

/// Error of a product w . (x - p), relative to the magnitudes of its terms.
constexpr double kTie = 8 * 0x1p-53;
/// Error that the rounding of the two points of w adds, relative to the magnitudes of their
/// coordinates.
constexpr double kTiePoints = 2 * 0x1p-53;
/// The same where a coordinate is subnormal.
constexpr double kTieSubnormal = 0x1p-1070;
/// Underflow of products.
constexpr double kTieAbsolute = 0x1p-1000;

}  // namespace farcull
