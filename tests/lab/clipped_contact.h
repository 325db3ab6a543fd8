// The kind and the common points of two triangles of any shape by clipping alone, as a reference
// for verify/contact.h: one triangle is cut by the half-spaces that bound the other (Sutherland,
// Hodgman: Reentrant polygon clipping, 1974). All numbers are integers, and a point has one
// denominator for its three coordinates, so only the answer is rounded. The corners of the part
// that is left say how the triangles meet.
#pragma once

#include <algorithm>
#include <array>
#include <utility>
#include <vector>

#include "verify/contact.h"
#include "verify/exact.h"
#include "verify/scaled.h"
#include "verify/squared_distance.h"

namespace farcull::clipping {

using Corners = std::array<Vec3, 3>;
using Integers = std::array<mpz_class, 3>;

inline mpz_class dot(const Integers& u, const Integers& v) {
  return u[0] * v[0] + u[1] * v[1] + u[2] * v[2];
}

inline Integers minus(const Integers& u, const Integers& v) {
  return {u[0] - v[0], u[1] - v[1], u[2] - v[2]};
}

inline Integers cross(const Integers& u, const Integers& v) {
  return {u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]};
}

inline bool is_zero(const Integers& u) {
  return sgn(u[0]) == 0 && sgn(u[1]) == 0 && sgn(u[2]) == 0;
}

// ---- points ----

/// The point x / w, in units of a power of two. w > 0. Not in lowest terms.
struct Point {
  Integers x;
  mpz_class w = 1;
};

/// The sign of p - q in the lexicographic order.
inline int compare(const Point& p, const Point& q) {
  for (std::size_t k = 0; k < 3; ++k) {
    const int sign = cmp(p.x[k] * q.w, q.x[k] * p.w);
    if (sign != 0) return sign;
  }
  return 0;
}

/// q - p, times p.w q.w.
inline Integers direction(const Point& p, const Point& q) {
  Integers out;
  for (std::size_t k = 0; k < 3; ++k) out[k] = q.x[k] * p.w - p.x[k] * q.w;
  return out;
}

/// (s p.w p + t q.w q) / (s p.w + t q.w), a point between p and q. Precondition: s, t > 0.
inline Point between(const Point& p, const mpz_class& s, const Point& q, const mpz_class& t) {
  Point out;
  for (std::size_t k = 0; k < 3; ++k) out.x[k] = s * p.x[k] + t * q.x[k];
  out.w = s * p.w + t * q.w;
  return out;
}

/// The corners of the convex hull of t, sorted: three, two or one.
inline std::vector<Vec3> corners_of(const Corners& t) {
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
    for (const Vec3& p : corners_of(t)) {
      const auto whole = [&](int k) { return integer_of(p[k], static_cast<int>(exponent)); };
      corners_.push_back({whole(0), whole(1), whole(2)});
    }
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
inline std::vector<Point> cut(const std::vector<Point>& polygon, const Bound& bound, int sign) {
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
inline std::vector<Point> clipped(const Hull& a, const Hull& b) {
  std::vector<Point> points;
  for (const Integers& x : a.corners()) points.push_back({x});
  for (const Bound& bound : b.bounds()) {
    points = cut(points, bound, 1);
    if (bound.plane) points = cut(points, bound, -1);
  }
  return points;
}

/// Corners of the intersection, sorted, each once.
inline std::vector<Point> common_points(const Hull& a, const Hull& b) {
  std::vector<Point> points = clipped(a, b);
  const auto before = [](const Point& p, const Point& q) { return compare(p, q) < 0; };
  const auto equal = [](const Point& p, const Point& q) { return compare(p, q) == 0; };
  std::sort(points.begin(), points.end(), before);
  points.erase(std::unique(points.begin(), points.end(), equal), points.end());
  return points;
}

/// The dimension of the hull of sorted points. If they lie on one line, the first and the last are
/// its ends.
inline int dimension_of(const std::vector<Point>& points) {
  if (points.size() <= 2) return static_cast<int>(points.size()) - 1;
  const Integers along = direction(points.front(), points.back());
  const bool line = std::all_of(points.begin(), points.end(), [&](const Point& p) {
    return is_zero(cross(along, direction(points.front(), p)));
  });
  return line ? 1 : 2;
}

/// True iff a and b lie in one plane. Precondition: they have two points in common, so two segments
/// lie on one line.
inline bool coplanar(const Hull& a, const Hull& b) {
  if (a.is_triangle()) return a.plane_holds(b);
  return !b.is_triangle() || b.plane_holds(a);
}

inline ContactKind kind_of(const Hull& a, const Hull& b, const std::vector<Point>& common) {
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

inline Vec3 rounded_point(const Point& p, long exponent) {
  const auto nearest = [&](std::size_t k) { return rounded_quotient(p.x[k], p.w, exponent); };
  return {nearest(0), nearest(1), nearest(2)};
}

inline ContactShape contact_shape(const Corners& a, const Corners& b) {
  const long exponent = Scaled(a, b).exponent;
  const Hull s(a, exponent), t(b, exponent);
  const std::vector<Point> common = common_points(s, t);
  ContactShape out{.kind = kind_of(s, t, common), .dimension = dimension_of(common)};
  if (out.dimension == 0 || out.dimension == 1)
    out.ends = {rounded_point(common.front(), exponent), rounded_point(common.back(), exponent)};
  return out;
}

inline std::vector<Vec3> contact_polygon(const Corners& a, const Corners& b) {
  const long exponent = Scaled(a, b).exponent;
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

}  // namespace farcull::clipping
