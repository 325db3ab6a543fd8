// Finds the common points of two triangles: one is cut by the half-spaces that bound the other
// (Sutherland, Hodgman: Reentrant polygon clipping, 1974). All numbers are integers, and a point
// has one denominator for its three coordinates, so nothing is rounded. The corners of the part
// that is left say how the triangles meet.
#include "verify/contact.h"

#include <gmpxx.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <utility>

#include "core/base/parallel.h"
#include "verify/exact.h"
#include "verify/squared_distance.h"

namespace farcull {
namespace {

using Corners = std::array<Vec3, 3>;
using Integers = std::array<mpz_class, 3>;

constexpr std::array<std::string_view, kContactKinds.size()> kNames = {
    "apart", "equal", "touch-vertex", "touch-edge", "coplanar", "crossing", "touch-face"};

mpz_class dot(const Integers& u, const Integers& v) {
  return u[0] * v[0] + u[1] * v[1] + u[2] * v[2];
}

Integers minus(const Integers& u, const Integers& v) {
  return {u[0] - v[0], u[1] - v[1], u[2] - v[2]};
}

Integers cross(const Integers& u, const Integers& v) {
  return {u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]};
}

bool is_zero(const Integers& u) { return sgn(u[0]) == 0 && sgn(u[1]) == 0 && sgn(u[2]) == 0; }

// ---- doubles as integers ----

/// x = mantissa 2^exponent; the mantissa is odd, or 0.
struct Parts {
  long mantissa = 0;
  long exponent = 0;
};
Parts parts(double x) {
  if (x == 0) return {};
  int exponent = 0;
  const auto digits = static_cast<long>(std::ldexp(std::frexp(x, &exponent), 53));
  const int zeros = std::countr_zero(static_cast<unsigned long>(digits));
  return {digits >> zeros, exponent - 53L + zeros};  // exact: the dropped digits are 0
}

/// The largest power of two of which all coordinates are multiples; 0 where all of them are 0.
long common_exponent(const Corners& a, const Corners& b) {
  long least = std::numeric_limits<long>::max();
  for (const Corners* t : {&a, &b}) {
    for (const Vec3& p : *t) {
      for (const double x : p) {
        if (x != 0) least = std::min(least, parts(x).exponent);
      }
    }
  }
  return least == std::numeric_limits<long>::max() ? 0 : least;
}

/// p / 2^exponent. Precondition: these are integers.
Integers scaled(const Vec3& p, long exponent) {
  Integers out;
  for (std::size_t k = 0; k < 3; ++k) {
    const Parts x = parts(p[static_cast<Eigen::Index>(k)]);
    out[k] = x.mantissa;
    if (x.mantissa != 0) out[k] <<= static_cast<mp_bitcnt_t>(x.exponent - exponent);
  }
  return out;
}

// ---- points ----

/// The point x / w, in units of a power of two. w > 0. Not in lowest terms.
struct Point {
  Integers x;
  mpz_class w = 1;
};

/// The sign of p - q in the lexicographic order.
int compare(const Point& p, const Point& q) {
  for (std::size_t k = 0; k < 3; ++k) {
    const int sign = cmp(p.x[k] * q.w, q.x[k] * p.w);
    if (sign != 0) return sign;
  }
  return 0;
}

/// q - p, times p.w q.w.
Integers direction(const Point& p, const Point& q) {
  Integers out;
  for (std::size_t k = 0; k < 3; ++k) out[k] = q.x[k] * p.w - p.x[k] * q.w;
  return out;
}

/// (s p.w p + t q.w q) / (s p.w + t q.w), a point between p and q. Precondition: s, t > 0.
Point between(const Point& p, const mpz_class& s, const Point& q, const mpz_class& t) {
  Point out;
  for (std::size_t k = 0; k < 3; ++k) out.x[k] = s * p.x[k] + t * q.x[k];
  out.w = s * p.w + t * q.w;
  return out;
}

/// The corners of the convex hull of t, sorted: three, two or one.
std::vector<Vec3> corners_of(const Corners& t) {
  std::vector<Vec3> out(t.begin(), t.end());
  std::sort(out.begin(), out.end(), [](const Vec3& p, const Vec3& q) {
    return std::lexicographical_compare(p.begin(), p.end(), q.begin(), q.end());
  });
  switch (shape(t)) {
    case Shape::point:
      out.resize(1);
      break;
    case Shape::segment:
      out = {out.front(), out.back()};
      break;
    case Shape::triangle:
      break;
  }
  return out;
}

/// The plane of the points p with normal . p = offset, or the half-space normal . p >= offset.
struct Bound {
  Integers normal;
  mpz_class offset;
  bool plane;

