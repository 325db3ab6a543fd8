// Decides with rationals whether a kernel's answer is right: the answer has to contain the part of
// the real solid or triangle on the line or in the pixel, and must not be much wider. The answers
// may come from a device or from this CPU.
#pragma once

#include <cstdint>
#include <vector>

#include "core/canvas/kernel_case.h"

namespace farcull {

struct KernelTally {
  std::uint64_t checked = 0;   // bounds and points compared
  std::uint64_t lost = 0;      // bounds and points outside the answer
  std::uint64_t ordinary = 0;  // answers that have to be tight
  std::uint64_t loose = 0;     // ordinary answers that are wider than kLoose allows
  double excess = 0;           // px, the most that an ordinary answer exceeds the exact interval
};

/// At most the share kLooseShare of the ordinary answers may have an end more than kLoose (px)
/// beyond the exact end. This share is ten times the one that the test of the box finds
/// (ObbKernel.IsNotAbsurdlyLooseOnOrdinaryBoxes).
constexpr double kLoose = 0.1, kLooseShare = 1e-2;

/// Checks an answer about the solid of offsets/obb.glsl: three slabs. ordinary: the box is of
/// moderate size and slope.
void check_box(const SolidCase& c, const SolidAnswer& answer, bool ordinary, KernelTally& tally);
/// Checks an answer about the solid of offsets/minkowski.glsl: a triangle fattened by a ball.
void check_minkowski(const SolidCase& c, const SolidAnswer& answer, bool ordinary,
                     KernelTally& tally);
/// Checks an answer about a triangle of FAR pairs.
void check_interval(const IntervalCase& c, const IntervalAnswer& answer, KernelTally& tally);
/// Checks slices and pixels: the slices have to be exactly those computed with rationals, the pixel
/// the integer part.
void check_slices(const std::vector<SliceCase>& cases, const std::vector<SliceAnswer>& answers,
                  KernelTally& tally);

/// A triangle near a pixel centre, of one of the kinds that have been hard. ordinary: of moderate
/// size and slope.
struct KernelTriangle {
  std::array<Vec3, 3> corners;
  double radius;  // px
  bool ordinary;
};
/// These draw a case for each seed and index, the same on every machine. The floats of adversarial
/// solids are drawn directly, not computed from a triangle.
KernelTriangle kernel_triangle(std::uint64_t seed, std::uint64_t index, float cx, float cy);
Solid adversarial_box(std::uint64_t seed, std::uint64_t index, float cx, float cy);
Solid adversarial_minkowski(std::uint64_t seed, std::uint64_t index, float cx, float cy);
std::vector<IntervalCase> interval_kernel_cases(std::uint64_t seed, std::size_t count);
/// Cases of one window, in the order of z, along which slices never decrease.
std::vector<SliceCase> slice_kernel_cases(std::uint64_t seed, std::size_t count);

}  // namespace farcull
