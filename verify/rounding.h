// Bounds on rounding errors of doubles in verification: in the filters (verify/filter.h), and in
// the comparison of closest points (verify/nearest_pair.cpp).
#pragma once

#include <cstdint>

namespace farcull {

enum class Triage : std::uint8_t { no, yes, unknown };

/// The proved bounds (docs/proofs.md). They are members of a type, so that tests can pass another
/// type and show that smaller bounds give wrong answers.
struct FilterBounds {
  /// Error of a determinant or projection, relative to the sum of the magnitudes of its terms.
  static constexpr double side = 9 * 0x1p-53;
  /// Error of the scalar product of two normals, relative to the magnitudes of its terms.
  static constexpr double normals = 12 * 0x1p-53;
  /// Error of the difference of two constructed points, relative to the largest |coordinate|.
  static constexpr double point = 64 * 0x1p-53;
  /// Error of a gap along a direction d, relative to the largest sum of |d_k| |corner_k|.
  static constexpr double gap = 16 * 0x1p-53;
  /// Error by underflow of products (verify/filter_scalars.h, "Underflow").
  static constexpr double absolute = 0x1p-1000;
};

/// Parts of an upper bound of a normal's length. kNormalLength: error of the length, relative to
/// the sum of the normal's magnitudes. kNormalRounding: rounding of the bound.
constexpr double kNormalLength = 0x1p-50;
constexpr double kNormalRounding = 0x1p-49;
/// The root of a smaller square may be inaccurate, so this value replaces or increases the square.
constexpr double kLeastSquare = 0x1p-900;
/// Rounding error of a clearance times a length, or a gap over a length, relative to the result.
constexpr double kNeededRounding = 0x1p-50;

// ---- bounds for SamePoints (verify/nearest_pair.cpp). w is the difference of two closest points.

/// Error of a product w . (x - p) of corners x and p, relative to the magnitudes of its terms.
constexpr double kTie = 8 * 0x1p-53;
/// Error from the rounding of the closest points, relative to the magnitudes of the coordinates.
constexpr double kTiePoints = 2 * 0x1p-53;
/// Error from the rounding of the closest points if a coordinate is subnormal.
constexpr double kTieSubnormal = 0x1p-1070;
/// Error by underflow of products.
constexpr double kTieAbsolute = 0x1p-1000;

}  // namespace farcull