  Bound(const Integers& n, const Integers& at, bool is_plane)
      : normal(n), offset(dot(n, at)), plane(is_plane) {}
  /// normal . p - offset, times p.w.
  mpz_class value(const Point& p) const { return dot(normal, p.x) - offset * p.w; }
};

/// A triangle, segment or point as the hull of its corners, and as the points within its bounds.
class Hull {
 public:
  Hull(const Corners& t, long exponent) {
    for (const Vec3& p : corners_of(t)) corners_.push_back(scaled(p, exponent));
    if (corners_.size() == 3) {
      bound_triangle();
    } else if (corners_.size() == 2) {
      bound_segment();
    } else {
      for (std::size_t axis = 0; axis < 3; ++axis)
        bounds_.emplace_back(unit(axis), corners_[0], true);
    }
  }

  const std::vector<Integers>& corners() const { return corners_; }
  const std::vector<Bound>& bounds() const { return bounds_; }
  bool is_triangle() const { return corners_.size() == 3; }
  bool is_corner(const Point& p) const {
    return std::any_of(corners_.begin(), corners_.end(),
                       [&](const Integers& x) { return compare(p, {x}) == 0; });
  }
  /// Whether a point of the hull is on an edge. A segment is all edge.
  bool on_edge(const Point& p) const {
    return !is_triangle() || std::any_of(bounds_.begin(), bounds_.end(), [&](const Bound& bound) {
      return !bound.plane && sgn(bound.value(p)) == 0;
    });
  }
  /// Precondition: is_triangle().
  bool plane_holds(const Hull& other) const {
    return std::all_of(other.corners_.begin(), other.corners_.end(),
                       [&](const Integers& x) { return sgn(bounds_[0].value({x})) == 0; });
  }

 private:
  static Integers unit(std::size_t axis) {
    Integers out;
    out[axis] = 1;
    return out;
  }
  void bound_triangle() {
    const Integers n = cross(minus(corners_[1], corners_[0]), minus(corners_[2], corners_[0]));
    bounds_.emplace_back(n, corners_[0], true);
    for (std::size_t i = 0; i < 3; ++i) {
      const Integers edge = minus(corners_[(i + 1) % 3], corners_[i]);
      bounds_.emplace_back(cross(n, edge), corners_[i], false);
    }
  }
  /// Bounds a segment by two planes through its line, and one at each end. Its direction d is not 0
  /// along some axis; e is the unit vector along the next axis. So d x e is not 0, and d x (d x e)
  /// is perpendicular to d and to d x e.
  void bound_segment() {
    const Integers d = minus(corners_[1], corners_[0]);
    std::size_t axis = 0;
    while (sgn(d[axis]) == 0) ++axis;
    const Integers u = cross(d, unit((axis + 1) % 3));
    bounds_.emplace_back(u, corners_[0], true);
    bounds_.emplace_back(cross(d, u), corners_[0], true);
    bounds_.emplace_back(d, corners_[0], false);
    bounds_.emplace_back(minus(corners_[0], corners_[1]), corners_[1], false);
  }

