// Triangulates polygons by ear clipping (Meisters: Polygons have ears, 1975). The sign of an area
// is computed in double. If rounding might change the sign, the sign is computed again exactly.
#include "experiments/scenes/mesh/load.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace farcull {
namespace {

constexpr std::size_t kMaxEarCorners = 8192;
constexpr double kUnit = 0x1p-53;  // largest relative rounding error of an operation
constexpr double kTiny = std::numeric_limits<double>::denorm_min();

// Adds products of finite doubles exactly, in fixed point. The lowest bit is 2^-2148, the square of
// the least positive double. A sum of 2^32 products has at most 2148 + 2048 + 32 bits.
class ExactSum {
 public:
  // Adds the product a b, or subtracts it if `minus`.
  void add(double a, double b, bool minus = false) {
    const Parts x(a), y(b);
    Words& sum = sums_[x.negative ^ y.negative ^ static_cast<unsigned>(minus)];
    const unsigned at = x.shift + y.shift;
    add_word(sum, x.low * y.low, at);
    add_word(sum, x.low * y.high + x.high * y.low, at + 32);  // the sum is below 2^54
    add_word(sum, x.high * y.high, at + 64);
  }
  // Adds a b - c d.
  void add_difference(double a, double b, double c, double d) {
    add(a, b);
    add(c, d, true);
  }
  int sign() const {
    const auto [plus, minus] = std::mismatch(sums_[0].rbegin(), sums_[0].rend(), sums_[1].rbegin());
    if (plus == sums_[0].rend()) return 0;
    return *plus > *minus ? 1 : -1;
  }
  // Returns the index and the value of the highest nonzero word of the sum's absolute value. The
  // order of these pairs is the order of the absolute values, except for sums with equal pairs.
  std::pair<std::size_t, std::uint64_t> magnitude() const {
    const int which = sign() < 0 ? 1 : 0;
    const Words &greater = sums_[which], &less = sums_[1 - which];
    std::pair<std::size_t, std::uint64_t> out;
    std::uint64_t borrow = 0;
    for (std::size_t k = 0; k < greater.size(); ++k) {
      const std::uint64_t word = greater[k] - less[k] - borrow;
      borrow = greater[k] < less[k] || (borrow > 0 && greater[k] == less[k]) ? 1 : 0;
      if (word > 0) out = {k, word};
    }
    return out;
  }

 private:
  using Words = std::array<std::uint64_t, 68>;  // least significant first

  // Represents a double as +-(high 2^32 + low) 2^(shift - 1074).
  struct Parts {
    explicit Parts(double x) {
      const auto bits = std::bit_cast<std::uint64_t>(x);
      const auto exponent = static_cast<unsigned>(bits >> 52 & 0x7FF);
      std::uint64_t mantissa = bits & ((std::uint64_t{1} << 52) - 1);
      if (exponent > 0) mantissa |= std::uint64_t{1} << 52;
      negative = static_cast<unsigned>(bits >> 63);
      shift = exponent > 0 ? exponent - 1 : 0;
      high = mantissa >> 32;
      low = mantissa & 0xFFFF'FFFF;
    }
    unsigned negative, shift;
    std::uint64_t high, low;
  };

  static void add_word(Words& sum, std::uint64_t value, unsigned shift) {
    std::size_t word = shift / 64;
    const unsigned bit = shift % 64;
    const std::uint64_t low = value << bit;
    sum[word] += low;
    std::uint64_t carry = (bit > 0 ? value >> (64 - bit) : 0) + (sum[word] < low ? 1 : 0);
    while (carry > 0) {
      sum[++word] += carry;
      carry = sum[word] < carry ? 1 : 0;
    }
  }

  std::array<Words, 2> sums_{};  // [0]: sum of positive terms; [1]: sum of |negative terms|
};

// A plane of two coordinates, u and v, in which the polygon is counterclockwise.
struct Plane {
  int u = 1, v = 2;
  bool has_area = true;
};

// Returns twice the area of the polygon in a plane, by Newell's formula, without rounding.
ExactSum exact_area(std::span<const Vec3> points, int u, int v) {
  ExactSum area;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Vec3& a = points[i];
    const Vec3& b = points[i + 1 == points.size() ? 0 : i + 1];
    area.add_difference(a[u], b[v], a[v], b[u]);
  }
  return area;
}

