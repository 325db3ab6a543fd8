// The filters against planes. The formulas are not written here: filter_planes.inl is compiled with
// numbers that write down what it computes.
#include <cmath>

#include "tests/proofs/bounds.h"
#include "tests/proofs/number.h"
#include "tests/proofs/raw.h"
#include "verify/rounding.h"

namespace farcull::proofs {
namespace {

using PlainReal = double;
using Real = Number;
using Truth = bool;
struct Point {
  Number at[3];
  Number x() const { return at[0]; }
  Number y() const { return at[1]; }
  Number z() const { return at[2]; }
};
bool of_all(bool answer) { return answer; }
#define FAR_FILTER [[maybe_unused]] inline
#include "verify/filter_planes.inl"
#undef FAR_FILTER

// The bounds as the text takes them, with values that a script sets.
struct Claimed {
  static inline double side, absolute, normals;
  Claimed() {
    side = FilterBounds::side;
    absolute = FilterBounds::absolute;
    normals = FilterBounds::normals;
  }
};

// ---- vectors without rounding ----

Triple exact_cross(const Triple& e, const Triple& f) {
  const auto minor = [](const Number& a, const Number& b, const Number& c, const Number& d) {
    return exact_difference(exact_product(a, b), exact_product(c, d));
  };
  return {minor(e.y, f.z, e.z, f.y), minor(e.z, f.x, e.x, f.z), minor(e.x, f.y, e.y, f.x)};
}

Number exact_dot(const Triple& p, const Triple& q) {
  return exact_sum(exact_sum(exact_product(p.x, q.x), exact_product(p.y, q.y)),
                   exact_product(p.z, q.z));
}

// A vector, and its computed differences: each is one rounding off.
struct Differences {
  Triple exact, computed;
};
Differences differences(Script& script, const std::string& name) {
  const Triple exact = {script.value(name + "x"), script.value(name + "y"),
                        script.value(name + "z")};
  return {exact, {script.perturbed(exact.x), script.perturbed(exact.y), script.perturbed(exact.z)}};
}

// Computed differences within the magnitudes `most`, and the exact vector.
struct Within {
  Triple exact, computed, most;
};
Within within(Script& script, const std::string& name) {
  const Triple most = {script.magnitude(name + "x"), script.magnitude(name + "y"),
                       script.magnitude(name + "z")};
  const Triple computed = {script.within(name + "x"), script.within(name + "y"),
                           script.within(name + "z")};
  return {
      {script.perturbed(computed.x), script.perturbed(computed.y), script.perturbed(computed.z)},
      computed,
      most};
}

// ---- scripts ----

std::string side_of_plane(const Claimed&) {
  Script script(kDouble);
  const Differences e = differences(script, "E");
  const Differences f = differences(script, "F");
  const Within w = within(script, "W");
  const Normal normal = normal_of(e.computed, f.computed);
  const Number bound = side_bound<Claimed>(normal, w.most);
  const Number error = exact_difference(dot(normal.n, w.computed),
                                        exact_dot(exact_cross(e.exact, f.exact), w.exact));
  return script.claims_not_negative(exact_difference(bound, error));
}

// Of a component of a computed normal: how far it is off the exact one, in the exact sum of the
// magnitudes of its two terms; and what underflow adds. Proved once, and taken by others.
constexpr double kComponent = 4.01 * 0x1p-53;
const std::string kComponentLost = "1b-1073";

std::string component_of_normal(double off) {
  Script script(kDouble);
  const Differences e = differences(script, "E");
  const Differences f = differences(script, "F");
  const Normal normal = normal_of(e.computed, f.computed);
  const Number error = exact_difference(normal.n.x, exact_cross(e.exact, f.exact).x);
  const Number terms = exact_sum(exact_product(abs(e.exact.y), abs(f.exact.z)),
                                 exact_product(abs(e.exact.z), abs(f.exact.y)));
  return script.claims_not_negative(exact_difference(
      exact_sum(exact_product(off, terms), script.between(kComponentLost, kComponentLost)), error));
}

// The same of the computed magnitudes, which are used as lower bounds.
std::string magnitudes_of_normal(double off) {
  Script script(kDouble);
  const Differences e = differences(script, "E");
  const Differences f = differences(script, "F");
  const Normal normal = normal_of(e.computed, f.computed);
  const Number terms = exact_sum(exact_product(abs(e.exact.y), abs(f.exact.z)),
                                 exact_product(abs(e.exact.z), abs(f.exact.y)));
  const Number off_least = exact_difference(exact_product(1 - off, terms),
                                            script.between(kComponentLost, kComponentLost));
  return script.claims_not_negative(exact_difference(normal.m.x, off_least));
}

// A normal as the two scripts above bound it: exact, computed, and the computed magnitudes.
struct BoundedNormal {
  Triple exact;
  Normal computed;
};
BoundedNormal bounded_normal(Script& script, const std::string& name) {
  const std::string off = literal(kComponent);
  BoundedNormal out;
  Number* const parts[3][3] = {{&out.exact.x, &out.computed.n.x, &out.computed.m.x},
                               {&out.exact.y, &out.computed.n.y, &out.computed.m.y},
                               {&out.exact.z, &out.computed.n.z, &out.computed.m.z}};
  for (int i = 0; i < 3; ++i) {
    const std::string axis = name + std::string(1, "xyz"[i]);
    const Number terms = script.magnitude(axis);
    const Number lost = script.between("-" + kComponentLost, kComponentLost);
    *parts[i][0] = script.within(axis);
    *parts[i][1] = exact_sum(*parts[i][0],
                             exact_sum(exact_product(terms, script.between("-" + off, off)), lost));
    *parts[i][2] = exact_sum(script.scaled(terms, "-" + off, off),
                             script.between("-" + kComponentLost, kComponentLost));
  }
  return out;
}

std::string product_of_normals(const Claimed& claimed) {
  Script script(kDouble);
  const BoundedNormal n = bounded_normal(script, "N");
  const BoundedNormal m = bounded_normal(script, "M");
  const Number bound = claimed.normals * dot(n.computed.m, m.computed.m) +
                       claimed.absolute * (sum(n.computed.m) + sum(m.computed.m) + 1);
  const Number error =
      exact_difference(dot(n.computed.n, m.computed.n), exact_dot(n.exact, m.exact));
  return script.claims_not_negative(exact_difference(bound, error));
}

std::string projection(const Claimed& claimed) {
  Script script(kDouble);
  const Triple d = {script.value("Dx"), script.value("Dy"), script.value("Dz")};
  const Within w = within(script, "W");
  const Number bound = claimed.side * dot(magnitudes(d), w.most) + claimed.absolute;
  const Number error = exact_difference(dot(d, w.computed), exact_dot(d, w.exact));
  return script.claims_not_negative(exact_difference(bound, error));
}

// The root of the square of a length, which errs by three roundings.
std::string length(double off) {
  return raw_script("", bounded({"d"}, "1b-53") + " /\\ " + bounded({"s"}, literal(3.01 * 0x1p-53)),
                    "|sqrt(1 + s) * (1 + d) - 1| <= " + literal(off));
}
constexpr double kLength = 3 * 0x1p-53;

// at_clearance(): the length of the computed normal is taken as 2^-450 at least.
std::string at_clearance_from(double share, double factor) {
  Script script(kDouble);
  const Number clearance = script.magnitude("C");
  const Number longer =
      exact_sum(Number(std::sqrt(kLeastSquare)), script.magnitude("N"));  // than the normal
  const Number terms = script.magnitude("S");  // the exact sum of the magnitudes
  const std::string off = literal(kComponent + 3 * 0x1p-53);
  const Number computed_sum =
      exact_sum(script.scaled(terms, "-" + off, off), script.between("-1b-1070", "1b-1070"));
  const Number computed_length = script.scaled(longer, "-" + literal(kLength), literal(kLength));
  const Number needed =
      clearance * (computed_length + computed_sum * share) * (1 + factor) + 0x1p-1000;
  const Number enough =
      exact_product(clearance, exact_sum(exact_sum(longer, exact_product(kComponent, terms)),
                                         script.between("1b-1071", "1b-1071")));
  return script.claims_not_negative(exact_difference(needed, enough));
}
std::string length_of_normal(double share) { return at_clearance_from(share, kNormalRounding); }
std::string needed_at_clearance(double factor) { return at_clearance_from(kNormalLength, factor); }

template <class Set>
std::function<std::string(double)> with(Set set, std::string (*script)(const Claimed&)) {
  return [set, script](double value) {
    Claimed claimed;
    set(value);
    return script(claimed);
  };
}

}  // namespace

std::vector<Bound> filter_bounds() {
  const auto side = [](double value) { Claimed::side = value; };
  const auto absolute = [](double value) { Claimed::absolute = value; };
  const auto normals = [](double value) { Claimed::normals = value; };
  const std::string file = "verify/rounding.h";
  return {
      {"filter.side",
       "which side of a plane a corner is on: the computed determinant is within its "
       "bound of the exact one",
       "FilterBounds::side", file, FilterBounds::side, "u", with(side, side_of_plane)},
      {"filter.side_underflow", "the same, where products underflow", "FilterBounds::absolute",
       file, FilterBounds::absolute, "", with(absolute, side_of_plane), 0},
      {"filter.normals",
       "the product of the normals of two triangles at an edge is within its bound",
       "FilterBounds::normals", file, FilterBounds::normals, "u",
       with(normals, product_of_normals)},
      {"filter.normals_underflow", "the same, where products underflow", "FilterBounds::absolute",
       file, FilterBounds::absolute, "", with(absolute, product_of_normals), 0},
      {"filter.component",
       "a component of a computed normal is within this part of the sum of the "
       "magnitudes of its two terms",
       "kComponent", "tests/proofs/filter_bounds.cpp", kComponent, "u", component_of_normal},
      {"filter.component_magnitudes",
       "the computed sum of these magnitudes is at most that much too small", "kComponent",
       "tests/proofs/filter_bounds.cpp", kComponent, "u", magnitudes_of_normal},
      {"filter.length", "the length of a vector, from three products, two sums and a root",
       "kLength", "tests/proofs/filter_bounds.cpp", kLength, "u", length},
      {"filter.clearance_length", "a clearance times the length of a normal is not too small",
       "kNormalLength", file, kNormalLength, "u", length_of_normal},
      {"filter.clearance_rounding", "the same, for the rounding of that product", "kNormalRounding",
       file, kNormalRounding, "u", needed_at_clearance, 0.25},
      {"filter.projection", "the projection of a difference onto a direction is within its bound",
       "FilterBounds::side", file, FilterBounds::side, "u", with(side, projection), 0.25},
  };
}

}  // namespace farcull::proofs
