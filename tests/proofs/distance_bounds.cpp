// The filter of distances: two points near each other, and the direction between them; and the test
// whether two pairs have the same closest points (verify/nearest_pair.cpp). R is the largest
// |coordinate| of the corners relative to one of them, exactly; its computed value is one rounding
// off.
#include <array>

#include "tests/proofs/bounds.h"
#include "tests/proofs/number.h"
#include "tests/proofs/raw.h"
#include "verify/rounding.h"

namespace farcull::proofs {
namespace {

constexpr double u = 0x1p-53;
// Steps on the way, each proved here. Of the sum of the weights of three corners; of a point with
// these weights, in R; of the difference of two such points, per axis in R; of its length, in R; of
// a computed length, relative to it.
constexpr double kWeights = 4 * u;
constexpr double kPoint = 9 * u;
constexpr double kDifference = 20.1 * u;
constexpr double kLengthOff = 35 * u;
constexpr double kRoot = 3 * u;
const std::string kLost = "1b-1070";  // more than all that underflows in a point

using Axes = std::array<Number, 3>;

Number exact_sum_of(const Axes& x) { return exact_sum(exact_sum(x[0], x[1]), x[2]); }

Number computed_sum_of(const Axes& x, Script& script) {
  return script.sum_in_any_order(x[0], x[1], x[2]);
}

std::string weights(double off) {
  return raw_script(
      "@rnd = float<ieee_64,ne>;\nl = rnd(l_);\nm = rnd(m_);\nk = rnd(rnd(1 - l) - m);",
      "l in [0,1] /\\ m in [0,1]", "|k - (1 - l - m)| <= " + literal(off));
}

std::string point_of_face(double off) {
  Script script(kDouble);
  // R times the weights divided by their sum, so that these sum to 1.
  const Number sum_of_weights = exact_sum(1.0, script.part(kWeights));
  Number exact, computed, all;
  for (const char* const name : {"A0", "A1", "A2"}) {
    const Number x = script.within(name);
    const Number term = script.rounded_product(script.perturbed(exact_product(x, sum_of_weights)));
    const bool first = std::string(name) == "A0";
    exact = first ? x : exact_sum(exact, x);
    computed = first ? term : computed + term;
    const Number size = script.magnitude(name);
    all = first ? size : exact_sum(all, size);
  }
  const Number allowed = exact_sum(exact_product(off, all), script.between(kLost, kLost));
  return script.claims_not_negative(exact_difference(allowed, exact_difference(computed, exact)));
}

std::string point_of_edge(double off) {
  Script script(kDouble);
  const Number x0 = script.within("A0"), x1 = script.within("A1");
  // The weight 1 - t is rounded, t is what it is.
  const Number first = script.rounded_product(script.perturbed(script.perturbed(x0)));
  const Number second = script.rounded_product(script.perturbed(x1));
  const Number error = exact_difference(first + second, exact_sum(x0, x1));
  const Number all = exact_sum(script.magnitude("A0"), script.magnitude("A1"));
  return script.claims_not_negative(
      exact_difference(exact_sum(exact_product(off, all), script.between(kLost, kLost)), error));
}

std::string difference_of_points(double off) {
  Script script(kDouble);
  const Number size = script.magnitude("R");
  const Number p = script.within("R"), q = script.within("R");
  const auto computed = [&](const Number& exact) {
    return script.shifted(exact_sum(exact, exact_product(size, script.part(kPoint))), kLost);
  };
  const Number error = exact_difference(computed(q) - computed(p), exact_difference(q, p));
  return script.claims_not_negative(exact_difference(
      exact_sum(exact_product(off, size), script.between("1b-1068", "1b-1068")), error));
}

std::string length_of_difference(double off) {
  return raw_script("", "x in [" + literal(kDifference) + "," + literal(kDifference) + "]",
                    "sqrt(3) * x <= " + literal(off));
}

std::string root(double off) {
  return raw_script("", bounded({"d"}, "1b-53") + " /\\ " + bounded({"s"}, literal(3.01 * u)),
                    "|sqrt(1 + s) * (1 + d) - 1| <= " + literal(off));
}

std::string near(double point, double absolute) {
  Script script(kDouble);
  const Number size = script.magnitude("R");
  const Number length = exact_product(4.0, script.within("R"));
  const Number computed = script.scaled(length, "-" + literal(kRoot), literal(kRoot));
  const Number bound = (computed + point * script.perturbed(size)) + absolute;
  const Number most = exact_sum(exact_sum(length, exact_product(kLengthOff, size)),
                                script.between("1b-1067", "1b-1067"));
  return script.claims_not_negative(exact_difference(bound, most));
}

// The difference of two projections onto d. What is claimed leaves half of `absolute` to the script
// that follows.
std::string far(double gap, double absolute) {
  Script script(kDouble);
  Axes size, s, t, s_exact, t_exact;
  const char* const names[3] = {"X", "Y", "Z"};
  for (int i = 0; i < 3; ++i) {
    const std::string name = names[i];  // |d| times the extent
    size[i] = script.rounded_product(script.magnitude(name));
    const Number p = script.within(name), q = script.within(name);
    s[i] = script.rounded_product(p);
    t[i] = script.rounded_product(q);
    s_exact[i] = script.perturbed(p);
    t_exact[i] = script.perturbed(q);
  }
  const Number doubt = gap * computed_sum_of(size, script) + absolute;
  const Number error =
      exact_difference(computed_sum_of(t, script) - computed_sum_of(s, script),
                       exact_difference(exact_sum_of(t_exact), exact_sum_of(s_exact)));
  return script.claims_not_negative(
      exact_difference(exact_difference(doubt, error), script.between("1b-1001", "1b-1001")));
}

// A difference beyond this, rounded once more, is beyond the clearance times the length.
std::string needed(double rounding) {
  Script script(kDouble);
  const Number exact = script.magnitude("CL");
  const Number needed =
      script.rounded_product(script.scaled(exact, "-" + literal(kRoot), literal(kRoot)));
  const Number beyond = script.perturbed(needed + needed * rounding);
  return script.claims_not_negative(
      exact_difference(exact_sum(beyond, script.between("1b-1001", "1b-1001")), exact));
}

// distance_bounds(): the gap, at most the exact one before its own rounding, over the computed
// length of d, times 1 - rounding. Each of three results is rounded; relative to the distance.
std::string lower(double rounding) {
  return raw_script("",
                    bounded({"a", "b", "c"}, "1b-53") + " /\\ " + bounded({"e"}, literal(kRoot)),
                    "(1 + a) * (1 + b) * (1 + c) * (1 - " + literal(rounding) + ") / (1 + e) <= 1");
}

// SamePoints: w . (x - p) is below 0 where the computed one is below minus its bound. Per axis: W
// is the magnitude of the computed w, P and Q those of the rounded points, F that of the computed
// x - p.
std::string same_points(double tie, double points, double subnormal, double absolute) {
  Script script(kDouble);
  Axes computed, exact, bound;
  const char* const axes[3] = {"X", "Y", "Z"};
  for (int i = 0; i < 3; ++i) {
    const std::string axis = axes[i];
    const Number w_size = script.magnitude("W" + axis), p_size = script.magnitude("P" + axis),
                 q_size = script.magnitude("Q" + axis), from_size = script.magnitude("F" + axis);
    const Number w = script.within("W" + axis), from = script.within("F" + axis);
    computed[i] = script.rounded_product(exact_product(w, from));
    // Each point is off by u of its rounded coordinate, or by half of the last bit of a subnormal.
    const Number off_points =
        exact_sum(exact_product(p_size, script.part(u)), exact_product(q_size, script.part(u)));
    const Number off = exact_sum(off_points, script.between("-1b-1074", "1b-1074"));
    exact[i] = exact_product(exact_sum(script.perturbed(w), off), script.perturbed(from));
    const Number of_points =
        script.rounded_product(exact_product(points, script.perturbed(exact_sum(p_size, q_size))));
    const Number of_axis = script.perturbed(exact_sum(
        script.perturbed(exact_sum(script.rounded_product(exact_product(tie, w_size)), of_points)),
        Number(subnormal)));
    bound[i] = script.rounded_product(exact_product(of_axis, from_size));
  }
  const Number whole =
      script.perturbed(exact_sum(computed_sum_of(bound, script), Number(absolute)));
  const Number error = exact_difference(exact_sum_of(exact), computed_sum_of(computed, script));
  return script.claims_not_negative(exact_difference(whole, error));
}

}  // namespace

std::vector<Bound> distance_bounds() {
  using B = FilterBounds;
  const std::string file = "verify/rounding.h", here = "tests/proofs/distance_bounds.cpp",
                    tie = "verify/rounding.h";
  return {
      {"distance.weights", "the weights of three corners sum to 1 within this", "kWeights", here,
       kWeights, "u", weights, 0.125},
      {"distance.face", "a computed point of a face, from a point of the triangle, per axis in R",
       "kPoint", here, kPoint, "u", point_of_face},
      {"distance.edge", "a computed point of an edge, likewise", "kPoint", here, kPoint, "u",
       point_of_edge, 0.25},
      {"distance.difference", "the difference of two such points, per axis in R", "kDifference",
       here, kDifference, "u", difference_of_points},
      {"distance.length", "the length of that difference, in R", "kLengthOff", here, kLengthOff,
       "u", length_of_difference},
      {"distance.root", "a computed length, relative to it", "kRoot", here, kRoot, "u", root},
      {"distance.point", "what is called near is as near: an upper bound of the distance",
       "FilterBounds::point", file, B::point, "u", [](double x) { return near(x, B::absolute); }},
      {"distance.point_underflow", "the same, where products underflow", "FilterBounds::absolute",
       file, B::absolute, "", [](double x) { return near(B::point, x); }, 0},
      {"distance.gap", "the gap along a direction is as large, but for the doubt",
       "FilterBounds::gap", file, B::gap, "u", [](double x) { return far(x, B::absolute); }},
      {"distance.gap_underflow", "the same, where products underflow", "FilterBounds::absolute",
       file, B::absolute, "", [](double x) { return far(B::gap, x); }},
      {"distance.needed", "a clearance times a length is not too small", "kNeededRounding", file,
       kNeededRounding, "u", needed},
      {"distance.lower", "a gap over a length, less that part, is at most the distance",
       "kNeededRounding", file, kNeededRounding, "u", lower},
      {"distance.tie", "a corner is behind the plane through a closest point, in the difference",
       "kTie", tie, kTie, "u",
       [](double x) { return same_points(x, kTiePoints, kTieSubnormal, kTieAbsolute); }},
      {"distance.tie_points", "the same, for the rounding of the two points", "kTiePoints", tie,
       kTiePoints, "u", [](double x) { return same_points(kTie, x, kTieSubnormal, kTieAbsolute); }},
      {"distance.tie_subnormal", "the same, where a coordinate is subnormal", "kTieSubnormal", tie,
       kTieSubnormal, "", [](double x) { return same_points(kTie, kTiePoints, x, kTieAbsolute); },
       0},
      {"distance.tie_absolute", "the same, where products underflow", "kTieAbsolute", tie,
       kTieAbsolute, "", [](double x) { return same_points(kTie, kTiePoints, kTieSubnormal, x); },
       0},
  };
}

}  // namespace farcull::proofs
