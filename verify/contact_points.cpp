// Computes the points that two triangles share, rounded to the nearest doubles. Numbers with about
// 106 bits and error bounds (verify/wide.h) decide most roundings. Integers decide the other
// roundings. verify/contact_meeting.cpp finds which points to compute.
#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "verify/closest_features.h"
#include "verify/contact_meeting.h"
#include "verify/squared_distance.h"
#include "verify/wide.h"

namespace farcull {
namespace {

using Triangle = std::array<Vec3, 3>;
using Wide = wide::Number<wide::Bounds>;

using closest::cross;
using closest::dot;
using closest::minus;
using closest::Vector;
template <class N>
using SixCorners = std::array<Vector<N>, 6>;

/// Returns a normal of the plane through the three corners `of`. If axis >= 0, returns a normal of
/// the plane through the first two of these corners, parallel to the axis.
template <class N>
Vector<N> normal_of(const SixCorners<N>& corners, const std::array<int, 3>& of, int axis = -1) {
  Vector<N> second = {N(0), N(0), N(0)};
  if (axis >= 0) {
    second[axis] = N(1);
  } else {
    second = minus(corners[of[2]], corners[of[0]]);
  }
  return cross(minus(corners[of[1]], corners[of[0]]), second);
}

/// The point x / w.
template <class N>
struct Quotient {
  Vector<N> x;
  N w;
};

/// Returns the point of a place. Let p and q be the ends of its edge, and s and t the scalar
/// products of the plane's normal with p - origin and q - origin; the origin is in the plane. s and
/// t differ in sign. The point is (q s - p t) / (s - t).
template <class N>
Quotient<N> located(const SixCorners<N>& corners, const Place& place) {
  const Vector<N>&p = corners[place.from], &q = corners[place.to];
  if (place.from == place.to) return {p, N(1)};
  const Vector<N> normal = normal_of(corners, place.other, place.axis);
  const Vector<N>& origin = corners[place.other[0]];
  const N s = dot(normal, minus(p, origin)), t = dot(normal, minus(q, origin));
  Quotient<N> out;
  for (int k = 0; k < 3; ++k) out.x[k] = q[k] * s - p[k] * t;
  out.w = s - t;
  return out;
}

// InWideNumbers and InIntegers have the same functions: at() finds the point at a place, rounded()
// rounds a point to doubles, compare() compares two points. An empty result means that rounding
// errors leave a doubt.

class InWideNumbers {
 public:
  using Point = Vector<Wide>;

  InWideNumbers(const Triangle& a, const Triangle& b, bool planes_differ)
      : planes_differ_(planes_differ) {
    for (int i = 0; i < 3; ++i) {
      for (int k = 0; k < 3; ++k) {
        corners_[i][k] = a[i][k];
        corners_[3 + i][k] = b[i][k];
        for (const double x : {std::abs(a[i][k]), std::abs(b[i][k])})
          fits_ = fits_ && (x == 0 || (x >= wide::kLeast && x <= wide::kMost));
      }
    }
  }

  std::optional<Point> at(const Place& place) const {
    const Vector<Wide>&p = corners_[place.from], &q = corners_[place.to];
    Point out;
    std::optional<Quotient<Wide>> quotient;
    for (int k = 0; k < 3; ++k) {
      const auto is = [&](int corner, double x) { return corners_[corner][k].hi == x; };
      const auto [i, j, l] = place.other;
      const double fixed = corners_[i][k].hi;
      if (p[k].hi == q[k].hi) {  // the coordinate is constant along the edge
        out[k] = p[k];
      } else if (is(j, fixed) && is(l, fixed)) {  // all corners `other` have this coordinate
        out[k] = fixed;
      } else {
        if (!fits_) return std::nullopt;
        if (!quotient) quotient = located(corners_, place);
        out[k] = quotient->x[k] / quotient->w;
      }
    }
    return out;
  }

  static std::optional<Vec3> rounded(const Point& p) {
    const auto x = wide::nearest(p[0]), y = wide::nearest(p[1]), z = wide::nearest(p[2]);
    if (!x || !y || !z) return std::nullopt;
    return Vec3(*x, *y, *z);
  }

  /// Returns the sign of p - q in the lexicographic order. Precondition: rounded() is not empty for
  /// p and for q.
  std::optional<int> compare(const Point& p, const Point& q) const {
    for (int k = 0; k < 3; ++k) {
      // `hi` is the rounded coordinate. Rounding is monotone, so different values decide.
      if (p[k].hi != q[k].hi) return p[k].hi < q[k].hi ? -1 : 1;
      const Wide difference = p[k] - q[k];
      if (std::abs(difference.hi) > std::abs(difference.lo) + difference.error)
        return difference.hi < 0 ? -1 : 1;
      if (!difference.is_zero() && !is_constant(k)) return std::nullopt;
    }
    return 0;
  }

