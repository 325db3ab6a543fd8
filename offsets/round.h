// Outward rounding from double to float, shared by the offsets.
#pragma once

#include <cmath>
#include <limits>

namespace farcull {

/// The nearest float. Through memory: where GCC 12 packs two conversions double -> float -> double
/// into a vector it drops them, rounding included, and what is measured against the float then is
/// not what was stored.
inline float nearest(double x) {
  const volatile float f = static_cast<float>(x);
  return f;
}

/// The smallest float >= x.
inline float round_up(double x) {
  const float f = nearest(x);
  return f < x ? std::nextafter(f, std::numeric_limits<float>::infinity()) : f;
}

/// The largest float <= x.
inline float round_down(double x) { return -round_up(-x); }

/// Floats beyond z -+ radius, the rounding of these very lines included.
inline float outward_lower(double z, double radius) {
  return round_down(z - radius - 0x1p-50 * (std::abs(z) + radius));
}
inline float outward_upper(double z, double radius) {
  return round_up(z + radius + 0x1p-50 * (std::abs(z) + radius));
}

}  // namespace farcull