  std::vector<Integers> corners_;
  std::vector<Bound> bounds_;
};

// ---- the intersection ----

/// The part of a convex polygon where sign * value >= 0. The polygon is the list of its corners in
/// turn: two corners are a segment, one is a point. A corner may be listed more than once.
std::vector<Point> cut(const std::vector<Point>& polygon, const Bound& bound, int sign) {
  std::vector<mpz_class> values;
  for (const Point& p : polygon) values.emplace_back(sign * bound.value(p));
  std::vector<Point> out;
  for (std::size_t k = 0; k < polygon.size(); ++k) {
    const std::size_t next = (k + 1) % polygon.size();
    if (sgn(values[k]) >= 0) out.push_back(polygon[k]);
    // The value is linear, and each value is scaled by its corner's w, so the point with these
    // weights has the value 0.
    if (sgn(values[k]) * sgn(values[next]) < 0)
      out.push_back(between(polygon[k], abs(values[next]), polygon[next], abs(values[k])));
  }
  return out;
}

/// Corners of the intersection in turn; one may be listed more than once.
std::vector<Point> clipped(const Hull& a, const Hull& b) {
  std::vector<Point> points;
  for (const Integers& x : a.corners()) points.push_back({x});
  for (const Bound& bound : b.bounds()) {
    points = cut(points, bound, 1);
    if (bound.plane) points = cut(points, bound, -1);
  }
  return points;
}

/// Corners of the intersection, sorted, each once.
std::vector<Point> common_points(const Hull& a, const Hull& b) {
  std::vector<Point> points = clipped(a, b);
  const auto before = [](const Point& p, const Point& q) { return compare(p, q) < 0; };
  const auto equal = [](const Point& p, const Point& q) { return compare(p, q) == 0; };
  std::sort(points.begin(), points.end(), before);
  points.erase(std::unique(points.begin(), points.end(), equal), points.end());
  return points;
}

/// The dimension of the hull of sorted points. If they lie on one line, the first and the last are
/// its ends.
int dimension_of(const std::vector<Point>& points) {
  if (points.size() <= 2) return static_cast<int>(points.size()) - 1;
  const Integers along = direction(points.front(), points.back());
  const bool line = std::all_of(points.begin(), points.end(), [&](const Point& p) {
    return is_zero(cross(along, direction(points.front(), p)));
  });
  return line ? 1 : 2;
}

/// True iff a and b lie in one plane. Precondition: they have two points in common, so two segments
/// lie on one line.
bool coplanar(const Hull& a, const Hull& b) {
  if (a.is_triangle()) return a.plane_holds(b);
  return !b.is_triangle() || b.plane_holds(a);
}

ContactKind kind_of(const Hull& a, const Hull& b, const std::vector<Point>& common) {
  if (common.empty()) return ContactKind::apart;
  if (a.corners() == b.corners()) return ContactKind::equal;
  if (common.size() == 1) {
    const Point& p = common.front();
    if (a.is_corner(p) || b.is_corner(p)) return ContactKind::touch_vertex;
    return a.on_edge(p) && b.on_edge(p) ? ContactKind::touch_edge : ContactKind::crossing;
  }
  if (coplanar(a, b)) return ContactKind::coplanar;
  // The triangles lie in two planes and have a segment in common, on the common line L of the
  // planes. If an edge meets L in one point, the triangle's part of L ends there, so that point is
  // not inside the common segment. So if an inner point of the segment is on an edge, the edge lies
  // on L, and the whole segment is on it.
  const Point inner = between(common.front(), 1, common.back(), 1);
  return a.on_edge(inner) || b.on_edge(inner) ? ContactKind::touch_face : ContactKind::crossing;
}

Vec3 rounded_point(const Point& p, long exponent) {
  const auto nearest = [&](std::size_t k) { return rounded_quotient(p.x[k], p.w, exponent); };
  return {nearest(0), nearest(1), nearest(2)};
}

/// Calls answer(corners of a, corners of b) for each pair, on several threads; returns the results.
template <class Answer>
auto answers(const Scene& scene, std::span<const TrianglePair> pairs, unsigned threads,
             const Answer& answer) {
  for (const TrianglePair& pair : pairs) {
    if (std::max(pair.a, pair.b) >= scene.triangles.size())
      throw std::logic_error("contact kinds: a pair names a triangle that the scene lacks");
  }
  constexpr std::size_t kLeast = 64;  // pairs per thread, enough to pay for it
  std::vector<decltype(answer(Corners(), Corners()))> out(pairs.size());
  for_chunks(pairs.size(), chunks_for(pairs.size(), kLeast, std::max(threads, 1u)),
             [&](std::size_t, std::size_t begin, std::size_t end) {
               for (std::size_t i = begin; i < end; ++i)
                 out[i] = answer(scene.corners(pairs[i].a), scene.corners(pairs[i].b));
             });
  return out;
}

}  // namespace

std::string_view name_of(ContactKind kind) { return kNames.at(static_cast<std::size_t>(kind)); }

std::optional<ContactKind> parse_contact_kind(std::string_view name) {
  for (const ContactKind kind : kContactKinds) {
    if (name_of(kind) == name) return kind;
  }
  return std::nullopt;
}

ContactKind contact_kind(const Corners& a, const Corners& b) {
  const std::optional<ContactKind> kind = kind_by_signs(a, b);
  return kind ? *kind : contact_shape(a, b).kind;
}

ContactShape contact_shape(const Corners& a, const Corners& b) {
  const long exponent = common_exponent(a, b);
  const Hull s(a, exponent), t(b, exponent);
  const std::vector<Point> common = common_points(s, t);
  ContactShape out{.kind = kind_of(s, t, common), .dimension = dimension_of(common)};
  if (out.dimension == 0 || out.dimension == 1)
    out.ends = {rounded_point(common.front(), exponent), rounded_point(common.back(), exponent)};
  return out;
}

std::vector<Vec3> contact_polygon(const Corners& a, const Corners& b) {
  const long exponent = common_exponent(a, b);
  const Hull s(a, exponent), t(b, exponent);
  if (dimension_of(common_points(s, t)) != 2) return {};
  // Points that are listed twice, or lie between their neighbours, are no corners.
  std::vector<Point> points = clipped(s, t);
  for (std::size_t k = 0; k < points.size();) {
    const Point& before = points[(k + points.size() - 1) % points.size()];
    const Point& after = points[(k + 1) % points.size()];
    if (is_zero(cross(direction(before, points[k]), direction(points[k], after)))) {
      points.erase(points.begin() + static_cast<std::ptrdiff_t>(k));
      k = 0;
    } else {
      ++k;
    }
  }
  const auto less = [](const Point& p, const Point& q) { return compare(p, q) < 0; };
  std::rotate(points.begin(), std::min_element(points.begin(), points.end(), less), points.end());
  if (less(points.back(), points[1])) std::reverse(points.begin() + 1, points.end());
  std::vector<Vec3> out;
  for (const Point& p : points) out.push_back(rounded_point(p, exponent));
  return out;
}

std::vector<ContactKind> contact_kinds(const Scene& scene, std::span<const TrianglePair> pairs,
                                       unsigned threads) {
  return answers(scene, pairs, threads, contact_kind);
}

std::vector<ContactShape> contact_shapes(const Scene& scene, std::span<const TrianglePair> pairs,
                                         unsigned threads) {
  return answers(scene, pairs, threads, contact_shape);
}

}  // namespace farcull
