// The proof that a clipped triangle keeps every point (docs/budget.md, "Clipping and the fan"),
// step by step with rationals. Beside each computed corner p_i stands an exact point q_i of the
// triangle. The claims: |p_i - q_i| <= error per axis; every point Q of the triangle that is one
// pixel inside every plane is in a triangle of the fan of the q_i, as Q = sum l_i q_i; so Q' = sum
// l_i p_i is in the drawn fan and within error per axis of Q.
#include "core/view/view.h"
#include "tests/core/view/clip_cases.h"
#include "tests/lab/test.h"

namespace farcull {
namespace {

using namespace clip_cases;
using rational::dot, rational::exact, rational::minus;

struct Corner {
  Vec3 p;
  Q3 q;
};

Q largest(const Q3& v) { return std::max({Q(abs(v[0])), Q(abs(v[1])), Q(abs(v[2]))}); }

// core/view/view.cpp with the exact point beside each corner: a cut at the parameter t, computed,
// of an edge whose ends are p and p' has its exact point at the parameter that the plane has
// between p and p', exactly, of the edge between q and q'.
std::vector<Corner> replay(const Window& window, const Triangle& corners) {
  std::vector<Corner> polygon;
  for (const Vec3& x : corners)
    polygon.push_back({to_pixel(window, x).p, rational::image(window, x)});
  for (int axis = 0; axis < 3; ++axis) {
    for (const bool upper : {false, true}) {
      const double plane = upper ? window.hi[axis] : window.lo[axis];
      const auto outside = [&](const Corner& c) {
        return upper ? c.p[axis] > plane : c.p[axis] < plane;
      };
      std::vector<Corner> out;
      for (std::size_t i = 0; i < polygon.size(); ++i) {
        const Corner& a = polygon[i];
        const Corner& b = polygon[(i + 1) % polygon.size()];
        if (!outside(a)) out.push_back(a);
        if (outside(a) == outside(b)) continue;
        const Corner &from = outside(a) ? b : a, &to = outside(a) ? a : b;
        const double t = (plane - from.p[axis]) / (to.p[axis] - from.p[axis]);
        Vec3 p = from.p + t * (to.p - from.p);
        p[axis] = plane;
        const Q at = (Q(plane) - Q(from.p[axis])) / (Q(to.p[axis]) - Q(from.p[axis]));
        out.push_back({p, between(from.q, to.q, at)});
      }
      polygon = out;
    }
  }
  return polygon;
}

/// The point of the fan of the p_i with the weights that `point` has in a triangle of the fan of
/// the q_i; none where it is in no such triangle.
std::optional<Q3> partner(const std::vector<Corner>& polygon, const Q3& point) {
  const auto on_edge = [&](const Corner& a, const Corner& b) -> std::optional<Q3> {
    const Q3 edge = minus(b.q, a.q), to = minus(point, a.q);
    const Q length = dot(edge, edge);
    const Q t = length == 0 ? Q(0) : Q(dot(to, edge) / length);
    if (t < 0 || t > 1 || largest(minus(between(a.q, b.q, t), point)) != 0) return {};
    return between(exact(a.p), exact(b.p), t);
  };
  for (std::size_t i = 2; i < polygon.size(); ++i) {
    const Corner &a = polygon[0], &b = polygon[i - 1], &c = polygon[i];
    for (const auto& found : {on_edge(a, b), on_edge(b, c), on_edge(c, a)})
      if (found) return found;
    const Q3 e = minus(b.q, a.q), f = minus(c.q, a.q), d = minus(point, a.q);
    const Q ee = dot(e, e), ef = dot(e, f), ff = dot(f, f), de = dot(d, e), df = dot(d, f);
    const Q det = ee * ff - ef * ef;
    if (det == 0) continue;
    const Q s = (de * ff - df * ef) / det, t = (df * ee - de * ef) / det;
    if (s < 0 || t < 0 || s + t > 1) continue;
    const Q3 p = exact(a.p), u = minus(exact(b.p), p), v = minus(exact(c.p), p);
    Q3 out;
    for (int k = 0; k < 3; ++k) {
      EXPECT_EQ(a.q[k] + s * e[k] + t * f[k], point[k]) << "the q_i lie in one plane";
      out[k] = p[k] + s * u[k] + t * v[k];
    }
    return out;
  }
  return {};
}

/// Corners of the polygon, and a point inside it.
std::vector<Q3> sample(const std::vector<Q3>& polygon, Random& random) {
  std::vector<Q3> points = polygon;
  if (polygon.empty()) return points;
  Q3 sum;
  Q weights = 0;
  for (const Q3& corner : polygon) {
    const Q weight = 1 + random.below(20);
    weights += weight;
    for (int k = 0; k < 3; ++k) sum[k] += weight * corner[k];
  }
  for (Q& x : sum) x /= weights;
  points.push_back(sum);
  return points;
}

struct Tally {
  int triangles = 0, clipped = 0, points = 0, lost = 0;
  double corner = 0, point = 0;  // the largest displacements, as parts of the error that is claimed
};

// `margin`: px between the points that are asked for and the planes. Without one, up to the first
// point that is lost.
Tally tally(int margin) {
  Random random(test_seed(205));
  Tally out;
  const auto seen = [&] {
    return margin == 0 ? out.lost > 0 : out.clipped > 200 && out.points > 1000 && out.point > 0;
  };
  for (int n = 0; more_cases(n, margin == 0 ? 0 : 200, seen(), 4000); ++n) {
    const Window window = random_window(random);
    for (int k = 0; k < 10; ++k) {
      const Triangle corners = random_triangle(random, window);
      const Patch patch = clip_to_region(window, corners);
      if (!patch.drawable()) continue;
      const std::vector<Corner> polygon = replay(window, corners);
      EXPECT_EQ(static_cast<int>(polygon.size()), patch.count);
      if (static_cast<int>(polygon.size()) != patch.count) return out;
      ++out.triangles;
      out.clipped += patch.cuts > 0;
      const Q error(patch.error);
      for (int i = 0; i < patch.count; ++i) {
        EXPECT_EQ(polygon[i].p, patch.corners[i])
            << "the replay is not what core/view/view.cpp does";
        const Q off = largest(minus(exact(polygon[i].p), polygon[i].q));
        out.corner = std::max(out.corner, Q(off / error).get_d());
        EXPECT_LE(off, error);
      }
      for (const Q3& point : sample(exact_part(window, corners, margin), random)) {
        ++out.points;
        const std::optional<Q3> found = partner(polygon, point);
        if (!found) {
          ++out.lost;
          continue;
        }
        const Q off = largest(minus(*found, point));
        out.point = std::max(out.point, Q(off / error).get_d());
        EXPECT_LE(off, error);
      }
    }
  }
  return out;
}

TEST(ClipFan, EveryPointHasAPartnerWithinTheErrorPerAxis) {
  const Tally found = tally(1);
  std::cout << found.triangles << " triangles, " << found.clipped << " clipped, " << found.points
            << " points; at most " << found.corner << " of the error at a corner, " << found.point
            << " at a point\n";
  EXPECT_EQ(found.lost, 0);
}

// A point on a plane, without the margin, may have no partner: the corners' rounding cut it away.
TEST(ClipFan, WithoutTheMarginPointsHaveNone) { tally(0); }

// How far cuts move their corners, at most, in units of 2^-53 times the largest coordinate; the
// corner that a cut starts from is taken as exact.
Q most_of_cuts(std::uint64_t seed) {
  Random random(seed);
  Q most = 0;
  for (int n = 0; n < 100'000; ++n) {
    const double m = std::abs(random.scaled(0, 30));
    const double from = random.uniform(-m, m), to = random.coin() ? -m : m,
                 other = random.sign() * m;
    const double other_to = random.coin() ? -other : random.uniform(-m, m);
    const double plane = from + (to - from) * random.uniform(0, 1);
    if (plane == from || plane == to) continue;
    const double t = (plane - from) / (to - from), p = other + t * (other_to - other);
    const Q at = (Q(plane) - Q(from)) / (Q(to) - Q(from));
    const Q truth = Q(other) + at * (Q(other_to) - Q(other));
    const Q units = abs(Q(p) - truth) / (Q(0x1p-53) * Q(m));
    most = std::max(most, units);
  }
  std::cout << "at most " << most.get_d() << " * 2^-53 of the largest coordinate\n";
  return most;
}

// A cut is charged 16 * 2^-53 times the largest coordinate (lemma 14).
TEST(ClipFan, ACutMovesItsCornerByLessThanItsCharge) {
  EXPECT_LE(most_of_cuts(test_seed(206)), 16);
}

// The twin: a charge of 5, which the roundings of the difference, the product and the sum alone
// would take, is exceeded. So those of the parameter are needed.
TEST(ClipFan, ACutMovesItsCornerByMoreThanAChargeOfFive) { EXPECT_GT(most_of_cuts(206), 5); }

// Why the partner is no foot along the triangle's normal: with every corner displaced by e along
// each axis, the point of the drawn patch on the normal through Q is 1.36 e away along an axis and
// 1.57 e in the image; the partner, e and sqrt(2) e.
TEST(ClipFan, TheFootAlongTheNormalIsFartherAway) {
  const Q e(1, 1024);
  const auto foot =
      [&e](const Q3& n) {  // of a plane displaced by (e, e, e), on the normal through 0
        const Q t = e * (n[0] + n[1] + n[2]) / dot(n, n);
        return Q3{t * n[0], t * n[1], t * n[2]};
      };
  const Q3 axis = foot({Q(2732, 1000), 1, 1});  // near 1 + sqrt(3), where it is worst
  EXPECT_GT(axis[0], e * Q(136, 100));
  EXPECT_LE(axis[0], e * Q(137, 100));
  const Q3 image = foot({Q(2225, 1000), Q(2225, 1000), 1});  // near 1 + sqrt(6)/2
  const Q square = image[0] * image[0] + image[1] * image[1];
  EXPECT_GT(square, e * e * Q(157, 100) * Q(157, 100));
  EXPECT_GT(square, 2 * e * e) << "sqrt(2) e, which the budget grants";
}

}  // namespace
}  // namespace farcull
