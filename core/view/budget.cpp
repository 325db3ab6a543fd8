#include "core/view/budget.h"

#include <cmath>
#include <numbers>

#include "core/view/view.h"

namespace farcull {
namespace {

// GLSL does not define the rounding mode. So the relative error of an operation is at most one unit
// in the last place, 2^-23. A bound of 2^-24 would be too small.
constexpr double kUnit = 0x1p-23;
constexpr double kSqrt2 = std::numbers::sqrt2;

}  // namespace

std::array<BudgetTerm, 6> Budget::terms() const {
  return {{{"sampling", sampling},
           {"input", input},
           {"double", double_},
           {"vertex", vertex},
           {"snap", snap},
           {"offset", offset}}};
}

double Budget::radius() const {
  double sum = 0;
  for (const BudgetTerm& term : terms()) sum += term.px;
  // Six additions of rounded terms err by less than 2^-49 of the sum. The factor covers this error,
  // so that the result is strictly greater than the sum.
  return sum * (1 + 0x1p-40);
}

Budget budget_for(const RasterLimits& limits, int viewport) {
  const double half = 0.5 * viewport;  // M, the largest |coordinate| relative to the centre
  Budget b;
  b.sampling = kSqrt2 / 2;
  // Rounding a coordinate to the nearest float errs by at most kUnit / 2 * M. Errors of double
  // arithmetic are smaller. On the CPU, edges of a proxy are compared with pixel centres in floats,
  // which adds at most 3.01 kUnit * M (docs/budget.md, "The canvas on the CPU").
  b.input = kSqrt2 * kUnit * half * (limits.exact_samples ? 4 : 1);
  // Computing in double displaces a point by at most e = kMaxDoubleError along each axis. If the
  // point was at most s = sqrt(2)/2 from the pixel's centre, its distance is now at most sqrt((s +
  // sqrt(2) e)^2 + e^2) <= s + sqrt(2) e + e^2 / (2 s) (docs/budget.md, "double").
  b.double_ = kSqrt2 * kMaxDoubleError + kMaxDoubleError * kMaxDoubleError;
  // docs/budget.md, "vertex". Errors in units of kUnit * M: product with 2/viewport (1), division
  // by w (2.5), and product with viewport/2 (1). In units of kUnit * (M + viewport/2): sum with the
  // viewport's centre (1). The factor 1 + 4 kUnit covers the products of these errors.
  b.vertex =
      limits.exact_samples ? 0 : kSqrt2 * kUnit * (4.5 * half + (half + half)) * (1 + 4 * kUnit);
  b.snap = limits.exact_samples ? 0 : kSqrt2 * std::ldexp(1.0, -limits.subpixel_bits);
  b.offset = 0;
  return b;
}

double published_radius(double depth_step) { return 0.5 * std::sqrt(2 + depth_step * depth_step); }

}  // namespace farcull
