// Decides with rationals whether a kernel's answer (SolidAnswer) about a solid and a line along z
// is right. The kernel runs on a device or on this CPU. Its answer has to contain the part of the
// line in the exact solid, and must not be much wider.
#pragma once

#include <cstdint>

#include "core/canvas/canvas.h"

namespace farcull {

struct KernelTally {
  std::uint64_t checked = 0;   // bounds and points that were compared
  std::uint64_t lost = 0;      // compared bounds and points outside the answer
  std::uint64_t ordinary = 0;  // answers that have to be tight
  std::uint64_t loose = 0;     // ordinary answers that are wider than kLoose allows
  double excess = 0;  // px; the most by which an ordinary answer exceeds the exact interval
};

/// At most the fraction kLooseShare of the ordinary answers may have an end more than kLoose (px)
/// beyond the exact end. The test ObbKernel.IsNotAbsurdlyLooseOnOrdinaryBoxes allows a tenth of
/// this fraction.
constexpr double kLoose = 0.1, kLooseShare = 1e-2;

/// Checks an answer about the solid of offsets/obb.glsl: three slabs. ordinary: the box is of
/// moderate size and slope.
void check_box(const SolidCase& c, const SolidAnswer& answer, bool ordinary, KernelTally& tally);
/// Checks an answer about the solid of offsets/minkowski.glsl: a triangle fattened by a ball.
void check_minkowski(const SolidCase& c, const SolidAnswer& answer, bool ordinary,
                     KernelTally& tally);

/// A triangle near a pixel centre, of one of the hard kinds in verify/kernel_cases.h. ordinary:
/// true if the triangle is of moderate size and slope.
struct KernelTriangle {
  std::array<Vec3, 3> corners;
  double radius;  // px
  bool ordinary;
};
/// Each function returns the case of a seed and an index at the pixel centre (cx, cy). The floats
/// of adversarial solids are drawn directly, not computed from a triangle.
KernelTriangle kernel_triangle(std::uint64_t seed, std::uint64_t index, float cx, float cy);
Solid adversarial_box(std::uint64_t seed, std::uint64_t index, float cx, float cy);
Solid adversarial_minkowski(std::uint64_t seed, std::uint64_t index, float cx, float cy);

}  // namespace farcull
