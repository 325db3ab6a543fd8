// The slack between what one program of a GL device stores and another one asks.
#pragma once

namespace farcull {

/// A GL canvas asks a proxy this far behind D(exit): four steps of 2^-24. Derived in
/// docs/budget.md, "Two programs", and proved by farcull_proofs (depth.behind). The program that
/// stores and the one that asks may round the depth map in different directions, and convert a
/// depth to 24 bits to different neighbours; with the slack entry <= exit is seen all the same. 3/4
/// plus the slack stays below 1, the value of an empty pixel. The canvas's own items have given
/// depths and need no slack. The native canvas needs none: both depths are rounded to nearest by
/// the same function.
constexpr float kAskedBehind = 4 * 0x1p-24f;

}  // namespace farcull