// Returns a plane perpendicular to a coordinate axis. In absolute value, the component of the
// polygon's normal on this axis is at least half of the largest component. The normal is computed
// in double. If its largest component m has |m| <= bound, exact areas decide.
//
// With n corners, each component is a sum of at most 2 n products of two differences. A product is
// rounded three times, and then takes part in at most 2 n additions. So each product adds an error
// below (2 n + 4) kUnit times its absolute value, plus kTiny / 2 if it underflows.
//
// Let e bound the error of m, and f the error of another component. `bound` is at least 2 e + f. If
// |m| exceeds `bound`, the sign of m is right. In absolute value, the exact component is at least
// |m| - e, and the exact other component is at most |m| + f, which is below 2 (|m| - e).
Plane plane_of(std::span<const Vec3> points) {
  Vec3 normal = Vec3::Zero(), terms = Vec3::Zero();
  Vec3 a = Vec3::Zero();  // the previous corner minus the first one
  for (std::size_t i = 1; i < points.size(); ++i) {
    const Vec3 b = points[i] - points[0];
    const Vec3 plus(a.y() * b.z(), a.z() * b.x(), a.x() * b.y());
    const Vec3 minus(a.z() * b.y(), a.x() * b.z(), a.y() * b.x());
    normal += plus - minus;
    terms += plus.cwiseAbs() + minus.cwiseAbs();
    a = b;
  }
  const double n = static_cast<double>(points.size());
  const double bound = (4 * n + 8) * kUnit * terms.sum() + 4 * n * kTiny;
  int axis = 0;
  normal.cwiseAbs().maxCoeff(&axis);
  int sign = normal[axis] > 0 ? 1 : -1;
  if (!(std::abs(normal[axis]) > bound)) {  // also true for NaN
    std::array<ExactSum, 3> exact;
    for (int k = 0; k < 3; ++k) exact[k] = exact_area(points, (k + 1) % 3, (k + 2) % 3);
    axis =
        static_cast<int>(std::ranges::max_element(exact, {}, &ExactSum::magnitude) - exact.begin());
    sign = exact[axis].sign();
  }
  Plane plane{(axis + 1) % 3, (axis + 2) % 3, sign != 0};
  if (sign < 0) std::swap(plane.u, plane.v);
  return plane;
}

bool collinear(std::span<const Vec3> points) {
  const auto other = std::ranges::find_if(points, [&](const Vec3& p) { return p != points[0]; });
  return other == points.end() || std::ranges::all_of(points, [&](const Vec3& p) {
           return turn(points[0], *other, p, 0, 1) == 0 && turn(points[0], *other, p, 1, 2) == 0 &&
                  turn(points[0], *other, p, 2, 0) == 0;
         });
}

using Triangle = std::array<std::uint32_t, 3>;

// The corners of a polygon that are left after cutting off ears, linked by `next` and `previous`.
struct Ring {
  Ring(std::span<const Vec3> points, const Plane& plane, Turn given)
      : at(points),
        by(given),
        u(plane.u),
        v(plane.v),
        next(size()),
        previous(size()),
        reflex(size()) {
    for (std::uint32_t i = 0; i < size(); ++i) {
      next[i] = i + 1 == size() ? 0 : i + 1;
      previous[i] = i == 0 ? size() - 1 : i - 1;
    }
    for (std::uint32_t i = 0; i < size(); ++i) classify(i);
  }

  std::uint32_t size() const { return static_cast<std::uint32_t>(at.size()); }
  int turn_of(const Vec3& a, const Vec3& b, const Vec3& c) const { return by(a, b, c, u, v); }
  int turn_at(std::uint32_t i) const { return turn_of(at[previous[i]], at[i], at[next[i]]); }
  void classify(std::uint32_t i) { reflex[i] = turn_at(i) < 0; }
  bool same(const Vec3& a, const Vec3& b) const { return a[u] == b[u] && a[v] == b[v]; }

  // True if corner i is convex, and the triangle of i and its two neighbours holds no reflex
  // corner. (Convex corners need no test.) A reflex corner at the position of one of the triangle's
  // corners is ignored, since such a corner ends a seam that joins a hole to the outline.
  bool is_ear(std::uint32_t i, std::uint64_t& steps) const {
    if (turn_at(i) <= 0) return false;
    const Vec3& a = at[previous[i]];
    const Vec3& b = at[i];
    const Vec3& c = at[next[i]];
    for (std::uint32_t k = next[next[i]]; k != previous[i]; k = next[k]) {
      ++steps;
      const Vec3& p = at[k];
      if (!reflex[k] || same(p, a) || same(p, b) || same(p, c)) continue;
      if (turn_of(a, b, p) >= 0 && turn_of(b, c, p) >= 0 && turn_of(c, a, p) >= 0) return false;
    }
    return true;
  }

  void cut(std::uint32_t i) {
    next[previous[i]] = next[i];
    previous[next[i]] = previous[i];
    classify(previous[i]);
    classify(next[i]);
  }

  // True if the polygon winds around once. Precondition: the polygon makes no right turns. If a
  // polygon winds once, its corners rise lexicographically to one highest corner, and then fall.
  bool goes_round_once() const {
    const auto below = [&](const Vec3& a, const Vec3& b) {
      return a[u] < b[u] || (a[u] == b[u] && a[v] < b[v]);
    };
    // `before` and `first` are the directions of the previous and the first edge: 1 if the edge
    // rises, -1 if it falls, 0 if there was no edge yet. Edges of length 0 are skipped.
    int falls = 0, before = 0, first = 0;
    for (std::uint32_t i = 0; i < size(); ++i) {
      const Vec3& a = at[i];
      const Vec3& b = at[next[i]];
      if (same(a, b)) continue;
      const int now = below(a, b) ? 1 : -1;
      if (before == 0) first = now;
      falls += before == 1 && now == -1;
      before = now;
    }
    return falls + (before == 1 && first == -1) <= 1;
  }

