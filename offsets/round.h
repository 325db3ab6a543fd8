// Rounding from double to float, shared by the offsets.
#pragma once

namespace farcull {

/// The nearest float. Through memory: where GCC 12 packs two conversions double -> float -> double
/// into a vector it drops them, rounding included, and what is measured against the float then is
/// not what was stored.
inline float nearest(double x) {
  const volatile float f = static_cast<float>(x);
  return f;
}

}  // namespace farcull