 private:
  /// True only if coordinate k is constant along the common line of the triangles' planes.
  bool is_constant(int k) const {
    if (!planes_differ_ || !fits_) return false;
    return cross(normal_of(corners_, {0, 1, 2}), normal_of(corners_, {3, 4, 5}))[k].is_zero();
  }

  SixCorners<Wide> corners_;
  bool fits_ = true;
  bool planes_differ_;
};

class InIntegers {
 public:
  using Point = Quotient<mpz_class>;

  InIntegers(const Triangle& a, const Triangle& b) {
    const Scaled scaled(a, b);
    std::copy(scaled.a.begin(), scaled.a.end(), corners_.begin());
    std::copy(scaled.b.begin(), scaled.b.end(), corners_.begin() + 3);
    exponent_ = scaled.exponent;
  }

  std::optional<Point> at(const Place& place) const {
    Point out = located(corners_, place);
    if (out.w > 0) return out;
    return Point{{-out.x[0], -out.x[1], -out.x[2]}, -out.w};
  }

  std::optional<Vec3> rounded(const Point& p) const { return rounded_point(p.x, p.w, exponent_); }

  static std::optional<int> compare(const Point& p, const Point& q) {
    for (int k = 0; k < 3; ++k) {
      if (const int sign = cmp(p.x[k] * q.w, q.x[k] * p.w); sign != 0) return sign;
    }
    return 0;
  }

 private:
  SixCorners<mpz_class> corners_;
  int exponent_ = 0;
};

/// Returns the ends of a common segment in the order of compare(); or a common point, twice.
template <class Arithmetic>
std::optional<std::array<Vec3, 2>> ends_of(const Arithmetic& arithmetic, const Meeting& meeting) {
  const auto p = arithmetic.at(meeting.places[0]),
             q = arithmetic.at(meeting.places[meeting.count - 1]);
  if (!p || !q) return std::nullopt;
  const std::optional<Vec3> first = arithmetic.rounded(*p), second = arithmetic.rounded(*q);
  if (!first || !second) return std::nullopt;
  if (*first == *second) return std::array{*first, *second};
  const std::optional<int> sign = arithmetic.compare(*p, *q);
  if (!sign) return std::nullopt;
  return *sign < 0 ? std::array{*first, *second} : std::array{*second, *first};
}

/// Returns the corners of a polygon in the order of contact_polygon(). Each side is on the line of
/// an edge of a triangle. So two corners are adjacent iff both are on the line of one edge.
template <class Arithmetic>
std::optional<std::vector<Vec3>> polygon_of(const Arithmetic& arithmetic, const Meeting& meeting) {
  const int count = meeting.count;
  std::vector<typename Arithmetic::Point> points;
  std::vector<Vec3> rounded;
  for (int k = 0; k < count; ++k) {
    const auto p = arithmetic.at(meeting.places[k]);
    if (!p) return std::nullopt;
    const std::optional<Vec3> x = arithmetic.rounded(*p);
    if (!x) return std::nullopt;
    points.push_back(*p);
    rounded.push_back(*x);
  }
  int lowest = 0;
  for (int k = 1; k < count; ++k) {
    const std::optional<int> sign = arithmetic.compare(points[k], points[lowest]);
    if (!sign) return std::nullopt;
    if (*sign < 0) lowest = k;
  }
  const auto beside = [&](int k, int other) {
    int out = 0;
    while (out == k || out == other || (meeting.places[out].lines & meeting.places[k].lines) == 0)
      ++out;
    return out;
  };
  int next = beside(lowest, -1);
  const int last = beside(lowest, next);
  const std::optional<int> sign = arithmetic.compare(points[next], points[last]);
  if (!sign) return std::nullopt;
  if (*sign > 0) next = last;
  std::vector<Vec3> out = {rounded[lowest]};
  for (int before = lowest; next != lowest;) {
    out.push_back(rounded[next]);
    before = std::exchange(next, beside(next, before));
  }
  return out;
}

}  // namespace

ContactShape contact_shape(const Triangle& a, const Triangle& b) {
  const std::optional<Meeting> meeting = meeting_of(a, b, true);
  if (!meeting) return contact_shape_of_segments(a, b);
  ContactShape out{.kind = meeting->kind, .dimension = meeting->dimension};
  if (out.dimension != 0 && out.dimension != 1) return out;
  const bool planes_differ = out.kind != ContactKind::coplanar;
  const auto ends = ends_of(InWideNumbers(a, b, planes_differ), *meeting);
  out.ends = ends ? *ends : *ends_of(InIntegers(a, b), *meeting);
  return out;
}

std::vector<Vec3> contact_polygon(const Triangle& a, const Triangle& b) {
  const std::optional<Meeting> meeting = meeting_of(a, b, true);
  if (!meeting || meeting->dimension != 2) return {};
  const auto corners = polygon_of(InWideNumbers(a, b, false), *meeting);
  return corners ? *corners : *polygon_of(InIntegers(a, b), *meeting);
}

}  // namespace farcull
