// Counts the crossings of a ray with the object, and takes the parity. Let a line pass through the
// point x in direction d. The sign of d . ((p - x) x (q - x)) tells on which side of the line an
// edge from p to q passes. If all three edges of a triangle pass on one side, the line crosses the
// triangle; the sign of the determinant of the three corners relative to x tells whether before or
// behind x. Signs are found in doubles, with the bound of filter_scalars.h, or in rationals if that
// leaves a doubt.
#include "verify/inside.h"

#include <gmpxx.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <stdexcept>
#include <tuple>
#include <vector>

#include "core/base/floating_point.h"
#include "core/base/random.h"
#include "verify/closest_features.h"
#include "verify/exact.h"
#include "verify/filter_scalars.h"

namespace farcull {
namespace {

using Corners = std::array<Vec3, 3>;
using Rational = mpq_class;
using Vector = closest::Vector<Rational>;

Vector exact(const Vec3& p) { return {Rational(p[0]), Rational(p[1]), Rational(p[2])}; }

/// The sign of d . (u x v) where u = p - x, v = q - x; if d_is_corner, d is a third corner, and the
/// sign is that of (d - x) . (u x v).
int triple_sign(const Vec3& p, const Vec3& q, const Vec3& x, const Vec3& d, bool d_is_corner) {
  const auto u = filters::difference(p, x), v = filters::difference(q, x);
  const filters::Triple w =
      d_is_corner ? filters::difference(d, x) : filters::Triple{d.x(), d.y(), d.z()};
  const filters::Normal normal = filters::normal_of(u, v);
  const int sign = filters::sign(filters::dot(normal.n, w),
                                 filters::side_bound<FilterBounds>(normal, filters::magnitudes(w)));
  if (sign != 0) return sign;
  const Vector at = exact(x);
  const Vector third = d_is_corner ? closest::minus(exact(d), at) : exact(d);
  return sgn(closest::dot(
      third, closest::cross(closest::minus(exact(p), at), closest::minus(exact(q), at))));
}

enum class Crossing : std::uint8_t { no, yes, unclear };

/// Does the ray from x cross the triangle? unclear: the line of the ray meets an edge, or lies in
/// the triangle's plane. Precondition: x is not on the triangle.
Crossing crossing(const Corners& t, const Vec3& x, const Vec3& d) {
  std::array<int, 3> side{};
  for (int i = 0; i < 3; ++i) side[i] = triple_sign(t[i], t[(i + 1) % 3], x, d, false);
  const auto [least, most] = std::minmax({side[0], side[1], side[2]});
  if (least < 0 && most > 0) return Crossing::no;  // passes by
  if (least == 0 || most == 0) return Crossing::unclear;
  // x + s d is in the plane for s = det / (sum of the three products with the signs `side`).
  return triple_sign(t[0], t[1], x, t[2], true) == side[0] ? Crossing::yes : Crossing::no;
}

const Object& object_of(const Scene& scene, std::uint32_t object, const char* where) {
  if (object >= scene.objects.size())
    throw std::logic_error(std::string(where) + ": the scene has no such object");
  return scene.objects[object];
}

bool on_surface(const Scene& scene, const Object& object, const Vec3& x) {
  const Corners point = {x, x, x};
  for (std::uint32_t k = 0; k < object.triangle_count; ++k) {
    const Corners t = scene.corners(object.first_triangle + k);
    const Vec3 lo = t[0].cwiseMin(t[1]).cwiseMin(t[2]), hi = t[0].cwiseMax(t[1]).cwiseMax(t[2]);
    if ((lo.array() > x.array()).any() || (hi.array() < x.array()).any()) continue;
    if (intersects(point, t)) return true;
  }
  return false;
}

/// Is the number of crossings odd? Empty if a crossing was unclear. If the ray goes along the first
/// axis, boxes show that it misses most triangles. A triangle that is a segment or a point is left
/// out: no ray in general position crosses it, and if x is on its line, all signs are 0 whatever
/// the direction.
std::optional<bool> odd(const Scene& scene, const Object& object, const Vec3& x, const Vec3& d,
                        bool first_axis) {
  bool odd = false;
  for (std::uint32_t k = 0; k < object.triangle_count; ++k) {
    const Corners t = scene.corners(object.first_triangle + k);
    if (first_axis) {
      const Vec3 lo = t[0].cwiseMin(t[1]).cwiseMin(t[2]), hi = t[0].cwiseMax(t[1]).cwiseMax(t[2]);
      if (hi.x() < x.x() || lo.y() > x.y() || hi.y() < x.y() || lo.z() > x.z() || hi.z() < x.z())
        continue;
    }
    const Crossing c = crossing(t, x, d);
    if (c == Crossing::unclear) {
      if (shape(t) != Shape::triangle) continue;
      return std::nullopt;
    }
    odd = odd != (c == Crossing::yes);
  }
  return odd;
}

bool parity(const Scene& scene, const Object& object, const Vec3& x) {
  if (const auto answer = odd(scene, object, x, Vec3(1, 0, 0), true)) return *answer;
  // For each edge of a triangle that is no segment, the directions to avoid lie in a plane. This
  // holds also if x is in the plane of the triangle, but not on it: for all other directions two of
  // the signs are opposite. With 2^52 values per axis each such plane holds at most 2^-52 of all
  // directions, so with 2^34 edges at most one draw in 2^18 is unclear.
  RandomNumbers random(1);
  constexpr int kDraws = 16;
  for (int k = 0; k < kDraws; ++k) {
    Vec3 d;
    for (double& c : d) c = std::round(random.between(-0x1p51, 0x1p51));
    if (const auto answer = odd(scene, object, x, d, false)) return *answer;
  }
  throw std::logic_error("inside: every ray meets an edge");
}

}  // namespace

bool is_closed(const Scene& scene, std::uint32_t object) {
  const Object& o = object_of(scene, object, "is_closed");
  using Place = std::array<double, 3>;
  std::vector<std::array<Place, 2>> edges;
  edges.reserve(3u * o.triangle_count);
  for (std::uint32_t k = 0; k < o.triangle_count; ++k) {
    const Corners t = scene.corners(o.first_triangle + k);
    if (t[0] == t[1] || t[1] == t[2] || t[2] == t[0]) continue;
    std::array<Place, 3> p{};
    for (int i = 0; i < 3; ++i) {
      for (int axis = 0; axis < 3; ++axis) p[i][axis] = t[i][axis] + 0.0;  // no -0.0
    }
    for (int i = 0; i < 3; ++i)
      edges.push_back({std::min(p[i], p[(i + 1) % 3]), std::max(p[i], p[(i + 1) % 3])});
  }
  std::sort(edges.begin(), edges.end());
  for (std::size_t i = 0; i < edges.size(); i += 2) {
    if (i + 1 == edges.size() || edges[i] != edges[i + 1]) return false;
  }
  return true;
}

Inside inside(const Scene& scene, std::uint32_t object, const Vec3& point) {
  return inside(scene, object, point, is_closed(scene, object));
}

Inside inside(const Scene& scene, std::uint32_t object, const Vec3& point, bool closed) {
  const Object& o = object_of(scene, object, "inside");
  const FloatingPointGuard guard;
  if (on_surface(scene, o, point)) return Inside::on;
  if (!closed) return Inside::not_closed;
  return parity(scene, o, point) ? Inside::yes : Inside::no;
}

}  // namespace farcull
