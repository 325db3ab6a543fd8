// How far doubles err on the way of a point from the world to the window. docs/budget.md, "double",
// derives the constants; tests/proofs proves them.
#pragma once

namespace farcull {

/// Error of a mapped coordinate, relative to the computed sum of the magnitudes of its three terms.
constexpr double kMapRounding = 8 * 0x1p-53;
/// What is added for products that underflow (px).
constexpr double kMapUnderflow = 0x1p-1000;
/// Error that a cut adds along each axis, relative to the largest |coordinate| before clipping.
constexpr double kCutRounding = 16 * 0x1p-53;

}  // namespace farcull
