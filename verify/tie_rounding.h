// Bounds on the rounding of SamePoints (verify/nearest_pair.cpp), which derives them.
#pragma once

namespace farcull {

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
