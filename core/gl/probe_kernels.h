// The kernels of this product run on a device as its methods run them: solids by the canvas's own
// fragment program, intervals and slices by compute shaders with the text of
// core/pairs/interval.glsl. Whether the answers are right is not decided here
// (verify/kernel_check.h).
#pragma once

#include <span>
#include <string>
#include <vector>

#include "core/canvas/kernel_case.h"
#include "core/gl/context.h"

namespace farcull {

/// px: solids are asked on a window of this side, one in each pixel.
constexpr int kSolidSide = 128;
constexpr std::size_t kSolidCases = std::size_t{kSolidSide} * kSolidSide;
/// The pixel centre at which case i is asked.
inline SolidCase solid_case_at(std::size_t i) {
  constexpr float kHalf = 0.5f * kSolidSide;
  return {static_cast<float>(i % kSolidSide) + 0.5f - kHalf,
          static_cast<float>(i / kSolidSide) + 0.5f - kHalf,
          {}};
}

/// The answers of `solid` for kSolidCases cases, each with the centre of solid_case_at. This
/// function and those below make the context current while they run. Throws Error as GlCanvas
/// does.
std::vector<SolidAnswer> device_solids(const GlContext& context, const SolidProgram& solid,
                                       std::span<const SolidCase> cases);

/// Whether each of kSolidCases solids is seen behind the one that is stored in its pixel, by the
/// programs of the method, in a window this deep (px): with flags, with queries, and with queries
/// on 24 bits, all three. Where the two are the same solid and the line hits it, it must be.
std::vector<std::uint8_t> device_seen(const GlContext& context, const SolidProgram& solid,
                                      std::span<const SolidCase> stored,
                                      std::span<const SolidCase> asked, double depth);

/// The answers of the kernel of FAR pairs; `before` stands before its text, for twins that must
/// fail.
std::vector<IntervalAnswer> device_intervals(const GlContext& context,
                                             std::span<const IntervalCase> cases,
                                             const std::string& before = "");

std::vector<SliceAnswer> device_slices(const GlContext& context, std::span<const SliceCase> cases);

}  // namespace farcull
