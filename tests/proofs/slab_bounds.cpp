// The kernels' common arithmetic (offsets/slab.glsl) and the extent of the exact offset
// (offsets/minkowski.glsl), for any rounding that GLSL allows. A claim about the far end holds for
// the near end too, which is its mirror image.
#include "core/base/glsl_shim.h"
#include "tests/proofs/bounds.h"
#include "tests/proofs/kernel_steps.h"
#include "tests/proofs/number.h"
#include "tests/proofs/raw.h"

namespace farcull::glsl::proofs {
#include "offsets/slab.glsl"
}  // namespace farcull::glsl::proofs

namespace farcull::proofs {
namespace {

using Constants = SlabConstants;
const Constants kSlab = {glsl::proofs::kEightU, glsl::proofs::kFourU, glsl::proofs::kTiny};

// Half of `tiny` is left to the steps that follow. kHalf is that half, kLeft what they take of it.
const std::string kHalf = "1b-101", kLeft = "1b-120";

// The difference of a pixel's centre and the solid's, times the normal's component, at most 2: what
// flushing the difference takes is at most 2^-125.
Number component(Script& script, const Number& exact) {
  return script.rounded_product(script.shifted(script.perturbed(exact), "1b-125"));
}

std::string slab_doubt(const Constants& k) {
  Script script(kGlsl);
  const Number x = script.value("X"), y = script.value("Y");
  const Doubt<Number> d = doubt(component(script, x), component(script, y), k);
  const Number error = exact_difference(d.s, exact_sum(x, y));
  return script.claims_not_negative(
      exact_difference(exact_difference(d.e, error), script.between(kHalf, kHalf)));
}

std::string slab_height(const Constants& k) {
  Script script(kGlsl);
  const Number h = script.magnitude("H");
  const Number e = exact_sum(0.99 * kSlab.tiny, script.magnitude("E"));
  return script.claims_not_negative(exact_difference(height(h, e, k), exact_sum(h, e)));
}

// A normal all but in the image: |n_z| < 2^-20, and |z - m_z| below 2^40.
struct Parallel {
  Number steep, depth, exact;  // as the kernel has them, and their product
};
Parallel parallel(Script& script, const Constants& k) {
  const Number steep = script.magnitude("S", "1b-20");
  const Number depth = script.magnitude("Z", "1b40");
  const Number below = script.shifted(script.perturbed(depth), "1b-126");
  // A component below 2^-126 may have been read as zero.
  const Number exact = exact_product(exact_sum(steep, script.between("0", "1b-126")), depth);
  return {steep, reach(below, k), exact};
}

std::string slab_parallel(const Constants& k) {
  Script script(kGlsl);
  const Parallel p = parallel(script, k);
  const Number h = exact_sum(0x1p-10, script.magnitude("H"));
  const Number most = limit(h, slack(p.steep, p.depth, k), k);
  return script.claims_not_negative(exact_difference(most, exact_sum(h, p.exact)));
}

// The kernel adds this to `wide` and compares with zero. What flushing the component takes, 2^-85,
// is paid by the extent (see extent.sum).
std::string halfspace_parallel(const Constants& k) {
  Script script(kGlsl);
  const Parallel p = parallel(script, k);
  const Number more = slack(p.steep, p.depth, k) * Number(1 + k.eight_u);
  return script.claims_not_negative(
      exact_difference(more, exact_difference(p.exact, script.between("1b-85", "1b-85"))));
}

// T is the exact quotient of what the numerator stands for. The numerator is one rounding off and
// may be flushed, where the divisor is 2^-20 or more.
std::string slab_end(const Constants& k) {
  Script script(kGlsl);
  const Number exact = script.value("T");
  const Number t = script.rounded_quotient(script.shifted(script.perturbed(exact), "1b-106"));
  return script.claims_not_negative(
      exact_difference(far_end(t, k), exact_sum(exact, script.between(kHalf, kHalf))));
}

std::string slab_depth(const Constants& k) {
  Script script(kGlsl);
  const Number mz = script.value("M"), far = script.value("F");
  const Number needed = exact_difference(exact_sum(mz, far), script.between(kLeft, kLeft));
  return script.claims_not_negative(exact_difference(far_depth(mz, far, k), needed));
}

// In two steps: the doubt e pays for s, and the widening for the sums.
std::string halfspace_wide(const Constants& k) {
  Script script(kGlsl);
  const Number h = script.value("H"), s = script.value("S");
  const Number e = exact_sum(0.99 * kSlab.tiny, script.magnitude("E"));
  const Number wider = wide(room(h, s, e), h, s, e, k);
  const Number needed =
      exact_difference(exact_sum(exact_difference(h, s), e), script.between(kLeft, kLeft));
  return script.claims_not_negative(exact_difference(wider, needed));
}

// ---- the extent of the exact offset ----

// The largest corner along n and the ball, for the corner that is the farthest: the others only
// enlarge it. |n| is taken as (1 + |n|^2) / 2. The claim is beyond it by 14 u of the ball.
std::string extent_sum(const Constants& k, double radius_constant) {
  Script script(kGlsl);
  const Constants of_ball = {radius_constant, k.four_u, k.tiny};
  const Number x = script.value("X"), y = script.value("Y"), z = script.value("Z");
  const Number px = script.rounded_product(x), py = script.rounded_product(y),
               pz = script.rounded_product(z);
  const Number radius = exact_sum(0x1p-60, script.magnitude("R"));
  const auto square = [&](const char* name) { return script.magnitude(name, "4"); };
  const Number xx = square("NX"), yy = square("NY"), zz = square("NZ");
  const Number of_radius = ball(radius, script.rounded_product(xx), script.rounded_product(yy),
                                script.rounded_product(zz), of_ball);
  const Number q = along(px, py, pz);
  const Number e = along_doubt(px, py, pz, k);
  // The second sum is left to `extent`.
  const Number sum = exact_sum(q + e, of_radius);
  const Number length = exact_sum(0.5, exact_product(0.5, exact_sum(exact_sum(xx, yy), zz)));
  const Number needed = exact_sum(exact_sum(exact_sum(x, y), z),
                                  exact_product(exact_product(1 + 14 * 0x1p-23, radius), length));
  return script.claims_not_negative(exact_difference(sum, needed));
}

std::string extent_rounding(const Constants& k) {
  Script script(kGlsl);
  const Number exact = script.value("X");
  const Number sum = script.shifted(script.perturbed(exact), "1b-126");
  return script.claims_not_negative(
      exact_difference(extent(sum, k), exact_difference(exact, script.between(kLeft, kLeft))));
}

// ---- the table ----

std::function<std::string(double)> with_eight(std::string (*script)(const Constants&)) {
  return [script](double value) { return script({value, kSlab.four_u, kSlab.tiny}); };
}
std::function<std::string(double)> with_tiny(std::string (*script)(const Constants&)) {
  return [script](double value) { return script({kSlab.eight_u, kSlab.four_u, value}); };
}

}  // namespace

std::vector<Bound> slab_bounds() {
  const std::string file = "offsets/slab.glsl";
  return {
      {"slab.doubt", "the position of a line in a slab is within its doubt", "kEightU", file,
       kSlab.eight_u, "v", with_eight(slab_doubt), 0.25},
      {"slab.doubt_flushed", "the same, where results are flushed", "kTiny", file, kSlab.tiny, "",
       with_tiny(slab_doubt), 0.25},
      {"slab.height", "the half width of a slab holds the doubt", "kEightU", file, kSlab.eight_u,
       "v", with_eight(slab_height), 0.125},
      {"slab.parallel", "a slab that is all but parallel to the line is not missed", "kEightU",
       file, kSlab.eight_u, "v", with_eight(slab_parallel), 0.25},
      {"slab.end", "an end of the interval, relative to the centre, is outside the exact one",
       "kEightU", file, kSlab.eight_u, "v", with_eight(slab_end)},
      {"slab.end_flushed", "the same, where results are flushed", "kTiny", file, kSlab.tiny, "",
       with_tiny(slab_end), 0.25},
      {"slab.depth", "the same as a depth", "kFourU", file, kSlab.four_u, "v",
       [](double value) {
         return slab_depth({kSlab.eight_u, value, kSlab.tiny});
       }},
      {"halfspace.wide", "the room of a halfspace around a line is not too small", "kEightU", file,
       kSlab.eight_u, "v", with_eight(halfspace_wide), 0.25},
      {"halfspace.parallel", "what a halfspace that is all but parallel adds is not too small",
       "kEightU", file, kSlab.eight_u, "v", with_eight(halfspace_parallel), 0.125},
  };
}

std::vector<Bound> extent_bounds() {
  const std::string file = "offsets/slab.glsl";
  return {
      {"extent.corner", "the extent of the exact offset along a normal holds its corners",
       "kEightU", file, kSlab.eight_u, "v",
       [](double value) {
         return extent_sum({value, kSlab.four_u, kSlab.tiny}, kSlab.eight_u);
       }},
      {"extent.ball", "and the ball around them, with 14 u of it to spare", "kEightU", file,
       kSlab.eight_u, "v", [](double value) { return extent_sum(kSlab, value); }},
      {"extent.sum", "the same, for the rounding of the last sums", "kEightU", file, kSlab.eight_u,
       "v", with_eight(extent_rounding), 0.125},
  };
}

}  // namespace farcull::proofs
