// Exact closest points against a reference in integers and rationals, on pairs of every kind.
#include "verify/closest.h"

#include "tests/lab/closest.h"
#include "tests/lab/hard_pairs.h"
#include "tests/lab/test.h"
#include "verify/filter.h"
#include "verify/near_contact.h"
#include "verify/squared_distance.h"

namespace farcull {
namespace {

using closest_reference::is_rounded, closest_reference::is_rounded_root, reference::kTiny,
    reference::Rational, reference::RationalPoint, reference::Triangle;

Triangle whole(RandomDraws& random, int most) {
  Triangle t;
  for (Vec3& p : t)
    for (double& x : p) x = random.whole(0, most);
  return t;
}

/// Whole numbers: touching, parallel, degenerate and equal features by the thousand.
DrawnPair on_a_grid(RandomDraws& random) {
  const int most = random.whole(1, 5);
  return {whole(random, most), whole(random, most)};
}

/// Two planes of a grid: parallel faces over each other.
DrawnPair in_parallel_planes(RandomDraws& random) {
  DrawnPair pair = {whole(random, 6), whole(random, 6)};
  const int axis = random.below(3);
  const double height = random.whole(0, 3);
  for (Vec3& p : pair.a) p[axis] = 0;
  for (Vec3& p : pair.b) p[axis] = height;
  return pair;
}

/// Any two triangles, apart by about their size, each perhaps far smaller, and far from the origin.
DrawnPair apart(RandomDraws& random) {
  DrawnPair pair;
  const Vec3 at = random.chance(3) ? Vec3(1000 * hard_pairs::point(random)) : Vec3(0, 0, 0);
  const Vec3 by = 3 * hard_pairs::point(random);
  const double small = random.chance(4) ? std::ldexp(1, -random.whole(0, 60)) : 1;
  for (Vec3& p : pair.a) p = at + small * hard_pairs::point(random);
  for (Vec3& p : pair.b) p = at + by + hard_pairs::point(random);
  if (random.chance(5)) pair.a[2] = pair.a[random.below(2)];
  if (random.chance(5)) pair.b[1] = (pair.b[0] + pair.b[2]) / 2;
  return pair;
}

/// A triangle moved to touch the other one, nearly: at a corner, an edge or a face.
DrawnPair near_contact(RandomDraws& random) {
  DrawnPair pair = apart(random);
  const auto mean = [&](const Triangle& t) -> Vec3 {
    const double s = random.chance(3) ? 0 : random.unit();
    const double r = random.chance(3) ? 0 : random.unit() * (1 - s);
    return t[0] + s * (t[1] - t[0]) + r * (t[2] - t[0]);
  };
  const Vec3 gap =
      std::ldexp(random.chance(4) ? 0 : 1, -random.whole(10, 60)) * hard_pairs::point(random);
  const Vec3 by = mean(pair.a) - mean(pair.b) + gap;
  for (Vec3& p : pair.b) p += by;
  return pair;
}

/// Coordinates of all sizes that doubles have.
DrawnPair of_all_sizes(RandomDraws& random) {
  DrawnPair pair;
  const bool alike = random.chance(2);
  const int common = random.whole(-1070, 1020);
  for (Triangle* t : {&pair.a, &pair.b}) {
    for (Vec3& p : *t) {
      for (double& x : p) {
        const int exponent = alike ? common : random.whole(-1074, 1023);
        x = random.chance(6) ? (random.chance(2) ? 0.0 : -0.0)
                             : std::ldexp(random.between(-1, 1), exponent);
      }
    }
  }
  return pair;
}

/// Each triangle of a size of its own.
DrawnPair of_two_sizes(RandomDraws& random) {
  DrawnPair pair = random.chance(2) ? on_a_grid(random) : apart(random);
  for (Triangle* t : {&pair.a, &pair.b}) {
    const double size = std::ldexp(1, random.whole(-1000, 900));
    for (Vec3& p : *t) p *= size;
  }
  return pair;
}

std::vector<std::pair<std::string, hard_pairs::Make>> generators() {
  auto out = hard_pairs::generators();
  out.emplace_back("grid", on_a_grid);
  out.emplace_back("smaller grid", on_a_grid);
  out.emplace_back("parallel planes", in_parallel_planes);
  out.emplace_back("apart", apart);
  out.emplace_back("near contact", near_contact);
  out.emplace_back("all sizes", of_all_sizes);
  out.emplace_back("two sizes", of_two_sizes);
  out.emplace_back("shared", [](RandomDraws& random) {
    DrawnPair pair = random.chance(2) ? on_a_grid(random) : apart(random);
    hard_pairs::share(random.chance(2) ? hard_pairs::Sharing::vertex : hard_pairs::Sharing::edge,
                      pair.a, pair.b);
    return pair;
  });
  return out;
}

Rational rational(const SquaredDistance& d) { return Rational(d.text()); }

void expect_as_reference(const Triangle& a, const Triangle& b) {
  const Closest got = closest_points(a, b);
  const auto want = closest_reference::closest_points(a, b);
  EXPECT_EQ(rational(got.squared), want.squared);
  EXPECT_TRUE(is_rounded_root(got.distance, want.squared)) << got.distance;
  EXPECT_EQ(got.features, want.features);
  for (int side = 0; side < 2; ++side)
    for (int k = 0; k < 3; ++k) EXPECT_TRUE(is_rounded(got.points[side][k], want.points[side][k]));
}

/// Points p and q are closest iff no corner is beyond the planes through them (verify/closest.h).
bool optimal(const Triangle& a, const Triangle& b, const RationalPoint& p, const RationalPoint& q) {
  const auto exact = [](double x) { return Rational(x); };
  const auto s = reference::converted(a, exact), t = reference::converted(b, exact);
  const RationalPoint w = reference::minus(q, p);
  bool held = reference::lies_in(p, s) && reference::lies_in(q, t);
  for (int i = 0; i < 3; ++i) {
    held = held && reference::dot(w, reference::minus(s[i], p)) <= 0;
    held = held && reference::dot(w, reference::minus(t[i], q)) >= 0;
  }
  return held;
}

void expect_sound(const Triangle& a, const Triangle& b) {
  const Closest got = closest_points(a, b);
  const auto want = closest_reference::closest_points(a, b);
  EXPECT_TRUE(optimal(a, b, want.points[0], want.points[1]));
  EXPECT_EQ(got.squared.is_zero(), reference::intersects(a, b));
  EXPECT_EQ(got.squared, squared_distance(a, b));
  EXPECT_EQ(got.squared, squared_distance(b, a));
  EXPECT_EQ(got.squared.is_zero(), got.squared == SquaredDistance());
  if (got.squared.is_zero()) {
    EXPECT_EQ(got.points[0], got.points[1]);
    EXPECT_EQ(got.distance, 0);
  }
}

TEST(ClosestPoints, AsTheReferenceOnPairsOfEveryKind) {
  const auto all = generators();
  RandomDraws random(test_seed(19));
  int touching = 0;
  for (std::size_t n = 0; more_cases(n, trials(100000, 2000), touching > 100); ++n) {
    if (HasFailure()) return;
    const auto& [name, make] = all[n % all.size()];
    const DrawnPair pair = make(random);
    SCOPED_TRACE(name + " " + std::to_string(n));
    if (!hard_pairs::finite(pair)) continue;
    expect_as_reference(pair.a, pair.b);
    if (n % 8 == 0) expect_sound(pair.a, pair.b);
    touching += squared_distance(pair.a, pair.b).is_zero();
  }
}

// The twin: a reference that leaves out edges against edges differs.
TEST(ClosestPointsTwin, WithoutEdgesAgainstEdgesItIsNoticed) {
  RandomDraws random(20);
  int noticed = 0;
  for (int n = 0; more_cases(n, 0, noticed > 3, 4000); ++n) {
    const DrawnPair pair = apart(random);
    noticed += closest_reference::closest_points(pair.a, pair.b, false).squared !=
               rational(squared_distance(pair.a, pair.b));
  }
}

// The twin: a root that is cut off instead of rounded.
TEST(ClosestPointsTwin, ARootCutOffIsNoticed) {
  RandomDraws random(21);
  int noticed = 0;
  for (int n = 0; more_cases(n, 0, noticed > 10 && noticed < n, 4000); ++n) {
    const DrawnPair pair = apart(random);
    const Rational square = rational(squared_distance(pair.a, pair.b));
    mpf_class root(0, 400);
    mpf_sqrt(root.get_mpf_t(), mpf_class(square, 400).get_mpf_t());
    noticed += !is_rounded_root(root.get_d(), square);  // get_d() cuts off
  }
}

TEST(ClosestPoints, ZerosHaveNoSign) {
  const Triangle a = {Vec3(-0.0, -0.0, -0.0), Vec3(1, -0.0, 0), Vec3(0, 1, -0.0)};
  const Closest c = closest_points(a, {Vec3(-0.0, 0, 2), Vec3(1, 0, 2), Vec3(0, 1, 2)});
  for (const Vec3& p : c.points)
    for (const double x : p) EXPECT_FALSE(std::signbit(x));
}

TEST(ClosestPoints, TheEndsOfTheDoubles) {
  const double most = std::numeric_limits<double>::max();
  const double least = std::numeric_limits<double>::denorm_min();
  const auto at = [](double x) { return Triangle{Vec3(x, 0, 0), Vec3(x, 0, 0), Vec3(x, 0, 0)}; };
  EXPECT_EQ(closest_points(at(0), at(most)).distance, most);
  EXPECT_EQ(closest_points(at(-most), at(most)).distance, HUGE_VAL);
  EXPECT_EQ(closest_points(at(0), at(least)).distance, least);
  EXPECT_EQ(closest_points(at(-least), at(most)).distance, most);
  EXPECT_LT(closest_points(at(0), at(most)).squared, closest_points(at(-least), at(most)).squared);
  // Half of the least double is as near to 0, and 0 is even.
  EXPECT_EQ(closest_points({Vec3(0, 0, 0), Vec3(least, least, 0), Vec3(0, 0, 0)},
                           {Vec3(0, least, 0), Vec3(0, least, 0), Vec3(0, least, 0)})
                .points[0],
            Vec3(0, 0, 0));
}

TEST(SquaredDistance, RoundsOnceToTheNearestToEven) {
  const mpz_class one = 1;
  const auto bits = [](int n) { return mpz_class(mpz_class(1) << n); };
  EXPECT_EQ(rounded(bits(53) + 1, 0), 0x1p53);
  EXPECT_EQ(rounded(bits(53) + 3, 0), 0x1p53 + 4);
  EXPECT_EQ(rounded(-bits(53) - 3, 0), -0x1p53 - 4);
  EXPECT_EQ(rounded(bits(200) + bits(147), -200), 1);
  EXPECT_EQ(rounded(bits(200) + bits(147) + 1, -200), 1 + 0x1p-52);
  EXPECT_EQ(rounded(bits(54) - 1, 970), HUGE_VAL);  // the middle beyond the largest double
  EXPECT_EQ(rounded(bits(56) - 5, 968), std::numeric_limits<double>::max());
  EXPECT_EQ(rounded(1, -1075), 0);
  EXPECT_EQ(rounded(3, -1075), 0x1p-1073);
  EXPECT_EQ(rounded(1, 100000), HUGE_VAL);
  EXPECT_EQ(rounded(-1, -100000), 0);
  EXPECT_FALSE(std::signbit(rounded(-1, -1075)));
  EXPECT_EQ(rounded_quotient(bits(53) + 1, bits(53), 0), 1);
  EXPECT_EQ(rounded_quotient(3 * bits(53) + 4, 3 * bits(53), 0), 1 + 0x1p-52);
  EXPECT_EQ(rounded_root(bits(106) + bits(54) + 1, one, 0), 0x1p53);  // of 2^53 + 1
  EXPECT_EQ(rounded_root(bits(106) + bits(54) + 2, one, 0), 0x1p53 + 2);
  EXPECT_EQ(rounded_root(one, one, -2150), 0);  // half of the least double
  EXPECT_EQ(rounded_root(bits(200) + 1, bits(200), -2150), 0x1p-1074);
}

TEST(SquaredDistance, ComparesAndPrintsFractions) {
  const Triangle a = {Vec3(0, 0, 0), Vec3(3, 0, 0), Vec3(0, 3, 0)};
  const auto point = [](double x, double y) {
    const Vec3 p(x, y, 0);
    return Triangle{p, p, p};
  };
  EXPECT_EQ(squared_distance(a, point(2, 2)).text(), "1/2");
  EXPECT_EQ(squared_distance(a, point(-0.25, 1)).text(), "1/16");
  EXPECT_EQ(SquaredDistance().text(), "0/1");
  EXPECT_GT(squared_distance(a, point(2, 2)), squared_distance(a, point(-0.25, 1)));
  EXPECT_EQ(squared_distance(a, point(2, 2)), squared_distance(point(2, 2), a));
  EXPECT_LT(squared_distance(a, point(2, 2)), squared_distance(a, point(-0x1.7p-1, 1)));
}

// ---- contacts (verify/near_contact.h)

Rational absolute(const Rational& x) { return x < 0 ? Rational(-x) : x; }

/// The largest difference of two coordinates on one axis.
double extent(const Triangle& a, const Triangle& b) {
  Box box = Box::empty();
  for (const Triangle* t : {&a, &b})
    for (const Vec3& p : *t) box.add(p);
  return (box.hi - box.lo).maxCoeff();
}

/// The point of the weights: the first corner, and the others relative to it.
RationalPoint mean(const Triangle& t, const Vec3& weights) {
  RationalPoint out;
  for (int k = 0; k < 3; ++k) {
    out[k] = t[0][k];
    for (int i = 1; i < 3; ++i)
      out[k] += Rational(weights[i]) * (Rational(t[i][k]) - Rational(t[0][k]));
  }
  return out;
}

/// Counts what verify/near_contact.h promises of contact_within() and does not hold.
int broken_promises(const Triangle& a, const Triangle& b, const NearContact& got,
                    const Closest& exact) {
  constexpr double kU = 0x1p-53;
  const Rational reach = Rational(0x1p-45) * Rational(extent(a, b));
  const bool meet = exact.squared.is_zero();
  int broken = (got.distance == 0) != (exact.distance == 0);
  const Rational squared = rational(exact.squared), d = got.distance;
  const Rational off = d * Rational(0x1p-32) + Rational(kTiny) / 2;
  broken += (d > off && (d - off) * (d - off) > squared) || (d + off) * (d + off) < squared;
  for (int side = 0; side < 2; ++side) {
    const Vec3& weights = got.weights[side];
    const RationalPoint at = mean(side == 0 ? a : b, weights);
    Rational apart = 0;
    for (int k = 0; k < 3; ++k) {
      const Rational x = got.points[side][k];
      const Rational beyond = absolute(x - at[k]) - absolute(x) * Rational(kU) - kTiny;
      if (beyond > 0) apart += beyond * beyond;
    }
    broken += apart > reach * reach;
    broken += !(weights.minCoeff() >= 0) || std::abs(weights.sum() - 1) > 6 * kU;
    unsigned corners = 0;
    for (int i = 0; i < 3; ++i) corners |= (weights[i] != 0 ? 1u : 0u) << i;
    const Feature& f = got.features[side];
    const unsigned named = f.kind == FeatureKind::vertex ? 1u << f.index
                           : f.kind == FeatureKind::edge ? 1u << f.index | 1u << (f.index + 1) % 3
                                                         : 7u;
    broken += (corners & ~named) != 0;
  }
  if (meet) return broken + (got.points[0] != got.points[1] || !got.normal.isZero(0));
  Rational between = 0, rounding = 2 * reach + off;
  for (int k = 0; k < 3; ++k) {
    const Rational x = Rational(got.points[1][k]) - Rational(got.points[0][k]);
    between += x * x;
    rounding += Rational(kU) * (absolute(got.points[0][k]) + absolute(got.points[1][k])) + kTiny;
  }
  broken += between > (d + rounding) * (d + rounding);
  broken += d > rounding && between < (d - rounding) * (d - rounding);
  return broken + ((got.normal - exact_contact(a, b, exact).normal).norm() > 0x1p-15);
}

TEST(NearContact, KeepsItsPromisesOnPairsOfEveryKind) {
  const auto all = generators();
  RandomDraws random(test_seed(31));
  int in_doubles = 0, crossing = 0, exactly = 0;
  for (std::size_t n = 0; more_cases(n, trials(20000, 2000), in_doubles > 100); ++n) {
    if (HasFailure()) return;
    const auto& [name, make] = all[n % all.size()];
    const auto [a, b] = make(random);
    SCOPED_TRACE(name + " " + std::to_string(n) + " " + reference::text(a, b));
    if (!hard_pairs::finite({a, b})) continue;
    const Closest exact = closest_points(a, b);
    const double d = exact.distance, most = std::numeric_limits<double>::max();
    for (const double within :
         {d, std::nextafter(d, 0.0), std::nextafter(d, most), 2 * d + 1, 0.0}) {
      if (!std::isfinite(within)) continue;
      const auto got = contact_within(a, b, within, filter_planes(a, b, within));
      ASSERT_EQ(got.has_value(), exact.squared <= SquaredDistance::of(within));
      if (!got) continue;
      EXPECT_EQ(broken_promises(a, b, *got, exact), 0);
      in_doubles += got->distance != d;
      crossing += d == 0 && got->points != exact.points;
      exactly += got->points == exact.points;
    }
  }
  EXPECT_GT(std::min({in_doubles, crossing, exactly}), 100);
}

// The twin: doubles are believed however far apart their bounds are.
TEST(NearContactTwin, WithoutATolerancePromisesAreBroken) {
  const auto all = generators();
  RandomDraws random(test_seed(32));
  int broken = 0;
  for (std::size_t n = 0; more_cases(n, 0, broken > 3, 20000); ++n) {
    const auto [a, b] = all[n % all.size()].second(random);
    if (!hard_pairs::finite({a, b})) continue;
    const Closest exact = closest_points(a, b);
    const double within = 2 * exact.distance + 1;
    if (!std::isfinite(within)) continue;
    const auto got = contact_within(a, b, within, filter_planes(a, b, within), HUGE_VAL);
    broken += got && broken_promises(a, b, *got, exact) > 0;
  }
}

TEST(NearContact, ExactOnesAreRoundedOnce) {
  const auto all = generators();
  RandomDraws random(test_seed(33));
  int faces = 0;
  for (std::size_t n = 0; more_cases(n, trials(8000, 500), faces > 20); ++n) {
    if (HasFailure()) return;
    const auto& [name, make] = all[n % all.size()];
    const auto [a, b] = make(random);
    SCOPED_TRACE(name + " " + std::to_string(n) + " " + reference::text(a, b));
    if (!hard_pairs::finite({a, b})) continue;
    const NearContact got = exact_contact(a, b, closest_points(a, b));
    const auto want = closest_reference::closest_points(a, b);
    for (int side = 0; side < 2; ++side) {
      const Triangle& t = side == 0 ? a : b;
      const RationalPoint at = mean(t, got.weights[side]);
      for (int k = 0; k < 3; ++k)
        EXPECT_LE(absolute(at[k] - want.points[side][k]),
                  Rational(0x1p-51) * Rational(extent(t, t)) + 3 * Rational(kTiny));
      faces += got.features[side].kind == FeatureKind::face;
    }
    const RationalPoint w = reference::minus(want.points[1], want.points[0]);
    for (int k = 0; k < 3; ++k) {
      if (want.squared == 0) {
        EXPECT_EQ(got.normal[k], 0);
        continue;
      }
      const Rational square = w[k] * w[k] / want.squared,
                     n2 = Rational(got.normal[k]) * got.normal[k];
      EXPECT_LE(absolute(n2 - square), square * Rational(0x1p-48) + Rational(0x1p-1000));
      EXPECT_GE(w[k] * Rational(got.normal[k]), 0);
    }
  }
}

}  // namespace
}  // namespace farcull
