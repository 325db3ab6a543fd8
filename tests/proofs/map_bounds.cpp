// The way of a point from the world to the window: the map, clipping, and the budget's terms. M is
// half the viewport's side (px).
#include "core/canvas/canvas.h"
#include "core/view/budget.h"
#include "tests/proofs/bounds.h"
#include "tests/proofs/number.h"
#include "tests/proofs/raw.h"

namespace farcull::proofs {
namespace {

// A double at or above, and one at or below, the root of 2.
constexpr double kAboveRoot2 = 0x1.6a09e667f3bcdp+0;
constexpr double kViewport = 4096;

// ---- the map ----

std::string map_to_pixels(double rounding, double underflow) {
  Script script(kDouble);
  std::vector<Number> exact, computed;
  for (const char* const name : {"A", "B", "C"}) {
    exact.push_back(script.value(name));
    computed.push_back(script.rounded_product(script.perturbed(exact.back())));
  }
  const Number p = (computed[0] + computed[1]) + computed[2];
  const Number sum = (abs(computed[0]) + abs(computed[1])) + abs(computed[2]);
  const Number bound = rounding * sum + underflow;
  const Number all = exact_sum(exact_sum(exact[0], exact[1]), exact[2]);
  return script.claims_not_negative(exact_difference(bound, exact_difference(p, all)));
}

// The lower end of the image of a box, by the same rounding; 2^-1070 px for underflow.
std::string image_of_box(double rounding) {
  Script script(kDouble);
  std::vector<Number> exact, least, reach;
  for (const char* const name : {"A", "B", "C"}) {
    const Number computed = script.within(name);  // a coordinate of the box times a row's component
    exact.push_back(script.perturbed(computed));
    least.push_back(script.rounded_product(computed));
    reach.push_back(script.rounded_product(script.magnitude(name)));
  }
  const Number lo = (least[0] + least[1]) + least[2];
  const Number e = rounding * script.sum_in_any_order(reach[0], reach[1], reach[2]);
  const Number all = exact_sum(exact_sum(exact[0], exact[1]), exact[2]);
  return script.claims_not_negative(
      exact_difference(exact_sum(all, script.between("1b-1070", "1b-1070")), lo - e));
}

// ---- clipping ----

constexpr double kCutPlace = 3.01 * 0x1p-53;  // of the place of a cut along its edge, relative

std::string place_of_cut(double off) {
  return raw_script("", bounded({"d", "e", "f"}, "1b-53"),
                    "|(1 + d) * (1 + f) / (1 + e) - 1| <= " + literal(off));
}

std::string cut(double rounding) {
  Script script(kDouble);
  const Number size = script.magnitude("M");
  // from and to may themselves be cuts, which are beyond M by less than 2^-40 of it.
  const auto inside = [&] { return exact_product(1 + 0x1p-40, script.within("M")); };
  const Number point = inside();                      // the exact cut
  const Number along = exact_product(2.0, inside());  // t (to - from)
  const Number computed = script.rounded_product(
      script.perturbed(script.scaled(along, "-" + literal(kCutPlace), literal(kCutPlace))));
  const Number p = script.perturbed(exact_sum(point, exact_difference(computed, along)));
  const Number charged = script.perturbed(rounding * size);
  return script.claims_not_negative(exact_difference(
      exact_sum(charged, script.between("1b-1001", "1b-1001")), exact_difference(p, point)));
}

// ---- the budget ----

Budget budget_of(bool exact_samples) {
  RasterLimits limits;
  limits.subpixel_bits = 8;
  limits.depth_bits = 32;
  limits.exact_samples = exact_samples;
  return budget_for(limits, static_cast<int>(kViewport));
}

// The distance of (c, Q.z) from Q', where Q' is within 2^-10 px of Q along each axis.
std::string term_double(double term) {
  const std::string s = literal(budget_of(false).sampling);
  return raw_script("e = " + literal(kMaxDoubleError) + ";\na = sqrt(2) / 2 + sqrt(2) * e;",
                    "s in [" + s + "," + s + "]", "sqrt(a * a + e * e) - s <= " + literal(term));
}

// Each axis has the term's part in the plane. M is at least one pixel: 1 + the magnitude M.
Number coordinate(Script& script) {
  script.magnitude("one", "1");
  return exact_sum(script.within("M"), script.within("one"));
}

std::string term_input(double term) {
  Script script(kFloat);
  const Number size = exact_sum(1.0, script.magnitude("M"));
  const Number x = coordinate(script);
  const double axis = term / (kAboveRoot2 * 0.5 * kViewport);
  const Number mapped = exact_sum(x, exact_product(size, script.part(0x1p-48)));
  const Number corner = script.shifted(script.perturbed(mapped), "1b-150");
  return script.claims_not_negative(
      exact_difference(exact_product(axis, size), exact_difference(corner, x)));
}

std::string term_vertex(double term) {
  Script script(kGlsl);
  const Number size = exact_sum(1.0, script.magnitude("M"));
  const Number x = coordinate(script), centre = coordinate(script);
  // In units in which 2 / viewport is 1: a product, a quotient by 1, a product, a sum.
  const Number placed = script.rounded_product(script.rounded_quotient(script.rounded_product(x)));
  const Number window = placed + centre;
  const double axis = term / (kAboveRoot2 * 0.5 * kViewport);
  return script.claims_not_negative(
      exact_difference(exact_product(axis, size), exact_difference(window, exact_sum(x, centre))));
}

// On the CPU: the corner's rounding, and that of the comparison of a centre with an edge.
constexpr double kEdge = 3.01 * 0x1p-24;

std::string edge(double off) {
  Script script(kFloat);
  const Number left = script.value("L"), right = script.value("R");
  const auto computed = [&](const Number& x) {
    return script.rounded_product(script.perturbed(script.perturbed(x)));
  };
  const Number error = exact_difference(exact_difference(computed(left), computed(right)),
                                        exact_difference(left, right));
  const Number allowed = exact_sum(exact_product(off, exact_sum(abs(left), abs(right))),
                                   script.between("1b-148", "1b-148"));
  return script.claims_not_negative(exact_difference(allowed, error));
}

std::string term_input_on_cpu(double term) {
  const std::string m = literal(0.5 * kViewport);
  return raw_script(
      "w = 1b-24;\nt = " + literal(term) + ";", "M in [" + m + "," + m + "]",
      "sqrt(2) * (w + 1b-48) * M * (1 + 1b-20) + " + literal(kEdge) + " * sqrt(8) * M - t <= 0");
}

// That the sum of the terms, as rounded, times 1 + this is beyond their exact sum; each is rounded
// from its real value by at most 8 u.
std::string radius(double more) {
  Script script(kDouble);
  Number sum, exact;
  for (const char* const name : {"S", "I", "D", "V", "N", "O"}) {
    const bool first = std::string(name) == "S";
    const Number term =
        first ? exact_sum(0.5, script.magnitude(name)) : script.magnitude(name);  // sampling is 0.7
    exact = first ? term : exact_sum(exact, term);
    const Number rounded = script.scaled(term, "-8b-53", "8b-53");
    sum = first ? rounded : sum + rounded;
  }
  return script.claims_not_negative(exact_difference(sum * (1 + more), exact));
}
double radius_factor() {
  Budget budget;
  budget.sampling = 1;
  return budget.radius() - 1;
}

// ---- the depth map ----

std::string depth_map(double steps, bool fixed) {
  std::string definitions, claim;
  for (const std::string direction : {"up", "dn", "zr", "ne"}) {
    const std::string name = "y" + direction;
    definitions += "@" + direction + "_ = float<ieee_32," + direction + ">;\n" + name + " = " +
                   direction + "_(0.5 + " + direction + "_(x));\n";
    claim += (claim.empty() ? "|" : " /\\ |") + name + " - (0.5 + x)" +
             (fixed ? " + (a + b)" : "") + "| <= " + literal(steps * 0x1p-24);
  }
  std::string known = "|x| <= 0.25";
  // The nearest of 2^24 - 1 steps may be any of two, and reading back rounds to a float.
  if (fixed) {
    known += " /\\ |a| <= " + literal((1 + 0x1p-50) / (0x1p24 - 1)) + " /\\ |b| <= 1b-24";
  }
  return raw_script(definitions, known, claim);
}

// One program stores, up wherever it rounds; another one asks, down wherever it rounds, so many
// steps behind. Every other way to round lies between, since each operation is monotone. The two
// halves of the map have floats of different units.
std::string asked_behind(double steps) {
  const std::string slack = literal(steps * 0x1p-24), most = "16777215";  // 2^24 - 1
  const std::string definitions =
      "@up_ = float<ieee_32,up>;\n@dn_ = float<ieee_32,dn>;\n@ceil_ = fixed<0,up>;\n"
      "@floor_ = fixed<0,dn>;\ns = up_(0.5 + up_(x));\na = dn_(0.5 + dn_(x));\nb = dn_(a + " +
      slack + ");\nstored = ceil_(s * " + most + ");\nasked = floor_(b * " + most + ");";
  const std::string claim = "b - s >= 0 /\\ asked - stored >= 0";
  return definitions + "\n{ (x in [-0.25,0] -> " + claim + ") /\\ (x in [0,0.25] -> " + claim +
         ") }\nb - s -> (b - (a + " + slack + ")) + " + slack +
         " - (s - a);\nasked - stored -> (asked - b * " + most + ") + (b - s) * " + most +
         " - (stored - s * " + most + ");\n";
}

}  // namespace

std::vector<Bound> map_bounds() {
  const std::string rounding = "core/view/view.h", budget = "core/view/budget.cpp";
  return {
      {"map.point", "a point mapped to pixels is within its bound", "kMapRounding", rounding,
       kMapRounding, "u", [](double x) { return map_to_pixels(x, kMapUnderflow); }},
      {"map.point_underflow", "the same, where products underflow", "kMapUnderflow", rounding,
       kMapUnderflow, "", [](double x) { return map_to_pixels(kMapRounding, x); }, 0},
      {"map.box", "the image of a box holds the images of its points, but for 2^-1070 px",
       "kMapRounding", rounding, kMapRounding, "u", image_of_box},
      {"clip.place", "the place of a cut along an edge, relative to it", "kCutPlace",
       "tests/proofs/map_bounds.cpp", kCutPlace, "u", place_of_cut},
      {"clip.cut", "a cut moves its corner by no more, per axis in M", "kCutRounding", rounding,
       kCutRounding, "u", cut},
      {"budget.double", "the term `double`, from the error of a point that can be drawn",
       "Budget::double_", budget, budget_of(false).double_, "", term_double},
      {"budget.input", "the term `input` on a GL device, for a viewport of 4096 px",
       "Budget::input", budget, budget_of(false).input, "", term_input},
      {"budget.vertex", "the term `vertex`, likewise", "Budget::vertex", budget,
       budget_of(false).vertex, "", term_vertex},
      {"budget.edge", "a centre compared with an edge in floats, relative to both products",
       "kEdge", "tests/proofs/map_bounds.cpp", kEdge, "w", edge},
      {"budget.input_on_cpu", "the term `input` on the CPU, likewise", "Budget::input", budget,
       budget_of(true).input, "", term_input_on_cpu},
      {"budget.radius", "the radius is beyond the exact sum of the terms", "Budget::radius", budget,
       radius_factor(), "u", radius, 0x1p-12},
      {"depth.map", "a mapped depth, in steps of 2^-24, rounded in any direction",
       "depth_rounding(32)", "core/canvas/canvas.h", depth_rounding(32), "",
       [](double x) { return depth_map(x, false); }},
      {"depth.map_24", "the same, stored with 24 bits", "depth_rounding(24)",
       "core/canvas/canvas.h", depth_rounding(24), "", [](double x) { return depth_map(x, true); }},
      {"depth.behind",
       "what is asked is seen where the exit is at the entry that another program stored, in "
       "either "
       "format, in steps of 2^-24",
       "kAskedBehind", "core/canvas/canvas.h", kAskedBehind * 0x1p24, "", asked_behind},
  };
}

}  // namespace farcull::proofs
