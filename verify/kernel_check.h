// Decides whether a kernel's answer is right: it contains the part of the real solid or triangle on
// the line or in the pixel, decided with rationals, and it is not so wide that it says nothing. For
// answers of a device as much as of this CPU.
#pragma once

#include <cstdint>
#include <vector>

#include "core/canvas/kernel_case.h"

namespace farcull {

struct KernelTally {
  std::uint64_t checked = 0;   // bounds and points compared
  std::uint64_t lost = 0;      // of them outside the answer
  std::uint64_t ordinary = 0;  // answers of which tightness is asked
  std::uint64_t loose = 0;     // of them wider than they may be (see kLooseShare)
  double excess = 0;           // px, most of an ordinary answer beyond the exact interval
};

/// An end of an ordinary answer is more than this beyond the exact one (px) in no more than this
/// share of all: ten times what the box's test finds (ObbKernel.IsNotAbsurdlyLooseOnOrdinaryBoxes).
constexpr double kLoose = 0.1, kLooseShare = 1e-2;

/// The solid of offsets/obb.glsl: three slabs. `ordinary`: a box of moderate size and slope.
void check_box(const SolidCase& c, const SolidAnswer& answer, bool ordinary, KernelTally& tally);
/// The solid of offsets/minkowski.glsl: hull and ball.
void check_minkowski(const SolidCase& c, const SolidAnswer& answer, bool ordinary,
                     KernelTally& tally);
/// A triangle of FAR pairs.
void check_interval(const IntervalCase& c, const IntervalAnswer& answer, KernelTally& tally);
/// Slices: exactly those of rationals. Pixels: the integer part.
void check_slices(const std::vector<SliceCase>& cases, const std::vector<SliceAnswer>& answers,
                  KernelTally& tally);

/// A triangle and the pixel centre it lies around; every kind that has been trouble. `ordinary`:
/// of moderate size and slope.
struct KernelTriangle {
  std::array<Vec3, 3> corners;
  double radius;  // px
  bool ordinary;
};
/// One draw of cases for each index, the same on every machine. Adversarial solids are made of
/// floats directly.
KernelTriangle kernel_triangle(std::uint64_t seed, std::uint64_t index, float cx, float cy);
Solid adversarial_box(std::uint64_t seed, std::uint64_t index, float cx, float cy);
Solid adversarial_minkowski(std::uint64_t seed, std::uint64_t index, float cx, float cy);
std::vector<IntervalCase> interval_kernel_cases(std::uint64_t seed, std::size_t count);
/// All in one window, in the order of z, along which slices never decrease.
std::vector<SliceCase> slice_kernel_cases(std::uint64_t seed, std::size_t count);

}  // namespace farcull
