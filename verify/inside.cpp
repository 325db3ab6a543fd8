// Counts the crossings of a ray with the object, each by its direction. Let a line pass through the
// point x in direction d. The sign of d . ((p - x) x (q - x)) tells on which side of the line an
// edge from p to q passes. If all three edges of a triangle pass on one side, the line crosses the
// triangle. The sign of the determinant of the corners relative to x tells whether the crossing is
// ahead of x or behind x. Doubles with the bound of filter_scalars.h decide most signs, rationals
// the others.
#include "verify/inside.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <span>
#include <stdexcept>
#include <vector>

#include "core/base/floating_point.h"
#include "core/base/random.h"
#include "verify/exact.h"
#include "verify/filter_scalars.h"
#include "verify/rational.h"

namespace farcull {
namespace {

using Corners = std::array<Vec3, 3>;
using rational::cross;
using rational::dot;
using rational::exact;
using rational::minus;
using rational::Q3;

/// Returns the sign of d . (u x v) where u = p - x, v = q - x. If d_is_corner, d is a third corner,
/// and the result is the sign of (d - x) . (u x v).
int triple_sign(const Vec3& p, const Vec3& q, const Vec3& x, const Vec3& d, bool d_is_corner) {
  const auto u = filters::difference(p, x), v = filters::difference(q, x);
  const filters::Triple w =
      d_is_corner ? filters::difference(d, x) : filters::Triple{d.x(), d.y(), d.z()};
  const int sign = filters::side_of<FilterBounds>(filters::normal_of(u, v), w);
  if (sign != 0) return sign;
  const Q3 at = exact(x), third = d_is_corner ? minus(exact(d), at) : exact(d);
  return sgn(dot(third, cross(minus(exact(p), at), minus(exact(q), at))));
}

/// Returns 0 if the ray from x in direction d misses the triangle, otherwise 1 or -1 by the side
/// from which the ray comes. Empty if the line of the ray meets an edge or lies in the triangle's
/// plane. Precondition: x is not on the triangle.
std::optional<int> crossing(const Corners& t, const Vec3& x, const Vec3& d) {
  std::array<int, 3> side{};
  for (int i = 0; i < 3; ++i) side[i] = triple_sign(t[i], t[(i + 1) % 3], x, d, false);
  const auto [least, most] = std::minmax({side[0], side[1], side[2]});
  if (least < 0 && most > 0) return 0;  // the line misses the triangle
  if (least == 0 || most == 0) return std::nullopt;
  // The line crosses the plane at x + s d. s is the determinant below, divided by the sum of three
  // products whose signs are `side`.
  return triple_sign(t[0], t[1], x, t[2], true) == side[0] ? side[0] : 0;
}

const Object& object_of(const Scene& scene, std::uint32_t object, const char* where) {
  if (object >= scene.objects.size())
    throw std::logic_error(std::string(where) + ": the scene has no such object");
  return scene.objects[object];
}

bool on_surface(const Scene& scene, const Object& object, const Vec3& x) {
  for (std::uint32_t k = 0; k < object.triangle_count; ++k) {
    const Corners t = scene.corners(object.first_triangle + k);
    const Vec3 lo = t[0].cwiseMin(t[1]).cwiseMin(t[2]), hi = t[0].cwiseMax(t[1]).cwiseMax(t[2]);
    if ((lo.array() > x.array()).any() || (hi.array() < x.array()).any()) continue;
    if (intersects({x, x, x}, t)) return true;
  }
  return false;
}

struct Crossings {
  std::int64_t winding = 0;  // crossings, counted as 1 or -1 by their direction
  bool odd = false;          // true if the number of crossings is odd
};

/// Returns the crossings of a ray; empty if crossing() is empty for a triangle. first_axis: d is
/// (1, 0, 0), so boxes show that the ray misses most triangles. Triangles that are segments or
/// points are left out, since no ray in general position crosses them. (If x is on the line of such
/// a triangle, crossing() is empty for every direction.)
std::optional<Crossings> crossings(const Scene& scene, const Object& object, const Vec3& x,
                                   const Vec3& d, bool first_axis) {
  Crossings out;
  for (std::uint32_t k = 0; k < object.triangle_count; ++k) {
    const Corners t = scene.corners(object.first_triangle + k);
    if (first_axis) {
      const Vec3 lo = t[0].cwiseMin(t[1]).cwiseMin(t[2]), hi = t[0].cwiseMax(t[1]).cwiseMax(t[2]);
      if (hi.x() < x.x() || lo.y() > x.y() || hi.y() < x.y() || lo.z() > x.z() || hi.z() < x.z())
        continue;
    }
    const std::optional<int> c = crossing(t, x, d);
    if (!c) {
      if (shape(t) != Shape::triangle) continue;
      return std::nullopt;
    }
    out.winding += *c;
    out.odd = out.odd != (*c != 0);
  }
  return out;
}

Crossings crossings(const Scene& scene, const Object& object, const Vec3& x) {
  if (const auto answer = crossings(scene, object, x, Vec3(1, 0, 0), true)) return *answer;
  // For each edge of a triangle that is not degenerate, the directions with an empty answer lie in
  // a plane. (This holds for x in the triangle's plane, too: for other directions the signs of two
  // edges are opposite.) With 2^52 values per axis, each plane holds at most 2^-52 of all
  // directions. So with 2^34 edges, at most one random direction in 2^18 has an empty answer.
  RandomNumbers random(1);
  constexpr int kDraws = 16;
  for (int k = 0; k < kDraws; ++k) {
    Vec3 d;
    for (double& c : d) c = std::round(random.between(-0x1p51, 0x1p51));
    if (const auto answer = crossings(scene, object, x, d, false)) return *answer;
  }
  throw std::logic_error("inside: every ray meets an edge");
}

using Place = std::array<double, 3>;
using Places = std::array<Place, 3>;

/// Returns the corners of those triangles of the object that have three different corners.
std::vector<Places> places_of(const Scene& scene, const Object& o) {
  std::vector<Places> out;
  out.reserve(o.triangle_count);
  for (std::uint32_t k = 0; k < o.triangle_count; ++k) {
    const Corners t = scene.corners(o.first_triangle + k);
    if (t[0] == t[1] || t[1] == t[2] || t[2] == t[0]) continue;
    Places& p = out.emplace_back();
    for (int i = 0; i < 3; ++i) {
      for (int axis = 0; axis < 3; ++axis) p[i][axis] = t[i][axis] + 0.0;  // turns -0.0 into 0.0
    }
  }
  return out;
}

struct Edge {
  std::array<Place, 2> ends;  // the lower end first
  bool forward = false;       // true if the edge goes from the lower end to the upper end
  std::uint32_t triangle = 0;
};

/// Calls group(edges) once for each set of edges with the same two ends. Stops at the first call
/// that returns false. Returns true if all calls returned true.
bool each_edge(std::span<const Edge> edges, const auto& group) {
  for (std::size_t i = 0, end = 0; i < edges.size(); i = end) {
    for (end = i; end < edges.size() && edges[end].ends == edges[i].ends; ++end) {
    }
    if (!group(edges.subspan(i, end - i))) return false;
  }
  return true;
}

/// Returns the edges of all triangles, ordered by their ends.
std::vector<Edge> edges_of(const std::vector<Places>& triangles) {
  std::vector<Edge> edges;
  edges.reserve(3 * triangles.size());
  for (std::uint32_t t = 0; t < triangles.size(); ++t) {
    for (int i = 0; i < 3; ++i) {
      const Place &from = triangles[t][i], &to = triangles[t][(i + 1) % 3];
      edges.push_back({{std::min(from, to), std::max(from, to)}, from < to, t});
    }
  }
  std::ranges::sort(edges, {}, &Edge::ends);
  return edges;
}

Surface surface_of(const std::vector<Edge>& edges) {
  bool oriented = true;
  const bool closed = each_edge(edges, [&](std::span<const Edge> of) {
    const auto forward = std::ranges::count(of, true, &Edge::forward);
    oriented = oriented && 2 * static_cast<std::size_t>(forward) == of.size();
    return of.size() % 2 == 0;
  });
  if (!closed) return Surface::open;
  return oriented ? Surface::oriented : Surface::closed;
}

/// Returns false only if two triangles with a common edge are sure to overlap nowhere else.
bool may_be_folded(const Corners& a, const Corners& b) {
  const Vec3 e = a[1] - a[0], f = a[2] - a[0], g = b[2] - a[0];
  const double of_a = e.norm() * f.norm(), of_b = e.norm() * g.norm();
  // `sides` is negative if the triangles lie on different sides of the edge. Its error is less than
  // 30 u of_a of_b, plus underflow. By underflow, products of two lengths above 1e-280 lose far
  // less than 1e-12 of themselves, and the product of four loses less than 1e-290.
  const double sides = e.cross(f).dot(e.cross(g));
  return !(of_a > 1e-280 && of_b > 1e-280 && sides < -(1e-12 * of_a * of_b + 1e-290));
}

/// True if two triangles of one plane pass a common edge in opposite directions and lie on the same
/// side of the edge, as the two sides of a face do. True also if more than 64 triangles have one
/// edge.
bool has_flat_fold(const std::vector<Places>& triangles, const std::vector<Edge>& edges) {
  const auto corners_at = [&](const Edge& edge) {
    const auto point = [](const Place& p) { return Vec3(p[0], p[1], p[2]); };
    const Places& t = triangles[edge.triangle];
    const auto third = std::ranges::find_if(
        t, [&](const Place& p) { return p != edge.ends[0] && p != edge.ends[1]; });
    return Corners{point(edge.ends[0]), point(edge.ends[1]), point(*third)};
  };
  return !each_edge(edges, [&](std::span<const Edge> of) {
    if (of.size() > 64) return false;
    for (std::size_t i = 0; i < of.size(); ++i) {
      for (std::size_t k = i + 1; k < of.size(); ++k) {
        if (of[i].forward == of[k].forward) continue;
        const Corners a = corners_at(of[i]), b = corners_at(of[k]);
        if (may_be_folded(a, b) && intersects_beyond_shared(a, b)) return false;
      }
    }
    return true;
  });
}

}  // namespace

bool is_closed(const Scene& scene, std::uint32_t object) {
  return surface_of(scene, object) != Surface::open;
}

Surface surface_of(const Scene& scene, std::uint32_t object) {
  return surface_of(edges_of(places_of(scene, object_of(scene, object, "surface_of"))));
}

Surface doubted_surface_of(const Scene& scene, std::uint32_t object) {
  std::vector<Places> triangles = places_of(scene, object_of(scene, object, "doubted_surface_of"));
  const std::vector<Edge> edges = edges_of(triangles);
  const Surface out = surface_of(edges);
  if (out == Surface::open) return out;
  const FloatingPointGuard guard;
  const bool folded = out == Surface::oriented && has_flat_fold(triangles, edges);
  // Each triangle with its corners in ascending order, and whether sorting reversed its
  // orientation.
  std::vector<std::pair<Places, bool>> sorted;
  sorted.reserve(triangles.size());
  for (Places& p : triangles) {
    std::ranges::rotate(p, std::ranges::min_element(p));
    const bool turned = p[2] < p[1];
    if (turned) std::swap(p[1], p[2]);
    sorted.emplace_back(p, turned);
  }
  std::ranges::sort(sorted);
  for (std::size_t i = 0, end = 0; i < sorted.size(); i = end) {
    std::int64_t balance = 0;
    for (end = i; end < sorted.size() && sorted[end].first == sorted[i].first; ++end)
      balance += sorted[end].second ? 1 : -1;
    if (end - i > 1 && balance != 0) return Surface::open;
  }
  return folded ? Surface::doubled : out;
}

Inside inside(const Scene& scene, std::uint32_t object, const Vec3& point) {
  return inside(scene, object, point, surface_of(scene, object));
}

Inside inside(const Scene& scene, std::uint32_t object, const Vec3& point, Surface surface) {
  const Object& o = object_of(scene, object, "inside");
  const FloatingPointGuard guard;
  if (on_surface(scene, o, point)) return Inside::on;
  if (surface == Surface::open) return Inside::not_closed;
  const Crossings found = crossings(scene, o, point);
  const bool within = surface == Surface::closed ? found.odd : found.winding != 0;
  return within ? Inside::yes : Inside::no;
}

}  // namespace farcull
