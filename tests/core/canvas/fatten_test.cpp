// Fattening: items, clipped triangles and drawables that are left out.
#include "core/canvas/fatten.h"
#include "offsets/offsets.h"

#include "tests/lab/rational.h"
#include "tests/lab/reference.h"
#include "tests/lab/test.h"

namespace farcull {
namespace {

using rational::Q, rational::Random;
using Points = std::vector<Vec3>;

Window window_of(Random& random) {
  Box region{random.cube(1), Vec3::Constant(1)};
  region.hi += random.scaled3(-8, 3).cwiseAbs();
  const std::vector<Box> regions{region};
  return *fit_window(rational::random_view(random), regions, 1 + random.below(900));
}

/// Polygons as clipping leaves them: inside the region and its margin.
Points random_polygon(Random& random, const Window& window) {
  const auto inside = [&] {
    Vec3 p;
    for (int i = 0; i < 3; ++i) p[i] = random.uniform(window.lo[i], window.hi[i]);
    return p;
  };
  const auto kept = [&](const Vec3& p) { return Vec3(p.cwiseMax(window.lo).cwiseMin(window.hi)); };
  Points points;
  const int kind = random.below(7);
  const Vec3 a = inside();
  if (kind == 0)
    for (int i = 0; i < 3 + random.below(7); ++i) points.push_back(inside());
  if (kind == 1) {  // needle
    const Vec3 b = inside();
    points = {a, b, kept(a + (b - a) * random.uniform(0, 1) + random.scaled3(-60, 0))};
  }
  if (kind == 2)  // point-like, down to one point
    points = {a, kept(a + random.scaled3(-300, -20)), random.coin() ? a : kept(a * (1 + 1e-12))};
  if (kind == 3)  // end-on: a line in space, a point in the image
    points = {a, Vec3(a[0], a[1], window.lo[2]), Vec3(a[0], a[1], window.hi[2])};
  if (kind == 4)  // covers the window
    points = {window.lo, Vec3(window.hi[0], window.lo[1], 0), window.hi,
              Vec3(window.lo[0], window.hi[1], 0)};
  if (kind == 5)  // along the diagonal of the window: the rectangle around it does not fit
    points = {window.lo, window.hi, kept(a * 0x1p-10)};
  if (kind == 6)  // small
    for (int i = 0; i < 3; ++i) points.push_back(kept(a + random.scaled3(-8, 4)));
  return points;
}

// The quadrilateral is the meet of the half-planes left of its edges. Each must hold the disc, or
// the whole window (then the part of the disc that it cuts off is outside). Tolerance: corners are
// rounded to floats, by at most 2^-24 of the bound per axis, after roundings in double that are
// smaller by 2^-25; a line through two points that move by d moves by d between them. 2^-23 sqrt(2)
// of the bound is the budget's term "input", which pays for it.
void expect_contains_discs(const std::array<float, 8>& corners, const Points& points, double radius,
                           const Window& window, const ProxyBounds& bounds) {
  const Q margin = Q(radius) - Q(1.4142 * 0x1p-23 * std::max(bounds.x, bounds.y));
  ASSERT_GT(margin, 0);
  const double half[2] = {0.5 * window.width, 0.5 * window.height};
  for (int i = 0; i < 4; ++i) {
    const int j = (i + 1) % 4;
    const Q x = corners[2 * i], y = corners[2 * i + 1];
    const Q ex = Q(corners[2 * j]) - x, ey = Q(corners[2 * j + 1]) - y;
    const Q square = ex * ex + ey * ey;
    ASSERT_GT(square, 0);
    const auto left = [&](const Q& px, const Q& py) { return Q(ex * (py - y) - ey * (px - x)); };
    bool holds_window = true;
    for (int k = 0; k < 4; ++k)
      holds_window &= left(Q(k & 1 ? half[0] : -half[0]), Q(k & 2 ? half[1] : -half[1])) >= 0;
    if (holds_window) continue;
    for (const Vec3& p : points) {
      const Q s = left(Q(p[0]), Q(p[1]));
      ASSERT_GT(s, 0) << "edge " << i;
      ASSERT_GE(s * s, margin * margin * square) << "edge " << i;
    }
  }
}

TEST(ProxyRectangle, ContainsEveryDiscInTheWindow) {
  Random random(401);
  for (int n = 0; n < 8000; ++n) {
    const Window window = window_of(random);
    const ProxyBounds bounds = proxy_bounds(window);
    const Points points = random_polygon(random, window);
    const double radius = random.below(4) == 0 ? std::abs(random.scaled(-7, 6)) : 0.715;
    const std::array<float, 8> corners = proxy_rectangle(points, radius, bounds);
    for (int i = 0; i < 4; ++i) {
      ASSERT_LE(std::abs(corners[2 * i]), bounds.x);
      ASSERT_LE(std::abs(corners[2 * i + 1]), bounds.y);
    }
    expect_contains_discs(corners, points, radius, window, bounds);
    if (HasFatalFailure()) FAIL() << "polygon " << n;
  }
}

TEST(ProxyRectangle, BoundsLieBetweenWindowAndViewport) {
  for (int side = 2; side < 9000; side += 2) {
    Window window{};
    window.width = side;
    window.height = 2;
    const ProxyBounds bounds = proxy_bounds(window);
    ASSERT_GE(bounds.x, 0.5 * side + 1);
    ASSERT_LT(bounds.x, 0.5 * viewport_side(side));
    ASSERT_EQ(bounds.x, static_cast<float>(bounds.x));
    ASSERT_EQ(bounds.y, 0.5 * viewport_side(2) - 1);
  }
}

// Else a rectangle of the whole window would pass: slivers get theirs.
TEST(ProxyRectangle, IsTightAroundObliqueNeedles) {
  Random random(402);
  const ProxyBounds bounds{511, 511};
  for (int n = 0; n < 5000; ++n) {
    Vec3 a = random.cube(200), b = random.cube(200);
    const double length = (b - a).head<2>().norm();
    const std::array<float, 8> c = proxy_rectangle(Points{a, b, 0.5 * (a + b)}, 0.75, bounds);
    double area = 0;
    for (int i = 0; i < 4; ++i) {
      const int j = (i + 1) % 4;
      area += 0.5 * (double(c[2 * i]) * c[2 * j + 1] - double(c[2 * j]) * c[2 * i + 1]);
    }
    ASSERT_NEAR(area, (length + 1.5) * 1.5, 0.01 * (1 + length));
  }
}

bool same(const Drawables& a, const Drawables& b) {
  const auto bytes = [](const auto& x, const auto& y) {
    return x.size() == y.size() &&  // memcmp takes no null pointer, not even for no bytes
           (x.empty() || std::memcmp(x.data(), y.data(), x.size() * sizeof x[0]) == 0);
  };
  return a.mode == b.mode && a.first == b.first && a.undrawable == b.undrawable &&
         bytes(a.proxies, b.proxies) && bytes(a.triangles, b.triangles);
}

/// Small, cut, outside, and undrawable triangles in no order.
Scene mixed_scene(Random& random, std::size_t count) {
  std::vector<reference::Triangle> triangles(count);
  for (reference::Triangle& t : triangles) {
    const Vec3 at = random.cube(1.3);
    for (Vec3& p : t) p = at + random.cube(0.1);
    if (random.below(9) == 0) t[0] = random.cube(50);
    if (random.below(29) == 0) t[1] = random.cube(1e20);
  }
  return reference::scene_of({triangles});
}

TEST(Fatten, IsTheConcatenationOfItsItems) {
  Random random(403);
  const std::vector<Box> region{{Vec3::Constant(-1), Vec3::Constant(1)}};
  const Scene scene = mixed_scene(random, 20'000);  // several chunks where there are cores
  std::vector<std::uint32_t> items;
  for (std::uint32_t t = 0; t < scene.triangles.size(); ++t)
    if (random.below(8) != 0) items.push_back(t);
  for (const Fattener& fattener : {obb_fattener(), raw_triangles(), obb_surface_fattener()}) {
    for (const char* view : {"z", "1:2:3"}) {
      const Window window = *fit_window(parse_view(view), region, 300);
      FattenCounts counts, expected_counts;
      const Drawables found = fatten(scene, items, window, fattener, 0.75, counts);
      Drawables expected;
      expected.mode = fattener.mode;
      for (std::uint32_t i = 0; i < items.size(); ++i) {
        const Patch patch = clip_to_region(window, scene.corners(items[i]));
        if (!patch.drawable()) {
          expected.undrawable.push_back(i);
          ++expected_counts.undrawable;
        } else if (patch.count == 0) {
          ++expected_counts.outside;
        } else {
          expected_counts.clipped += patch.cuts > 0;
          fattener.fatten(patch, 0.75, proxy_bounds(window), expected);
        }
        expected.first.push_back(static_cast<std::uint32_t>(expected.elements()));
      }
      ASSERT_TRUE(same(found, expected)) << fattener.name << ", " << view;
      EXPECT_EQ(counts.outside, expected_counts.outside);
      EXPECT_EQ(counts.clipped, expected_counts.clipped);
      EXPECT_EQ(counts.undrawable, expected_counts.undrawable);
      EXPECT_GT(counts.outside, 100u);
      EXPECT_GT(counts.clipped, 100u);
      EXPECT_GT(counts.undrawable, 100u);
      ASSERT_EQ(found.items(), items.size());
      ASSERT_EQ(found.first.back(), found.elements());
      for (const std::uint32_t i : found.undrawable) ASSERT_EQ(found.first[i], found.first[i + 1]);
    }
  }
}

TEST(Fatten, ProxiesThatWaitAreFittedToTheirTriangle) {
  Random random(405);
  const std::vector<Box> region{{Vec3::Constant(-1), Vec3::Constant(1)}};
  const Scene scene = mixed_scene(random, 20'000);  // several chunks where there are cores
  std::vector<std::uint32_t> items(scene.triangles.size());
  std::iota(items.begin(), items.end(), 0);
  const Window window = *fit_window(parse_view("1:2:3"), region, 300);
  for (const Fattener& fattener : {obb_fattener(), raw_triangles()}) {
    FattenCounts counts, waiting_counts;
    const Drawables fitted = fatten(scene, items, window, fattener, 0.75, counts);
    const Drawables waiting =
        fatten(scene, items, window, fattener, 0.75, waiting_counts, {}, 0.74);
    EXPECT_EQ(counts.outside, waiting_counts.outside);
    EXPECT_EQ(counts.clipped, waiting_counts.clipped);
    EXPECT_EQ(waiting.first, fitted.first);
    EXPECT_EQ(waiting.undrawable, fitted.undrawable);
    if (fattener.raw) {
      EXPECT_TRUE(same(waiting, fitted)) << "only proxies wait";
      continue;
    }
    std::size_t there = 0;
    for (std::size_t e = 0; e < waiting.elements(); ++e) {
      Proxy proxy;
      std::uint8_t done = 1;
      if (waiting.sources[e] & kFitted) {
        proxy = waiting.proxies[waiting.sources[e] - kFitted];
        ++there;
      } else {
        FattenBatch batch = waiting.batch;
        batch.items = &waiting.sources[e];
        batch.count = 1;
        batch.out = &proxy;
        batch.done = &done;
        waiting.fit(batch);
      }
      ASSERT_EQ(done, 1);
      ASSERT_EQ(std::memcmp(&proxy, &fitted.proxies[e], sizeof proxy), 0) << e;
    }
    EXPECT_EQ(there, waiting.proxies.size());
    EXPECT_GT(there, 100u);
    EXPECT_GT(waiting.elements(), 2 * there);
  }
}

TEST(RawTriangles, AreAFanOfThePatchInFloat) {
  Random random(404);
  for (int n = 0; n < 500; ++n) {
    Patch patch;
    patch.count = 3 + random.below(7);
    for (int i = 0; i < patch.count; ++i) patch.corners[i] = random.cube(100);
    Drawables out;
    out.mode = DepthMode::fixed;
    raw_triangles().fatten(patch, 5, {1, 1}, out);
    ASSERT_EQ(out.triangles.size(), static_cast<std::size_t>(patch.count - 2));
    for (int t = 0; t + 2 < patch.count; ++t) {
      const int corners[3] = {0, t + 1, t + 2};
      for (int i = 0; i < 3; ++i) {
        for (int axis = 0; axis < 3; ++axis) {
          ASSERT_EQ(out.triangles[t][4 * i + axis],
                    static_cast<float>(patch.corners[corners[i]][axis]));
        }
        ASSERT_EQ(out.triangles[t][4 * i + 3], 0);  // the canvas's own number
      }
    }
  }
}

}  // namespace
}  // namespace farcull
