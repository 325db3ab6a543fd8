// The exact offset against rationals: minkowski_solid() holds hull and ball, and the kernel's
// interval holds the exact one of the solid that the floats say, on this machine's floats and on
// the worst ones.
#include "offsets/offsets.h"

#include "embedded/minkowski_glsl.h"
#include "offsets/kernel.h"
#include "offsets/rounding.h"
#include "tests/lab/rational.h"
#include "tests/lab/solids.h"
#include "tests/lab/test.h"

namespace farcull {
namespace glsl::exact_without_widening {
#define FAR_WIDEN 0.0f
// clang-format off
#include "offsets/slab.glsl"  // the next one needs it
#include "offsets/minkowski.glsl"
// clang-format on
#undef FAR_WIDEN
}  // namespace glsl::exact_without_widening

namespace {

using minkowski_line::Answer, minkowski_line::answer, minkowski_line::Kernel, minkowski_line::Line,
    minkowski_line::Real, minkowski_line::Tally, minkowski_line::Weights, rational::Q,
    rational::Random;
using namespace minkowski_cases;

const Kernel kFloat = minkowski_fattener().solid.interval;
const Kernel kWorst = minkowski_fattener().solid.interval_worst;
constexpr Kernel kWithoutWidening = kernel_interval<glsl::exact_without_widening::solid_interval>;

Solid solid_of(const Triangle& t, double radius) {
  return minkowski_solid(t[0], t[1], t[2], radius);
}

void print(const Solid& solid) {
  for (const auto& row : solid) std::printf("%a %a %a %a\n", row[0], row[1], row[2], row[3]);
}

// ---- minkowski_solid ----

/// Each corner with its ball is in the ball of a corner of the solid, so the hulls are; and inside
/// the z range.
bool holds_balls(const Solid& solid, const Triangle& triangle, double radius) {
  const Q r(radius), room = Q(solid[1][3]) - r;
  bool held = room >= 0;
  for (int i = 0; i < 3; ++i) {
    Q square = 0;
    for (int k = 0; k < 3; ++k) {
      const Q d = Q(triangle[i][k]) - Q(solid[0][k]) - Q(solid[1 + i][k]);
      square += d * d;
    }
    held = held && square <= room * room && Q(solid[0][3]) <= Q(triangle[i][2]) - r &&
           Q(solid[2][3]) >= Q(triangle[i][2]) + r;
  }
  return held;
}

TEST(ExactOf, HoldsHullAndBallOfEveryTriangle) {
  Random random(test_seed(601));
  for (int n = 0; n < trials(60'000); ++n) {
    const Case c = random_case(random, n % kKindCount);
    const Solid solid = solid_of(c.triangle, c.radius);
    for (const auto& row : solid)
      for (const float x : row) ASSERT_TRUE(std::isfinite(x));
    for (int k = 1; k < 4; ++k) ASSERT_EQ(solid[4][k], 0);  // the canvas's own numbers
    ASSERT_TRUE(holds_balls(solid, c.triangle, c.radius)) << kKinds[c.kind] << ", case " << n;
  }
}

// Corners whose rounding errors square to nothing in double, with no radius to hide them.
TEST(ExactOf, HoldsTrianglesBelowTheRangeOfFloats) {
  Random random(test_seed(602));
  for (int n = 0; n < trials(20'000); ++n) {
    const double lo = -random.uniform(20, 1020);
    const Triangle t{random.scaled3(lo, lo + 50), random.scaled3(lo, lo + 50),
                     random.coin() ? Vec3(Vec3::Zero()) : random.scaled3(lo, -20)};
    for (const double radius : {0.0, 1e-200, 0.7})
      ASSERT_TRUE(holds_balls(solid_of(t, radius), t, radius)) << "case " << n << ", r " << radius;
  }
}

TEST(ExactOf, WithoutTheRoundingOfItsCornersSomeAreNotHeld) {
  Random random(601);
  int lost = 0;
  for (int n = 0; more_cases(n, 0, lost > 100, 2'000); ++n) {
    const Case c = random_case(random, n % kKindCount);
    Solid solid = solid_of(c.triangle, c.radius);
    solid[1][3] = nearest(c.radius);
    if (solid[1][3] < c.radius) solid[1][3] = std::nextafter(solid[1][3], HUGE_VALF);
    lost += !holds_balls(solid, c.triangle, c.radius);
  }
}

// Any solid that is large enough would pass above.
TEST(ExactOf, IsTightAroundTriangles) {
  Random random(603);
  for (int n = 0; n < trials(20'000); ++n) {
    const Triangle t = random_triangle(random, 0);
    const Solid solid = solid_of(t, 0.75);
    // Half the extent is at most 20 px, so a corner is rounded by 2^-20 per axis.
    ASSERT_LE(solid[1][3], 0.75f + 0x1p-19f);
    const auto [lo, hi] = std::minmax({t[0][2], t[1][2], t[2][2]});
    ASSERT_NEAR(solid[0][3], lo - 0.75, 1e-4);
    ASSERT_NEAR(solid[2][3], hi + 0.75, 1e-4);
  }
}

// ---- the kernel holds the exact interval ----

TEST(ExactKernel, TheFilterInLongDoubleDoubtsEveryViolation) {
  Random random(604);
  long violations = 0;
  for (int n = 0; more_cases(n, trials(60'000), violations > 300); ++n) {
    const Case c = random_case(random, n % kKindCount);
    const Solid solid = solid_of(c.triangle, c.radius);
    const Line line(solid, c.cx, c.cy);
    const Answer a = answer(kWithoutWidening, c.cx, c.cy, solid);
    for (const int sign : {-1, 1}) {
      Weights w = random_weights(random);
      Real depth;
      if (random.coin()) line.contact(sign, w, depth);
      if (!violates(solid, c.cx, c.cy, w, a)) continue;
      ++violations;
      ASSERT_TRUE(doubtful(solid, line.chord(w), a)) << kKinds[c.kind] << ", case " << n;
    }
  }
}

/// Per kind of triangle, `cases` lines, each checked at the contacts and at random points.
void expect_holds(Kernel kernel, int cases, std::uint64_t seed) {
  Random random(test_seed(seed));
  Tally all;
  for (int kind = 0; kind < kKindCount; ++kind) {
    SCOPED_TRACE(kKinds[kind]);
    Tally tally;
    int hits = 0;
    for (int n = 0; more_cases(n, cases, hits > 10 && n - hits > 10); ++n) {
      const Case c = random_case(random, kind);
      const Solid solid = solid_of(c.triangle, c.radius);
      const Line line(solid, c.cx, c.cy);
      const Answer a = answer(kernel, c.cx, c.cy, solid);
      hits += a.hit;
      check_contacts(line, solid, c.cx, c.cy, a, tally);
      for (int k = 0; k < 2; ++k) check(line, solid, c.cx, c.cy, random_weights(random), a, tally);
      if (tally.violations != 0) {
        print(solid);
        FAIL() << "case " << n << " at " << c.cx << ", " << c.cy;
      }
    }
    all.checks += tally.checks;
    all.rationals += tally.rationals;
  }
  std::cout << all.checks << " points, " << all.rationals << " decided with rationals\n";
}

TEST(ExactKernel, HoldsTheExactIntervalOfRealTriangles) {
  expect_holds(kFloat, trials(150'000), 605);
}

// The latest entry and the earliest exit of all roundings that GLSL allows.
TEST(ExactKernel, HoldsTheExactIntervalOnTheWorstDevice) {
  expect_holds(kWorst, trials(25'000), 606);
}

TEST(ExactKernel, WithoutWideningEveryKindIsViolated) {
  Random random(605);
  for (int kind = 0; kind < kKindCount; ++kind) {
    SCOPED_TRACE(kKinds[kind]);
    Tally tally;
    for (int n = 0; more_cases(n, 0, tally.violations > 0, 100'000); ++n) {
      const Case c = random_case(random, kind);
      const Solid solid = solid_of(c.triangle, c.radius);
      const Answer a = answer(kWithoutWidening, c.cx, c.cy, solid);
      check_contacts(Line(solid, c.cx, c.cy), solid, c.cx, c.cy, a, tally);
    }
  }
}

void expect_holds_adversarial(Kernel kernel, int cases) {
  Random random(test_seed(607));
  Tally tally;
  int hits = 0;
  for (int n = 0; more_cases(n, cases, hits > 1000 && n - hits > 1000); ++n) {
    const auto [cx, cy, solid] = adversarial(random);
    const Line line(solid, cx, cy);
    const Answer a = answer(kernel, cx, cy, solid);
    hits += a.hit;
    check_contacts(line, solid, cx, cy, a, tally);
    check(line, solid, cx, cy, random_weights(random), a, tally);
    if (tally.violations != 0) {
      print(solid);
      FAIL() << "case " << n << " at " << cx << ", " << cy;
    }
  }
  std::cout << tally.checks << " points, " << tally.rationals << " decided with rationals\n";
}

TEST(ExactKernel, HoldsTheExactIntervalOfAdversarialFloats) {
  expect_holds_adversarial(kFloat, trials(1'500'000));
}

TEST(ExactKernel, HoldsTheExactIntervalOfAdversarialFloatsOnTheWorstDevice) {
  expect_holds_adversarial(kWorst, trials(200'000));
}

TEST(ExactKernel, WithoutWideningAdversarialFloatsAreMissed) {
  Random random(test_seed(607));
  Tally tally;
  for (int n = 0; more_cases(n, 0, tally.violations > 100, 50'000); ++n) {
    const auto [cx, cy, solid] = adversarial(random);
    check_contacts(Line(solid, cx, cy), solid, cx, cy, answer(kWithoutWidening, cx, cy, solid),
                   tally);
  }
  std::cout << tally.violations << " of " << tally.checks << " points lost\n";
}

// ---- tightness: a kernel that always answers [zlo, zhi] passes all of the above ----

struct Tightness {
  std::vector<double> excess;  // px, entry and exit
  std::vector<double> ratio;   // to the box's interval
  long clear_misses = 0, false_hits = 0, hits = 0;

  double rank(double part) {
    const auto at = excess.begin() + static_cast<long>(part * double(excess.size() - 1));
    std::nth_element(excess.begin(), at, excess.end());
    return *at;
  }
};

Tightness measure(Kernel kernel, int kind, double radius, int cases) {
  Random random(610);
  Tightness out;
  const Kernel box_kernel = obb_fattener().solid.interval;
  for (int n = 0; n < cases; ++n) {
    const Triangle t = random_triangle(random, kind);
    const Solid solid = solid_of(t, radius), box = obb_of(t, radius);
    Vec3 lo = t[0].cwiseMin(t[1]).cwiseMin(t[2]), hi = t[0].cwiseMax(t[1]).cwiseMax(t[2]);
    for (int k = 0; k < 20; ++k) {
      const auto near = [&](int axis) {
        return number(std::floor(random.uniform(lo[axis] - radius - 2, hi[axis] + radius + 2)) +
                      0.5);
      };
      const float cx = near(0), cy = near(1);
      const Line line(solid, cx, cy);
      const Answer a = answer(kernel, cx, cy, solid);
      if (line.distance() > line.radius() + 1e-3L) {
        ++out.clear_misses;
        out.false_hits += a.hit;
        continue;
      }
      Weights w;
      Real first, last;
      if (!a.hit || !line.contact(-1, w, first) || !line.contact(1, w, last)) continue;
      first = std::max<Real>(first, solid[0][3]);
      last = std::min<Real>(last, solid[2][3]);
      ++out.hits;
      out.excess.push_back(static_cast<double>(first - a.entry));
      out.excess.push_back(static_cast<double>(a.exit - last));
      const Answer b = answer(box_kernel, cx, cy, box);
      if (b.hit && b.exit > b.entry)
        out.ratio.push_back((double(a.exit) - a.entry) / (double(b.exit) - b.entry));
    }
  }
  return out;
}

TEST(ExactKernel, IsNotAbsurdlyLooseOnOrdinaryTriangles) {
  for (const Kernel kernel : {kFloat, kWorst}) {
    for (const double radius : {0.7, 5.0}) {
      Tightness found = measure(kernel, 0, radius, kernel == kFloat ? 20'000 : 4'000);
      std::printf(
          "%s, radius %g: excess over the exact interval (px) median %.3g, 99.9%% %.3g, most "
          "%.3g, least %.3g; %ld lines hit; %ld clearly miss, %ld of them reported as hits\n",
          kernel == kFloat ? "floats" : "worst", radius, found.rank(0.5), found.rank(0.999),
          found.rank(1), found.rank(0), found.hits, found.clear_misses, found.false_hits);
      EXPECT_TRUE(found.rank(0.5) < 1e-3 && found.rank(0.999) < 0.1);
      EXPECT_TRUE(found.clear_misses > 10'000 && found.false_hits * 1000 < found.clear_misses);
    }
  }
}

// Degenerate, thin and far triangles are reported; only the solid's own rounding may loosen them.
TEST(ExactKernel, DiscardsLinesThatClearlyMissAnyKindOfTriangle) {
  for (int kind = 0; kind < kKindCount; ++kind) {
    Tightness found = measure(kFloat, kind, 0.7, 3'000);
    std::printf(
        "%-16s excess (px) median %.3g, 99.9%% %.3g, most %.3g; %ld of %ld clear misses "
        "reported as hits\n",
        kKinds[kind], found.rank(0.5), found.rank(0.999), found.rank(1), found.false_hits,
        found.clear_misses);
    EXPECT_LE(found.false_hits * 1000, found.clear_misses) << kKinds[kind];
  }
}

TEST(ExactKernel, IsSeldomWiderThanTheBox) {
  Tightness found = measure(kFloat, 0, 0.7, 20'000);
  double sum = 0, most = 0;
  long wider = 0;
  for (const double ratio : found.ratio) {
    sum += ratio;
    most = std::max(most, ratio);
    wider += ratio > 1.001;
  }
  const double mean = sum / double(found.ratio.size());
  std::printf(
      "length of the interval relative to the box's: mean %.3f, most %.3f; %ld of %zu "
      "lines more than 0.1%% longer\n",
      mean, most, wider, found.ratio.size());
  EXPECT_LT(mean, 1);
  EXPECT_LT(wider * 1000, static_cast<long>(found.ratio.size()));
}

// ---- one normal ----

/// The declarations of the kernel's GLSL text that hold a normal and are not precise: variables
/// that far_touch takes, parameters that give one back, and the extent, whose bits count too.
std::vector<std::string> not_precise(const std::string& glsl) {
  std::vector<std::string> wanted = {"FAR_PRECISE float extent = "};
  for (const std::string call : {"far_touch(d, mz, "}) {
    for (std::size_t at = glsl.find(call); at != std::string::npos; at = glsl.find(call, at + 1)) {
      const std::size_t from = at + call.size();
      wanted.push_back("FAR_PRECISE vec4 " + glsl.substr(from, glsl.find(',', from) - from) +
                       " = ");
    }
  }
  for (const std::string name : {"void far_edge(", "void far_outward("}) {
    const std::size_t at = glsl.find(name),
                      to = glsl.find(')', glsl.find("FAR_INOUT(vec4)", at) + 15);
    const std::string head = glsl.substr(at, to - at);
    if (head.find(", FAR_PRECISE FAR_INOUT(vec4) n") == std::string::npos) wanted.push_back(head);
  }
  std::erase_if(wanted, [&](const std::string& text) {
    return text.starts_with("FAR_PRECISE") && glsl.find(text) != std::string::npos;
  });
  return wanted;
}

// docs/budget.md, "One normal": GLSL promises that every use of n has the same bits only where the
// variable is precise in the function that computes it. (The other parameters are values.)
TEST(ExactKernel, EveryVariableThatHoldsANormalIsPrecise) {
  const std::string glsl(embedded::minkowski_glsl);
  EXPECT_EQ(not_precise(glsl), std::vector<std::string>{});
  for (const std::string name : {"vec4 plane", "vec4 aside", "vec4 first", "vec4 last",
                                 "FAR_INOUT(vec4) n", "float extent"}) {
    const std::string qualified = "FAR_PRECISE " + name;
    std::string without = glsl;
    const std::size_t at = without.find(qualified);
    ASSERT_NE(at, std::string::npos) << name;
    without.replace(at, qualified.size(), name);
    EXPECT_FALSE(not_precise(without).empty()) << name;
  }
}

}  // namespace
}  // namespace farcull
