#include "core/view/view.h"

#include <rapidcheck/gtest.h>

#include "core/view/budget.h"
#include "core/view/regions.h"
#include "tests/lab/boxes.h"
#include "tests/lab/reference.h"
#include "tests/lab/test.h"

namespace farcull {
namespace {

using rational::Q, rational::Q3, rational::Random;

TEST(View, RefusesWhatIsNoDirection) {
  for (const char* text :
       {"",        "-",         "--x",    "w",        "X",      "xy",      "x ",
        " x",      "1",         "1:2",    "1:2:3:4",  "1:2:",   ":1:2",    "1::2",
        "::",      "1:2:z",     "+1:0:0", "1 :0:0",   "1:0:0 ", "0x1:0:0", "inf:0:0",
        "1:nan:0", "1e400:0:0", "0:0:0",  "-0:0:0.0", "1:2:3x"})
    EXPECT_THROW(parse_view(text), Error) << "'" << text << "'";
  for (const char* text : {"", ",", "x,", ",x", "x,,y", "x,x", "1:1:1,z,1:1:1", "x;y"})
    EXPECT_THROW(parse_views(text), Error) << "'" << text << "'";
}

// One entry of +-1 per row and column, so that the map rounds nothing but the scaling.
TEST(View, AxesAreExactPermutations) {
  for (const char* text : {"x", "-x", "y", "-y", "z", "-z", "7:0:0", "0:-1e300:0", "0:0:5e-324"}) {
    const Eigen::Matrix3d rows = parse_view(text).rows;
    EXPECT_EQ((rows.array() == 0).count(), 6) << text;
    EXPECT_EQ((rows.array().abs() == 1).count(), 3) << text;
    EXPECT_EQ((rows * rows.transpose()), Eigen::Matrix3d::Identity()) << text;
  }
  EXPECT_EQ(parse_view("-y").rows.row(2), Eigen::RowVector3d(0, -1, 0));
}

TEST(View, ObliqueRowsAreUnitAndOrthogonalWhateverTheScale) {
  Random random(101);
  for (int n = 0; n < 2000; ++n) {
    const View view = n == 0   ? parse_view("1e308:1e308:1e308")
                      : n == 1 ? parse_view("5e-324:5e-324:1e-323")
                      : n == 2 ? parse_view("1:1e-200:0")
                               : rational::random_view(random);
    const Eigen::Matrix3d gram = view.rows * view.rows.transpose();
    ASSERT_LT((gram - Eigen::Matrix3d::Identity()).cwiseAbs().maxCoeff(), 0x1p-50) << view.name;
  }
}

/// Coordinates that cancel, mix scales, underflow, or lie far from the world's origin.
double nasty(Random& random) {
  const int kind = random.below(8);
  if (kind == 0) return 0;
  if (kind == 1) return random.scaled(-1074, -1000);
  if (kind == 2) return random.scaled(-60, 60);
  if (kind == 3) return random.scaled(200, 330);
  if (kind == 4) return 1e9 + random.below(3);
  if (kind == 5) return random.sign() * random.below(5);
  return random.uniform(-10, 10);
}

Window nasty_window(Random& random) {
  Window window{};
  window.view = rational::random_view(random);
  for (int i = 0; i < 3; ++i) window.origin[i] = nasty(random);
  window.map = window.view.rows / std::abs(random.scaled(-300, 300));
  if (random.coin()) window.map = window.view.rows / std::abs(random.scaled(-10, 10));
  return window;
}

/// 0 where the bound holds, else by how much it is exceeded.
Q excess(const Window& window, const Vec3& x, const PixelPoint& q) {
  const Q3 truth = rational::image(window, x);
  Q worst = 0;
  for (int i = 0; i < 3; ++i) {
    const Q off = abs(Q(q.p[i]) - truth[i]) - Q(q.error);
    if (off > worst) worst = off;
  }
  return worst;
}

TEST(ToPixel, IsWithinItsOwnErrorOfTheExactImage) {
  Random random(102);
  int finite = 0;
  for (int n = 0; n < 100'000; ++n) {
    const Window window = nasty_window(random);
    Vec3 x(nasty(random), nasty(random), nasty(random));
    if (random.below(4) == 0) x = window.origin + random.scaled3(-60, 0);
    const PixelPoint q = to_pixel(window, x);
    if (!std::isfinite(q.error)) {
      ASSERT_EQ(q.error, HUGE_VAL);
      continue;
    }
    ++finite;
    ASSERT_TRUE(q.p.allFinite());
    ASSERT_EQ(excess(window, x, q), 0) << window.view.name << " of " << x.transpose();
  }
  EXPECT_GT(finite, 50'000);
}

// In an oblique view the sum of large products cancels: a bound relative to the result would be
// wrong by any factor. Here the point is moved inside the depth direction by 2^k pixels.
TEST(ToPixel, BoundCountsWhatCancelled) {
  Random random(103);
  bool beyond_the_result = false;
  for (int n = 0; n < 20'000; ++n) {
    Window window{};
    window.view = rational::random_view(random);
    window.origin = random.cube(1);
    window.map = window.view.rows * 100;
    const Vec3 depth = window.view.rows.row(2).transpose();
    const Vec3 x = window.origin + depth * random.scaled(0, 45) + random.cube(0.01);
    const PixelPoint q = to_pixel(window, x);
    ASSERT_EQ(excess(window, x, q), 0) << window.view.name;
    const Q3 truth = rational::image(window, x);
    for (int i = 0; i < 2; ++i)
      beyond_the_result |= abs(Q(q.p[i]) - truth[i]) > Q(0x1p-48) * abs(truth[i]);
  }
  EXPECT_TRUE(beyond_the_result);  // else the generator does not see what the bound is for
}

TEST(ToPixel, OverflowIsAnInfiniteErrorAndNeverANumber) {
  const std::vector<Box> region{{Vec3(-1, -1, -1), Vec3(1, 1, 1)}};
  for (const char* name : {"z", "1:1:1"}) {
    const Window window = *fit_window(parse_view(name), region, 5000);
    for (const Vec3& x : {Vec3(DBL_MAX, 0, 0), Vec3(DBL_MAX, -DBL_MAX, DBL_MAX),
                          Vec3(-DBL_MAX, DBL_MAX, 1), Vec3(1e306, 1e306, -1e306)})
      EXPECT_EQ(to_pixel(window, x).error, HUGE_VAL) << name << ": " << x.transpose();
  }
}

void expect_fits(const Window& w, std::span<const Box> regions, int resolution) {
  ASSERT_GT(w.pixel_size, 0);
  ASSERT_TRUE(std::isfinite(w.pixel_size));
  ASSERT_EQ(w.width % 2, 0);
  ASSERT_EQ(w.height % 2, 0);
  ASSERT_GE(w.width, 2);
  ASSERT_GE(w.height, 2);
  ASSERT_LE(std::max(w.width, w.height), resolution + 5);
  for (int row = 0; row < 3; ++row)
    for (int i = 0; i < 3; ++i) ASSERT_EQ(w.map(row, i), w.view.rows(row, i) / w.pixel_size);
  const int sides[2] = {w.width, w.height};
  for (int i = 0; i < 2; ++i) {
    ASSERT_LE(-0.5 * sides[i], w.lo[i]);
    ASSERT_LE(w.hi[i], 0.5 * sides[i]);
  }
  for (const Box& region : regions) {
    for (const Vec3& corner : rational::box_corners(region)) {
      const Q3 q = rational::image(w, corner);
      for (int i = 0; i < 3; ++i) {
        ASSERT_GE(Q(q[i] - 1), Q(w.lo[i])) << "axis " << i;
        ASSERT_LE(Q(q[i] + 1), Q(w.hi[i])) << "axis " << i;
      }
    }
  }
}

Box random_region(Random& random) {
  Vec3 at = Vec3::Zero(), size;
  const int kind = random.below(9);
  for (int i = 0; i < 3; ++i) {
    if (kind == 0) size[i] = random.uniform(0, 2);
    if (kind == 1) size[i] = std::abs(random.scaled(-40, 40));  // any aspect ratio
    if (kind == 2) size[i] = random.coin() ? 0 : 1;             // flat, a segment, a point
    if (kind == 3) size[i] = std::abs(random.scaled(-1074, -1010));
    if (kind == 4) size[i] = std::abs(random.scaled(900, 1020));
    if (kind == 5) size[i] = std::abs(random.scaled(-60, 2));
    if (kind > 5) size[i] = std::abs(random.scaled(-10, 1));
    if (kind == 5) at[i] = 1e9;                    // on the diagonal, below what doubles resolve
    if (kind == 6) at[i] = random.scaled(20, 40);  // far, sizes mixed
    if (kind == 7) at[i] = random.uniform(-5, 5);
    if (kind == 8) size[i] = 0, at[i] = nasty(random);
  }
  return {at, at + size};
}

TEST(FitWindow, ContainsTheExactRegionWithAPixelAround) {
  Random random(104);
  constexpr int kResolutions[] = {1, 2, 3, 7, 16, 63, 64, 100, 333, 1024, 2047, 4096, 5000};
  for (int n = 0; n < 40'000; ++n) {
    std::vector<Box> regions{random_region(random)};
    while (random.below(3) == 0) {
      Box next = random_region(random);
      if (random.coin()) {  // near the first
        const Vec3 shift = regions[0].lo - next.lo;
        next = {next.lo + shift, next.hi + shift};
      }
      regions.push_back(next);
    }
    const int resolution = random.coin() ? kResolutions[random.below(13)] : 1 + random.below(5000);
    const View view = rational::random_view(random);
    const std::optional<Window> window = fit_window(view, regions, resolution);
    ASSERT_TRUE(window) << view.name << " at " << resolution;
    SCOPED_TRACE(view.name + " at " + std::to_string(resolution) + ", case " + std::to_string(n));
    expect_fits(*window, regions, resolution);
    if (HasFatalFailure()) return;
  }
}

TEST(FitWindow, EveryResolutionKeepsItsLimit) {
  const std::vector<Box> cube{{Vec3(-1, -2, 0.1), Vec3(3, 5, 0.7)}};
  // Odd multiples of the spacing of doubles there: the middle is not a double.
  const std::vector<Box> far_and_small{
      {Vec3::Constant(1.088e9), Vec3::Constant(1.088e9 + 2.79e-5)}};
  for (const char* name : {"z", "1:2:3"}) {
    for (int resolution = 1; resolution <= 5000; resolution += resolution < 300 ? 1 : 37) {
      expect_fits(*fit_window(parse_view(name), cube, resolution), cube, resolution);
      expect_fits(*fit_window(parse_view(name), far_and_small, resolution), far_and_small,
                  resolution);
      if (HasFatalFailure()) return;
    }
  }
}

TEST(FitWindow, TheLargerSideHasTheResolutionWherePixelsCanBeResolved) {
  Random random(105);
  for (int n = 0; n < 2000; ++n) {
    const std::vector<Box> regions{{random.cube(1), Vec3::Constant(1 + random.uniform(0, 1))}};
    const int resolution = 1 + random.below(2000);
    const Window w = *fit_window(rational::random_view(random), regions, resolution);
    const Vec3 inner = w.hi - w.lo - Vec3::Constant(2);
    ASSERT_NEAR(std::max(inner[0], inner[1]), resolution, 1e-9 * resolution) << w.view.name;
  }
}

// The largest boxes doubles hold: nothing may be lost, be it that there is no window.
TEST(FitWindow, AtTheEndOfTheDoublesIsEmptyOrContains) {
  Random random(106);
  int empty = 0;
  for (int n = 0; n < 5000; ++n) {
    Box region = Box::empty();
    for (int k = 0; k < 2; ++k) region.add(random.cube(1) * (random.coin() ? DBL_MAX : 1e305));
    const std::vector<Box> regions{region};
    const int resolution = 1 + random.below(5000);
    const std::optional<Window> window =
        fit_window(rational::random_view(random), regions, resolution);
    if (!window) {
      ++empty;
      ASSERT_GT(std::max(region.lo.cwiseAbs().maxCoeff(), region.hi.cwiseAbs().maxCoeff()), 1e307);
      continue;
    }
    expect_fits(*window, regions, resolution);
    if (HasFatalFailure()) return;
  }
  EXPECT_GT(empty, 0);
}

// ----

using lab::meet, reference::Triangle;

Box box_of(const std::vector<Triangle>& triangles) {
  Box box = Box::empty();
  for (const Triangle& t : triangles)
    for (const Vec3& p : t) box.add(p);
  return box;
}

/// The plan recomputed from the definitions, over all objects and triangles.
bool as_defined(const std::vector<std::vector<Triangle>>& objects) {
  const Scene scene = reference::scene_of(objects);
  const Regions plan = find_regions(scene);
  std::vector<Box> boxes, regions;
  for (const auto& triangles : objects) boxes.push_back(box_of(triangles));
  for (std::size_t i = 0; i < boxes.size(); ++i) {
    for (std::size_t j = i + 1; j < boxes.size(); ++j)
      if (meet(boxes[i], boxes[j]))
        regions.push_back({boxes[i].lo.cwiseMax(boxes[j].lo), boxes[i].hi.cwiseMin(boxes[j].hi)});
  }
  std::vector<std::uint32_t> triangles;
  for (std::size_t i = 0, t = 0; i < objects.size(); ++i) {
    for (const Triangle& triangle : objects[i]) {
      bool takes_part = false;
      for (std::size_t j = 0; j < boxes.size(); ++j)
        takes_part |= i != j && meet(box_of({triangle}), boxes[j]);
      if (takes_part) triangles.push_back(static_cast<std::uint32_t>(t));
      ++t;
    }
  }
  const auto same = [](const Box& a, const Box& b) { return a.lo == b.lo && a.hi == b.hi; };
  return plan.triangles == triangles &&
         std::equal(plan.places.begin(), plan.places.end(), regions.begin(), regions.end(), same) &&
         std::equal(plan.object_boxes.begin(), plan.object_boxes.end(), boxes.begin(), boxes.end(),
                    same) &&
         plan.triangle_boxes.size() == scene.triangles.size();
}

Triangle tile(double x, double y = 0, double z = 0) {
  return {Vec3(x, y, z), Vec3(x + 1, y, z), Vec3(x, y + 1, z)};
}

TEST(Regions, TouchingCountsAndRegionsMayBePoints) {
  const Regions plan = find_regions(reference::scene_of({{tile(0), tile(-9)}, {tile(1, 1)}}));
  EXPECT_EQ(plan.triangles, (std::vector<std::uint32_t>{0, 2}));
  ASSERT_EQ(plan.places.size(), 1u);
  EXPECT_EQ(plan.places[0].lo, Vec3(1, 1, 0));
  EXPECT_EQ(plan.places[0].hi, Vec3(1, 1, 0));
}

RC_GTEST_PROP(PlanProperty, AsDefinedOnTheGrid, ()) {
  const auto sizes =
      *rc::gen::resize(7, rc::gen::container<std::vector<int>>(rc::gen::inRange(0, 12)));
  const auto extent = *rc::gen::inRange<unsigned>(1, 30);
  std::mt19937 random(*rc::gen::arbitrary<unsigned>());
  std::vector<std::vector<Triangle>> objects;
  for (const int size : sizes) {
    auto& triangles = objects.emplace_back(size);
    const Vec3 at(random() % extent, random() % extent, random() % 3);
    for (Triangle& t : triangles) {
      const Vec3 base = at + Vec3(random() % 4, random() % 4, random() % 2);
      for (Vec3& p : t) p = base + Vec3(random() % 3, random() % 3, random() % 2);
    }
  }
  RC_ASSERT(as_defined(objects));
}

// ---- Each term recomputed from the table of docs/budget.md with rationals; square roots by their
// squares.

const Q kU = Q(1) / Q(1 << 23);

RasterLimits with_bits(int subpixel_bits) {
  RasterLimits limits;
  limits.subpixel_bits = subpixel_bits;
  return limits;
}

/// Whether `value` is sqrt(dimension) * per_axis up to the rounding of a handful of doubles.
void expect_root(double value, int dimension, const Q& per_axis) {
  const Q square = Q(value) * Q(value), truth = dimension * per_axis * per_axis;
  EXPECT_LE(abs(square - truth), truth * Q(0x1p-49)) << value;
}

TEST(Budget, TermsAreTheFormulasOfTheTable) {
  for (const int bits : {4, 8, 16}) {
    for (const int viewport : {8, 64, 1024, 16384, 32768}) {
      const Budget b = budget_for(with_bits(bits), viewport);
      const Q m = Q(viewport) / 2;  // the largest |coordinate|, and half the viewport's side
      expect_root(b.sampling, 2, Q(1, 2));
      expect_root(b.input, 2, kU * m);
      // In the plane by e per axis, and along the depth to second order: e^2.
      const Q e(1, 1 << 10);
      EXPECT_GE(Q(b.double_), e * e);
      expect_root(Q(Q(b.double_) - e * e).get_d(), 2, e);
      // To normalized coordinates u M; division by w 2.5 u M; times half the viewport u M; plus its
      // centre u (M + W/2); and less than 4 u of all for products of the errors.
      expect_root(b.vertex, 2, kU * (1 + 4 * kU) * (m + Q(5, 2) * m + m + (m + m)));
      expect_root(b.snap, 2, Q(1) / Q(1 << bits));
      EXPECT_EQ(b.offset, 0);
    }
  }
}

TEST(Budget, TermsOfACanvasWithExactSamples) {
  for (const int viewport : {8, 64, 1024, 16384}) {
    RasterLimits limits = with_bits(8);
    const Budget gl = budget_for(limits, viewport);
    limits.exact_samples = true;
    const Budget b = budget_for(limits, viewport);
    // Corners rounded to float and the comparison of edges: 3.51 u M, charged as 4 u M.
    expect_root(b.input, 2, 4 * kU * Q(viewport) / 2);
    EXPECT_EQ(b.vertex, 0);
    EXPECT_EQ(b.snap, 0);
    EXPECT_EQ(b.sampling, gl.sampling);
    EXPECT_EQ(b.double_, gl.double_);
  }
}

RC_GTEST_PROP(BudgetProperty, RadiusIsStrictlyBeyondTheExactSum, ()) {
  Budget b;
  for (double* term : {&b.sampling, &b.input, &b.double_, &b.vertex, &b.snap, &b.offset}) {
    const auto mantissa = *rc::gen::inRange<std::int64_t>(0, std::int64_t{1} << 53);
    *term = std::ldexp(static_cast<double>(mantissa), *rc::gen::inRange(-80, -40));
  }
  b.sampling += 0x1p-30;  // of six zeros nothing is strictly greater
  Q sum = 0;
  for (const BudgetTerm& term : b.terms()) sum += Q(term.px);
  RC_ASSERT(Q(b.radius()) > sum);
  RC_ASSERT(Q(b.radius()) < sum * (1 + Q(0x1p-39)));  // and the ball is not blown up
}

// What the measurements asked for: 1.006 of the published radius and more at 8 bits.
TEST(Budget, RadiusIsBeyondTheMeasuredThreshold) {
  const double radius = budget_for(with_bits(8), 1024).radius();
  EXPECT_GT(radius, 1.006 * published_radius(0));
  EXPECT_LT(radius, 1.02 * published_radius(0));
}

TEST(Budget, PublishedRadiusIsHalfTheDiagonalOfAPixel) {
  EXPECT_NEAR(published_radius(0), std::sqrt(2.0) / 2, 0x1p-52);
  EXPECT_NEAR(published_radius(1), std::sqrt(3.0) / 2, 0x1p-52);
  EXPECT_NEAR(published_radius(std::sqrt(2.0)), 1, 0x1p-51);
  EXPECT_NEAR(published_radius(1e6), 0.5e6, 1e-5);
}

TEST(Budget, ViewportIsAPowerOfTwoThatHoldsWindowAndBorder) {
  for (int window = 1; window < 20'000; ++window) {
    const int side = viewport_side(window);
    ASSERT_TRUE(std::has_single_bit(static_cast<unsigned>(side)));
    ASSERT_GE(side, window + 2 * kBorder);
    ASSERT_LT(side / 2, window + 2 * kBorder);
  }
  EXPECT_EQ(viewport_side(60), 64);
  EXPECT_EQ(viewport_side(61), 128);
}

}  // namespace
}  // namespace farcull
