// The kernel of interval pairs (core/pairs/interval.glsl), for any rounding that GLSL allows. m is
// the largest |coordinate| of the triangle along an axis. `widen` is at least 2^-40 px.
#include <algorithm>

#include "core/base/glsl_shim.h"
#include "tests/proofs/bounds.h"
#include "tests/proofs/kernel_steps.h"
#include "tests/proofs/number.h"
#include "tests/proofs/raw.h"

namespace farcull::glsl::proofs {
#include "core/pairs/interval.glsl"
}  // namespace farcull::glsl::proofs

namespace farcull::proofs {
namespace {

constexpr double u = 0x1p-23;
const IntervalConstants kInterval = {glsl::proofs::kBoundUnit, glsl::proofs::kClipUnit};
// Steps on the way, each proved here: the place of a border line along an edge, a point there in m,
// the place of a cut along a segment, and its depth in m.
constexpr double kPlace = 5 * u;
constexpr double kStripPoint = 16 * u;
constexpr double kCutPlace = 6 * u;
constexpr double kDepth = 18 * u;
constexpr double kVertex = u / 2;  // rounding to the nearest float

Number widening(Script& script) { return exact_sum(0x1p-40, script.magnitude("W", "1b20")); }

std::string bounds_above(double unit) {
  Script script(kGlsl);
  const Number size = script.magnitude("M");
  const Number most = script.within("M");
  const Number widen = widening(script);
  const Number above = most + bound_error(widen, size, {unit, kInterval.clip_unit});
  const Number needed = exact_sum(exact_sum(most, widen), exact_product(kVertex, size));
  return script.claims_not_negative(exact_difference(above, needed));
}

std::string place_in_strip(double off) {
  return raw_script("", bounded({"a", "b"}, "1b-23") + " /\\ |c| <= 5b-24",
                    "|(1 + a) * (1 + c) / (1 + b) - 1| <= " + literal(off));
}

// A point at the part t of an edge: t is off by `place`, relative to it; t (q - p) is at most 2 m.
std::string point_at(double place, double off) {
  Script script(kGlsl);
  const Number size = script.magnitude("M");
  const Number point = script.within("M");
  const Number along = exact_product(2.0, script.within("M"));
  const Number computed = script.rounded_product(
      script.scaled(script.perturbed(along), "-" + literal(place), literal(place)));
  // What flushing a difference takes, and flushing t, which is then below 2^-126.
  const Number p = script.shifted(
      script.perturbed(exact_sum(point, exact_difference(computed, along))), "1b-104");
  return script.claims_not_negative(
      exact_difference(exact_sum(exact_product(off, size), script.between("1b-103", "1b-103")),
                       exact_difference(p, point)));
}

std::string place_of_cut(double off) {
  return raw_script("", bounded({"a", "b", "d"}, "1b-23") + " /\\ |c| <= 5b-24",
                    "|(1 + a) * (1 + c) * (1 + d) / (1 + b) - 1| <= " + literal(off));
}

// far_margin() is told the bounds before they are cut to anything: they reach m + `widen` at least.
// The rounding of `widen` itself is paid by that.

// The far depth of the real triangle over a rectangle: that of the float triangle may be off by the
// strip and by the cut, and the real one is within `widen` and half a unit of it.
std::string depth_margin(double unit) {
  Script script(kGlsl);
  const Number size = script.magnitude("M");
  const Number exact = script.within("M");
  const Number widen = widening(script);
  const Number computed = exact_sum(exact, exact_product(size, script.part(kStripPoint + kDepth)));
  const Number far = computed + margin(widen, exact_sum(size, widen), {kInterval.bound_unit, unit});
  const Number needed = exact_sum(exact_sum(exact, widen), exact_product(kVertex, size));
  return script.claims_not_negative(exact_difference(far, needed));
}

// The right border of the rectangle of a part of a pixel. It is at most m + `widen` + 1, and is
// itself the result of two sums.
std::string image_margin(double unit) {
  Script script(kGlsl);
  script.magnitude("one", "1");
  const Number size = script.magnitude("M");
  const Number widen = widening(script);
  const Number exact =
      exact_sum(exact_sum(script.within("M"), script.within("W")), script.within("one"));
  const Number border = script.perturbed(script.perturbed(exact));
  const Number grown = border + margin(widen, exact_sum(size, widen), {kInterval.bound_unit, unit});
  const Number needed =
      exact_sum(exact_sum(exact, widen), exact_product(kVertex + kStripPoint, size));
  return script.claims_not_negative(exact_difference(grown, needed));
}

// Sterbenz: the difference of a coordinate and its cell's border is a float.
std::string difference_in_part(double least) {
  const double beyond = 1 / std::max(least, 0x1p-100);
  return raw_script("x = float<ieee_32,ne>(x_);\np = float<ieee_32,ne>(p_);",
                    "x in [1b-30,1b20] /\\ p -/ x in [0," + literal(beyond) + "]",
                    "@FLT(p - x, 24)");
}

}  // namespace

std::vector<Bound> interval_bounds() {
  const std::string file = "core/pairs/interval.glsl", here = "tests/proofs/interval_bounds.cpp";
  return {
      {"interval.bounds", "the bounds of a triangle hold its real points", "kBoundUnit", file,
       kInterval.bound_unit, "v", bounds_above},
      {"interval.place", "the place of a border line along an edge, relative to it", "kPlace", here,
       kPlace, "v", place_in_strip},
      {"interval.strip", "a point of the strip's border, in m", "kStripPoint", here, kStripPoint,
       "v", [](double x) { return point_at(kPlace, x); }},
      {"interval.cut_place", "the place of a cut along a segment, relative to it", "kCutPlace",
       here, kCutPlace, "v", place_of_cut},
      {"interval.depth", "the depth there, in m", "kDepth", here, kDepth, "v",
       [](double x) { return point_at(kCutPlace, x); }},
      {"interval.depth_margin", "an interval of depths holds those of the real triangle",
       "kClipUnit", file, kInterval.clip_unit, "v", depth_margin},
      {"interval.image_margin", "a rectangle grows enough to speak of the float triangle",
       "kClipUnit", file, kInterval.clip_unit, "v", image_margin, 0.25},
      {"interval.part",
       "a coordinate less its cell's border is a float, for a part of a pixel; "
       "the border is at least this part of the side",
       "border / side", "core/pairs/interval.glsl", 1, "", difference_in_part},
  };
}

}  // namespace farcull::proofs
