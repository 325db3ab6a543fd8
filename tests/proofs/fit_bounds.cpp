// Solids fitted in doubles and rounded outward to floats (offsets/fit.inl).

#include "offsets/rounding.h"
#include "tests/proofs/bounds.h"
#include "tests/proofs/number.h"
#include "tests/proofs/raw.h"

namespace farcull::proofs {
namespace {

// fit_up(): the nearest float of a double is within 2^-24 of it, and 2^-150.
std::string up(double half, double subnormal) {
  Script script(kDouble);
  const Number x = script.value("X");
  const Number beyond = (x + abs(x) * half) + subnormal;
  const Number nearest = script.shifted(script.scaled(beyond, "-1b-24", "1b-24"), "1b-150");
  return script.claims_not_negative(exact_difference(nearest, x));
}

// What fit_above() rounds up; fit_below() is its mirror image.
std::string above(double depth) {
  Script script(kDouble);
  const Number z = script.value("Z");
  const Number radius = exact_sum(0x1p-60, script.magnitude("R"));
  const Number beyond = (z + radius) + depth * (abs(z) + radius);
  return script.claims_not_negative(exact_difference(beyond, exact_sum(z, radius)));
}

// The extent of the box along a direction n whose components are floats. |n| is at most
// (1 + |n|^2) / 2, which the claim takes for it.
std::string extent_of_box(double size_part, double length_part) {
  Script script(kDouble);
  const Number radius = exact_sum(0x1p-60, script.magnitude("R"));
  std::vector<Number> exact, computed, square, squared;
  for (const char* const name : {"X", "Y", "Z"}) {
    exact.push_back(script.value(name));  // n times the difference of a corner and the centre
    computed.push_back(script.rounded_product(script.perturbed(exact.back())));
    square.push_back(script.magnitude(std::string("N") + name));
    squared.push_back(script.rounded_product(square.back()));
  }
  const Number reach = (computed[0] + computed[1]) + computed[2];
  const Number size = (abs(computed[0]) + abs(computed[1])) + abs(computed[2]);
  const Number length = (0.5 + 0.5 * ((squared[0] + squared[1]) + squared[2])) * (1 + length_part);
  const Number extent = (reach + size_part * size) + radius * length;
  const auto all = [](const std::vector<Number>& x) {
    return exact_sum(exact_sum(x[0], x[1]), x[2]);
  };
  const Number needed =
      exact_sum(all(exact), exact_product(radius, exact_sum(0.5, exact_product(0.5, all(square)))));
  return script.claims_not_negative(exact_difference(extent, needed));
}

// The radius that grows by the largest displacement of a corner: that of its float, whose
// difference is exact, and that of the subtraction, at most u times its length.
std::string grown_radius(double corner, double underflow, double rounding) {
  Script script(kDouble);
  const Number radius = script.magnitude("R"), lost = script.magnitude("L"),
               size = script.magnitude("D");
  const auto root = [&](const Number& x) {
    return exact_difference(script.scaled(x, "-3b-53", "3b-53"), script.between("0", "1b-509"));
  };
  const Number displaced = (root(lost) + corner * root(size)) + underflow;
  const Number grown = (radius + displaced) * (1 + rounding);
  const Number needed =
      exact_sum(exact_sum(radius, lost), exact_product(0x1.0000000000001p-53, size));
  return script.claims_not_negative(exact_difference(grown, needed));
}

}  // namespace

std::vector<Bound> fit_bounds() {
  const std::string file = "offsets/rounding.h";
  return {
      {"fit.up", "a double rounded up to a float is not below it", "kFitHalfUlp", file, kFitHalfUlp,
       "w", [](double x) { return up(x, kFitSubnormal); }},
      {"fit.up_subnormal", "the same, where the float is subnormal", "kFitSubnormal", file,
       kFitSubnormal, "", [](double x) { return up(kFitHalfUlp, x); }},
      {"fit.depth", "the depths of a solid hold its points", "kFitDepth", file, kFitDepth, "u",
       above, 0.25},
      {"fit.box", "the extent of the box holds its corners", "kFitBox", file, kFitBox, "u",
       [](double x) { return extent_of_box(x, kFitBox); }, 0.125},
      {"fit.box_radius", "and the ball around them", "kFitBox", file, kFitBox, "u",
       [](double x) { return extent_of_box(kFitBox, x); }, 0.125},
      {"fit.corner", "the radius of the exact offset grows by the displacement of a corner",
       "kFitCorner", file, kFitCorner, "u",
       [](double x) { return grown_radius(x, kFitUnderflow, kFitRadius); }, 0.0625},
      {"fit.corner_underflow", "the same, where squares underflow", "kFitUnderflow", file,
       kFitUnderflow, "", [](double x) { return grown_radius(kFitCorner, x, kFitRadius); }, 0},
      {"fit.radius", "the same, for the rounding of that radius", "kFitRadius", file, kFitRadius,
       "u", [](double x) { return grown_radius(kFitCorner, kFitUnderflow, x); }, 0.125},
  };
}

}  // namespace farcull::proofs