  // True if the interiors of two triangles meet. Disjoint interiors are separated by the line
  // through an edge of one of the triangles. Precondition: both triangles are counterclockwise.
  bool overlap(const Triangle& s, const Triangle& t) const {
    for (const auto& [x, y] : {std::pair(&s, &t), std::pair(&t, &s)}) {
      for (std::size_t k = 0; k < 3; ++k) {
        const Vec3& a = at[(*x)[k]];
        const Vec3& b = at[(*x)[(k + 1) % 3]];
        if (std::ranges::all_of(*y, [&](std::uint32_t c) { return turn_of(a, b, at[c]) <= 0; }))
          return false;
      }
    }
    return true;
  }

  // True if no triangle is clockwise, and no two triangles overlap.
  bool whole(std::span<const Triangle> triangles) const {
    struct Extent {
      double lo, hi;
      const Triangle* triangle;
    };
    std::vector<Extent> along;
    for (const Triangle& t : triangles) {
      const int sign = turn_of(at[t[0]], at[t[1]], at[t[2]]);
      if (sign < 0) return false;
      const auto [lo, hi] = std::minmax({at[t[0]][u], at[t[1]][u], at[t[2]][u]});
      if (sign > 0) along.push_back({lo, hi, &t});
    }
    std::ranges::sort(along, {}, &Extent::lo);
    for (std::size_t i = 0; i < along.size(); ++i) {
      for (std::size_t k = i + 1; k < along.size() && along[k].lo < along[i].hi; ++k) {
        if (overlap(*along[i].triangle, *along[k].triangle)) return false;
      }
    }
    return true;
  }

  std::span<const Vec3> at;
  Turn by;
  int u, v;
  std::vector<std::uint32_t> next;
  std::vector<std::uint32_t> previous;
  std::vector<char> reflex;
};

}  // namespace

int certain_turn(const Vec3& a, const Vec3& b, const Vec3& c, int u, int v) {
  // Each product has three roundings, so its relative error is at most 3 kUnit to first order. An
  // underflow adds an error of at most kTiny / 2. The factor 4 kUnit covers higher orders and the
  // bound's own rounding. After an overflow, the bound is infinite or NaN, and the test is false.
  const double left = (b[u] - a[u]) * (c[v] - a[v]);
  const double right = (b[v] - a[v]) * (c[u] - a[u]);
  const double area = left - right;
  if (std::abs(area) > 4 * kUnit * (std::abs(left) + std::abs(right)) + 4 * kTiny)
    return area > 0 ? 1 : -1;
  return 0;
}

int turn(const Vec3& a, const Vec3& b, const Vec3& c, int u, int v) {
  if (const int sign = certain_turn(a, b, c, u, v)) return sign;
  ExactSum sum;
  sum.add_difference(a[u], b[v], a[v], b[u]);
  sum.add_difference(b[u], c[v], b[v], c[u]);
  sum.add_difference(c[u], a[v], c[v], a[u]);
  return sum.sign();
}

Triangulation triangulate(std::span<const Vec3> corners, std::vector<Triangle>& triangles,
                          Turn by) {
  if (corners.size() == 3) {
    triangles.push_back({0, 1, 2});
    return Triangulation::whole;
  }
  const Plane plane = plane_of(corners);
  Ring ring(corners, plane, by);
  const std::uint32_t n = ring.size();

  const bool convex = std::ranges::count(ring.reflex, true) == 0;
  if (!convex && n > kMaxEarCorners) return Triangulation::too_large;

  const std::size_t first = triangles.size();
  const std::uint64_t max_steps = 16 * std::uint64_t{n} * n;
  std::uint64_t steps = 0;
  std::uint32_t left = n;
  std::uint32_t i = 0;
  std::uint32_t refused = 0;
  while (!convex && left > 3 && refused < left) {
    if (steps > max_steps) {
      triangles.resize(first);
      return Triangulation::too_large;
    }
    ++steps;
    if (ring.is_ear(i, steps)) {
      triangles.push_back({ring.previous[i], i, ring.next[i]});
      ring.cut(i);
      --left;
      refused = 0;
    } else {
      ++refused;
    }
    i = ring.next[i];
  }
  // Cuts the remaining polygon into a fan. This polygon is a triangle, is convex, or has no ear
  // because it is degenerate or intersects itself.
  for (std::uint32_t k = ring.next[i]; ring.next[k] != i; k = ring.next[k])
    triangles.push_back({i, k, ring.next[k]});
  bool whole = false;
  if (!plane.has_area) {
    whole = collinear(corners);
  } else if (convex) {
    whole = ring.goes_round_once();
  } else {
    whole = ring.whole(std::span(triangles).subspan(first));
  }
  return whole ? Triangulation::whole : Triangulation::folded;
}

}  // namespace farcull
