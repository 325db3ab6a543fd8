// Polygons cut into triangles: their areas, compared as rationals. FARCULL_POLYGONS gives the
// number of random polygons.
#include "experiments/scenes/mesh/load.h"

#include "tests/lab/meshes.h"
#include "tests/lab/rational.h"
#include "verify/exact.h"

namespace farcull {
namespace {

using rational::Q;
using Polygon = std::vector<Vec3>;

// The sign as a sum of rounded products: what decided before, and loses polygons.
int rounded_turn(const Vec3& a, const Vec3& b, const Vec3& c, int u, int v) {
  const double area = (b[u] - a[u]) * (c[v] - a[v]) - (b[v] - a[v]) * (c[u] - a[u]);
  return (area > 0) - (area < 0);
}

// Twice the area in the plane of u and v.
Q area_of(const Polygon& points, int u, int v) {
  Q out;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Vec3& a = points[i];
    const Vec3& b = points[(i + 1) % points.size()];
    out += Q(a[u]) * Q(b[v]) - Q(a[v]) * Q(b[u]);
  }
  return out;
}

// Whether the triangles have the area of the polygon in this plane, as a sum of absolute values.
bool keeps_area(const Polygon& polygon, const std::vector<Triangle>& triangles, int u, int v) {
  Q sum;
  for (const auto& [a, b, c] : triangles)
    sum += abs(area_of({polygon[a], polygon[b], polygon[c]}, u, v));
  return sum == abs(area_of(polygon, u, v));
}

// ---- the sign

TEST(Turn, IsTheSignOfTheRationalOnDoublesOfAnySize) {
  rational::Random random(34);
  int zeros = 0, rounded_wrongly = 0;
  for (int round = 0; round < 20000; ++round) {
    const int kind = random.below(4);
    const double lo = kind == 0 ? -1074 : -3, hi = kind == 0 ? 1023.9 : 3;
    Vec3 a = random.scaled3(lo, hi), b = random.scaled3(lo, hi), c = random.scaled3(lo, hi);
    if (kind >= 2) {  // nearly on a line, perhaps far from the origin
      if (kind == 3) a += Vec3::Constant(1e6), b = a + 1e-3 * b;
      c = a + random.uniform(-2, 2) * (b - a);
    }
    if (random.below(8) == 0) c = random.coin() ? a : b;
    if (kind > 0 && random.coin()) {  // where products underflow or overflow, up to the last double
      const double scale = std::exp2(std::floor(random.uniform(-1074, 1003)));
      a *= scale, b *= scale, c *= scale;
    }
    for (int u = 0; u < 3; ++u) {
      const int v = (u + 1) % 3, expected = sgn(area_of({a, b, c}, u, v));
      ASSERT_EQ(turn(a, b, c, u, v), expected) << a << "\n" << b << "\n" << c;
      const int certain = certain_turn(a, b, c, u, v);
      ASSERT_TRUE(certain == 0 || certain == expected) << a << "\n" << b << "\n" << c;
      zeros += expected == 0;
      rounded_wrongly += rounded_turn(a, b, c, u, v) != expected;
    }
  }
  EXPECT_GT(zeros, 1000);
  EXPECT_GT(rounded_wrongly, 1000);
}

// ---- random polygons

using Spot = std::array<int, 2>;

int spot_turn(const Spot& a, const Spot& b, const Spot& c) {
  const int area = (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
  return (area > 0) - (area < 0);
}

bool on_segment(const Spot& p, const Spot& a, const Spot& b) {
  return spot_turn(a, b, p) == 0 && std::min(a[0], b[0]) <= p[0] && p[0] <= std::max(a[0], b[0]) &&
         std::min(a[1], b[1]) <= p[1] && p[1] <= std::max(a[1], b[1]);
}

// Whether edges i < k of the polygon share a point that is no common end.
bool edges_meet(const std::vector<Spot>& polygon, std::size_t i, std::size_t k) {
  const std::size_t n = polygon.size();
  const Spot &a = polygon[i], &b = polygon[i + 1], &c = polygon[k], &d = polygon[(k + 1) % n];
  if (k == i + 1) return on_segment(d, a, b) || on_segment(a, c, d);
  if (i == 0 && k == n - 1) return on_segment(c, a, b) || on_segment(b, c, d);
  if (on_segment(c, a, b) || on_segment(d, a, b) || on_segment(a, c, d) || on_segment(b, c, d))
    return true;
  return spot_turn(a, b, c) * spot_turn(a, b, d) < 0 && spot_turn(c, d, a) * spot_turn(c, d, b) < 0;
}

// A simple polygon whose corners are whole numbers: random corners, of which parts are turned round
// as long as two edges meet. Empty where that leads nowhere.
std::vector<Spot> simple_polygon(rational::Draws& random) {
  const int half = 3 + random.below(8);
  std::vector<Spot> spots(4 + random.below(11));
  for (Spot& s : spots) s = {random.below(2 * half + 1) - half, random.below(2 * half + 1) - half};
  std::ranges::sort(spots);
  spots.erase(std::unique(spots.begin(), spots.end()), spots.end());
  for (std::size_t i = spots.size(); i > 1; --i) std::swap(spots[i - 1], spots[random.below(i)]);
  const std::size_t n = spots.size();
  if (n < 4) return {};
  for (int round = 0; round < 100; ++round) {
    bool met = false;
    for (std::size_t i = 0; i + 1 < n; ++i) {
      for (std::size_t k = i + 1; k < n; ++k) {
        if (!edges_meet(spots, i, k)) continue;
        met = true;
        std::reverse(spots.begin() + static_cast<long>(i) + 1,
                     spots.begin() + static_cast<long>(k) + 1);
      }
    }
    if (!met) return spots;
  }
  return {};
}

// The corners as doubles, in the plane of u and v. They are rounded, which moves no corner over an
// edge; or moved exactly by a matrix of Fibonacci numbers, whose determinant is 1 or -1, so that
// the polygon becomes a sliver of the same area.
Polygon placed(const std::vector<Spot>& spots, rational::Draws& random, int u) {
  const int kind = random.below(4);
  std::array<double, 3> f = {0, 1, 1};
  for (int k = random.below(60); k > 0; --k) f = {f[1], f[2], f[1] + f[2]};
  Polygon out;
  for (const Spot& s : spots) {
    Vec3 p = Vec3::Zero();
    double &x = p[u], &y = p[(u + 1) % 3];
    x = s[0];
    y = s[1];
    if (kind == 0) x *= 0.001, y *= 0.001;
    if (kind == 1) x = 1000 + x * 0.001, y = y * 0.001 - 300;
    if (kind == 2) x = s[0] * f[2] + s[1] * f[1], y = s[0] * f[1] + s[1] * f[0];
    if (random.coin()) p[(u + 2) % 3] = 1e-20 * random.uniform(-1, 1);  // not planar
    out.push_back(p);
  }
  return out;
}

struct Cut {
  int polygons = 0, folded = 0, turned = 0, concave = 0, kept = 0;
};

// Cuts so many random polygons.
Cut cut_random(int count, Turn by) {
  rational::Random random(5);
  Cut out;
  while (out.polygons < count) {
    const std::vector<Spot> spots = simple_polygon(random);
    if (spots.empty()) continue;
    const int u = random.below(3), v = (u + 1) % 3;
    const Polygon polygon = placed(spots, random, u);
    std::vector<Triangle> triangles;
    const Triangulation found = triangulate(polygon, triangles, by);
    const int sign = sgn(area_of(polygon, u, v));
    ++out.polygons;
    out.folded += found != Triangulation::whole;
    out.kept += triangles.size() == polygon.size() - 2 && keeps_area(polygon, triangles, u, v);
    out.turned += std::ranges::any_of(triangles, [&](const Triangle& t) {
      return sgn(area_of({polygon[t[0]], polygon[t[1]], polygon[t[2]]}, u, v)) == -sign;
    });
    for (std::size_t i = 0; i < spots.size(); ++i) {
      const std::size_t n = spots.size();
      if (spot_turn(spots[i], spots[(i + 1) % n], spots[(i + 2) % n]) != -sign) continue;
      ++out.concave;
      break;
    }
  }
  std::cout << "[ " << out.polygons << " simple polygons, " << out.concave << " concave; "
            << out.polygons - out.kept << " of another area than their triangles, " << out.turned
            << " with triangles turned over, " << out.folded << " called folded ]\n";
  return out;
}

int polygons() {
  const char* text = std::getenv("FARCULL_POLYGONS");
  return text ? std::stoi(text) : 10'000;
}

TEST(Polygons, TrianglesOfRandomSimpleOnesHaveTheirAreaInExactNumbers) {
  const Cut cut = cut_random(polygons(), turn);
  EXPECT_EQ(cut.kept, cut.polygons);
  EXPECT_EQ(cut.turned, 0);
  EXPECT_EQ(cut.folded, 0);
  EXPECT_GT(cut.concave, cut.polygons / 2);
}

TEST(Polygons, ARoundedTurnLosesTheAreaOfSome) {
  const Cut cut = cut_random(polygons() / 10, rounded_turn);
  EXPECT_LT(cut.kept, cut.polygons - 10);
  EXPECT_GT(cut.turned, 10);
}

// A polygon in units of 0.001, and a triangle outside it that rounding let it meet.
TEST(Polygons, ATriangleOutsideOneDoesNotMeetIts) {
  Polygon polygon;
  for (const Spot& s :
       std::vector<Spot>{{2, 2}, {4, 2}, {6, -3}, {-6, -6}, {-3, 1}, {-3, -5}, {3, -3}})
    polygon.emplace_back(s[0] * 0.001, s[1] * 0.001, 0);
  const std::array<Vec3, 3> outside = {
      Vec3(-0.0003, -0.0026, -0.001), Vec3(-0.0003, -0.0026, 0.001), Vec3(-0.0002, -0.0026, 0.001)};
  const auto met = [&](Turn by) {
    std::vector<Triangle> triangles;
    triangulate(polygon, triangles, by);
    return std::ranges::count_if(triangles, [&](const Triangle& t) {
      return intersects({polygon[t[0]], polygon[t[1]], polygon[t[2]]}, outside);
    });
  };
  EXPECT_EQ(met(turn), 0);
  EXPECT_EQ(met(rounded_turn), 2);
}

// ---- chosen polygons

TEST(Triangulate, NamesWhatIsFoldedAndGivesTwoLessThanCorners) {
  const double big = std::numeric_limits<double>::max();
  // Round an annulus, one and a quarter turns: it lies over itself, and no triangle is turned over.
  Polygon spiral;
  for (int i = 0; i <= 10; ++i)
    spiral.emplace_back(3 * std::cos(0.785 * i), 3 * std::sin(0.785 * i), 0);
  for (int i = 10; i >= 0; --i)
    spiral.emplace_back(2 * std::cos(0.785 * i), 2 * std::sin(0.785 * i), 0);
  Polygon twice;  // round a loop and a smaller one, always to the left
  for (int i = 0; i < 16; ++i) {
    const double r = 2 + std::cos(0.3927 * i);
    twice.emplace_back(r * std::cos(0.7854 * i), r * std::sin(0.7854 * i), 0);
  }
  struct Case {
    const char* name;
    Polygon polygon;
    Triangulation expected;
  };
  constexpr Triangulation whole = Triangulation::whole, folded = Triangulation::folded;
  const std::vector<Case> cases = {
      {"a point", Polygon(5, Vec3(1, 2, 3)), whole},
      {"a segment", {{0, 0, 0}, {1, 1, 1}, {2, 2, 2}, {3, 3, 3}}, whole},
      {"a bow tie without area", {{0, 0, 0}, {2, 2, 0}, {2, 0, 0}, {0, 2, 0}}, folded},
      {"a bow tie", {{0, 0, 0}, {3, 3, 0}, {3, 0, 0}, {0, 2, 0}}, folded},
      {"a star", {{0, 3, 0}, {-2, -3, 0}, {3, 1, 0}, {-3, 1, 0}, {2, -3, 0}}, folded},
      {"walks back", {{0, 0, 0}, {1, 0, 0}, {0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, folded},
      {"crosses one edge", {{0, 0, 0}, {4, 0, 0}, {4, 4, 0}, {2, -1, 0}, {0, 4, 0}}, folded},
      {"lies over itself", spiral, folded},
      {"goes round twice", twice, folded},
      {"differences overflow",
       {{-big, -big, 0}, {big, -big, 0}, {-big / 2, -big / 2, 0}, {-big, big, 0}},
       whole},
      {"not planar", {{0, 0, 0}, {1, 0, 1}, {1, 1, 0}, {0, 1, 1}}, whole},
  };
  for (const Case& c : cases) {
    std::vector<Triangle> triangles;
    EXPECT_EQ(triangulate(c.polygon, triangles), c.expected) << c.name;
    EXPECT_EQ(triangles.size(), c.polygon.size() - 2) << c.name;
  }
}

}  // namespace
}  // namespace farcull
