// Bounds on rounding errors of doubles in verification: in the filters (verify/filter.h), and in
// the comparison of closest points (verify/nearest_pair.cpp).
#pragma once

#include <cstdint>

namespace farcull {

enum class Triage : std::uint8_t { no, yes, unknown };

/// The proved bounds (docs/proofs.md). They are members of a type, so that tests can pass another
/// type and show that smaller bounds give wrong answers.
struct FilterBounds {
  /// Error of a determinant or of a projection, relative to the permanent (the sum of magnitudes).
  static constexpr double side = 9 * 0x1p-53;
  /// Error of the product of two normals.
  static constexpr double normals = 12 * 0x1p-53;
  /// Error of the difference of two constructed points, relative to their extent.
  static constexpr double point = 64 * 0x1p-53;
  /// Error of a gap along a direction d, relative to the largest sum of |d_k| |corner_k|.
  static constexpr double gap = 16 * 0x1p-53;
  /// Error by underflow of products, to be multiplied by 1 + the sum of their last factors.
  static constexpr double absolute = 0x1p-1000;
};

/// For an upper bound of the length of a normal. kNormalLength: error of the length, relative to
/// the sum of the normal's magnitudes. kNormalRounding: rounding of the bound.
constexpr double kNormalLength = 0x1p-50;
constexpr double kNormalRounding = 0x1p-49;
/// Smaller squared lengths have inaccurate roots, so they are replaced by this value.
constexpr double kLeastSquare = 0x1p-900;
/// Rounding error of a clearance times a length, relative to the product.
constexpr double kNeededRounding = 0x1p-50;

// ---- bounds for SamePoints (verify/nearest_pair.cpp)

/// Error of a product w . (x - p), relative to the magnitudes of its terms.
constexpr double kTie = 8 * 0x1p-53;
/// Error from the rounding of the two points of w, relative to the magnitudes of their coordinates.
constexpr double kTiePoints = 2 * 0x1p-53;
/// Error from the rounding of the two points if a coordinate is subnormal.
constexpr double kTieSubnormal = 0x1p-1070;
/// Error by underflow of products.
constexpr double kTieAbsolute = 0x1p-1000;

}  // namespace farcull
