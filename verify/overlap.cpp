// Looks for a plane that divides the objects. If none is found, cuts triangles with contacts into
// convex pieces, and counts crossings of rays that leave each piece along an axis.
#include "verify/overlap.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <optional>
#include <vector>

#include "core/base/floating_point.h"
#include "core/base/random.h"
#include "verify/exact.h"
#include "verify/filter_scalars.h"
#include "verify/rational.h"

namespace farcull {
namespace {

using rational::cross;
using rational::dot;
using rational::exact;
using rational::minus;
using rational::Q;
using rational::Q3;
using Corners = std::array<Vec3, 3>;

constexpr std::size_t kMostPlanes = 64;    // planes of at most this many triangles are tried
constexpr std::size_t kMostPieces = 2048;  // at most this many pieces of a triangle
// At most this many tests of a piece with a triangle are made, which takes about two seconds.
constexpr std::size_t kMostTests = std::size_t{1} << 31;

/// The points p with normal . p = offset.
struct Plane {
  Q3 normal;
  Q offset;
  Plane(const Q3& n, const Q3& at) : normal(n), offset(dot(n, at)) {}
  int side(const Q3& p) const { return cmp(dot(normal, p), offset); }
};

Plane plane_of(const Corners& t) {
  const Q3 at = exact(t[0]);
  return {cross(minus(exact(t[1]), at), minus(exact(t[2]), at)), at};
}

/// Returns the side of the plane of t that p is on: -1, 0 or 1.
int side_of(const Corners& t, const Vec3& p) {
  const filters::Normal n =
      filters::normal_of(filters::difference(t[1], t[0]), filters::difference(t[2], t[0]));
  const int sign = filters::side_of<FilterBounds>(n, filters::difference(p, t[0]));
  return sign != 0 ? sign : plane_of(t).side(exact(p));
}

void for_triangles(const Scene& scene, std::uint32_t object, const auto& visit) {
  const Object& o = scene.objects[object];
  for (std::uint32_t k = 0; k < o.triangle_count; ++k) visit(scene.corners(o.first_triangle + k));
}

Box box_of(const Corners& t) {
  return {t[0].cwiseMin(t[1]).cwiseMin(t[2]), t[0].cwiseMax(t[1]).cwiseMax(t[2])};
}

/// Returns the sides of the plane of t on which the object has corners: bit 0 below, bit 1 above.
unsigned sides_of(const Scene& scene, std::uint32_t object, const Corners& t) {
  const Object& o = scene.objects[object];
  unsigned sides = 0;
  for (std::uint32_t k = 0; k < o.triangle_count && sides != 3; ++k) {
    for (const Vec3& p : scene.corners(o.first_triangle + k)) {
      const int side = side_of(t, p);
      if (side != 0) sides |= side < 0 ? 1u : 2u;
    }
  }
  return sides;
}

using Polygon = std::vector<Q3>;  // convex

/// Divides each polygon that has corners on both sides of the plane.
void cut(std::vector<Polygon>& pieces, const Plane& plane) {
  const std::size_t count = pieces.size();
  for (std::size_t i = 0; i < count; ++i) {
    const Polygon whole = pieces[i];
    std::vector<Q> height;
    bool above = false, below = false;
    for (const Q3& p : whole) {
      height.push_back(dot(plane.normal, p) - plane.offset);
      above = above || height.back() > 0;
      below = below || height.back() < 0;
    }
    if (!above || !below) continue;
    Polygon upper, lower;
    for (std::size_t k = 0; k < whole.size(); ++k) {
      const std::size_t next = (k + 1) % whole.size();
      if (height[k] >= 0) upper.push_back(whole[k]);
      if (height[k] <= 0) lower.push_back(whole[k]);
      if (sgn(height[k]) * sgn(height[next]) >= 0) continue;
      const Q3 at =
          rational::between(whole[k], whole[next], height[k] / (height[k] - height[next]));
      upper.push_back(at);
      lower.push_back(at);
    }
    pieces[i] = std::move(upper);
    pieces.push_back(std::move(lower));
  }
}

/// Cuts pieces of t by the triangle `other`, which meets t: along the plane of `other`, or along
/// the lines of its edges if `other` lies in the plane of t.
void cut_by(std::vector<Polygon>& pieces, const Plane& of_t, const Corners& other) {
  if (shape(other) != Shape::triangle) return;  // a segment or point does not divide a triangle
  const bool flat =
      std::ranges::all_of(other, [&](const Vec3& p) { return of_t.side(exact(p)) == 0; });
  if (!flat) return cut(pieces, plane_of(other));
  for (int i = 0; i < 3; ++i) {
    const Q3 p = exact(other[i]);
    cut(pieces, Plane(cross(of_t.normal, minus(exact(other[(i + 1) % 3]), p)), p));
  }
}

/// Returns a point inside the polygon. The weights of the corners are random, so the point hardly
/// ever lies on a given line.
Q3 point_inside(const Polygon& polygon, RandomNumbers& random) {
  Q3 sum = {0, 0, 0};
  Q total = 0;
  for (const Q3& p : polygon) {
    const Q weight = static_cast<unsigned long>(1 + random.below(1000003));
    total += weight;
    for (int k = 0; k < 3; ++k) sum[k] += weight * p[k];
  }
  for (Q& x : sum) x /= total;
  return sum;
}

/// Whether the places just below ([0]) and just above ([1]) a point of a plane, along an axis, are
/// inside an object. overlap.h explains the two rules that decide this.
struct Sides {
  std::array<bool, 2> perhaps{};  // at least one rule says yes
  std::array<bool, 2> inside{};   // both rules say yes
};

/// Returns the sides of p. Empty if the line through p along the axis meets an edge, or if a
/// triangle that is not in the plane contains p.
std::optional<Sides> sides_of(const Scene& scene, std::uint32_t object, const Plane& plane,
                              const Q3& p, int axis) {
  const int u = (axis + 1) % 3, v = (axis + 2) % 3;
  // get_d() truncates, so the exact coordinate lies between the doubles next to pu (or pv).
  const double pu = p[u].get_d(), pv = p[v].get_d();
  const auto below = [](double x) { return std::nextafter(x, -HUGE_VAL); };
  const auto above = [](double x) { return std::nextafter(x, HUGE_VAL); };
  const double u_lo = below(pu), u_hi = above(pu), v_lo = below(pv), v_hi = above(pv);
  std::array<long, 2> crossings = {0, 0}, winding = {0, 0};
  const Object& o = scene.objects[object];
  for (std::uint32_t k = 0; k < o.triangle_count; ++k) {
    const Corners t = scene.corners(o.first_triangle + k);
    const auto [u0, u1] = std::minmax({t[0][u], t[1][u], t[2][u]});
    const auto [v0, v1] = std::minmax({t[0][v], t[1][v], t[2][v]});
    if (u1 < u_lo || u0 > u_hi || v1 < v_lo || v0 > v_hi) continue;
    std::array<Q3, 3> corner;
    for (int i = 0; i < 3; ++i) corner[i] = exact(t[i]);
    std::array<int, 3> side{};
    for (int i = 0; i < 3; ++i) {
      const Q3 &a = corner[i], &b = corner[(i + 1) % 3];
      side[i] = sgn(Q((b[u] - a[u]) * (p[v] - a[v]) - (b[v] - a[v]) * (p[u] - a[u])));
    }
    const auto [least, most] = std::minmax({side[0], side[1], side[2]});
    if (least < 0 && most > 0) continue;  // the line misses t
    if (least == 0 || most == 0) {
      if (shape(t) != Shape::triangle) continue;  // no ray in general position crosses it
      return std::nullopt;
    }
    const Plane of_t = plane_of(t);
    const int height = of_t.side(p) * sgn(of_t.normal[axis]);  // > 0: p is above t
    if (height == 0) {
      for (const Q3& c : corner) {
        if (plane.side(c) != 0) return std::nullopt;
      }
      continue;  // t is in the plane, which the rays leave
    }
    const std::size_t to = height < 0 ? 1 : 0;
    ++crossings[to];
    winding[to] += side[0];
  }
  Sides out;
  for (std::size_t to = 0; to < 2; ++to) {
    const bool odd = crossings[to] % 2 != 0, wound = winding[to] != 0;
    out.perhaps[to] = odd || wound;
    out.inside[to] = odd && wound;
  }
  return out;
}

/// True if one of the six rays along the axes from the point meets no triangle of the object. A ray
/// that may meet an edge counts as meeting a triangle.
bool sees_out(const Scene& scene, std::uint32_t object, const Vec3& point) {
  const Q3 p = exact(point);
  unsigned free = 0x3f;  // bits 2 k and 2 k + 1: rays forward and backward along axis k are free
  for_triangles(scene, object, [&](const Corners& t) {
    const Box box = box_of(t);
    for (int axis = 0; axis < 3; ++axis) {
      const unsigned ways =
          (box.hi[axis] >= point[axis] ? 1u : 0u) | (box.lo[axis] <= point[axis] ? 2u : 0u);
      if ((free >> 2 * axis & ways) == 0) continue;
      const int u = (axis + 1) % 3, v = (axis + 2) % 3;
      if (point[u] < box.lo[u] || point[u] > box.hi[u] || point[v] < box.lo[v] ||
          point[v] > box.hi[v])
        continue;
      bool left = false, right = false;
      for (int i = 0; i < 3; ++i) {
        const Q3 a = exact(t[i]), b = exact(t[(i + 1) % 3]);
        const int side = sgn(Q((b[u] - a[u]) * (p[v] - a[v]) - (b[v] - a[v]) * (p[u] - a[u])));
        left = left || side > 0;
        right = right || side < 0;
      }
      if (!left || !right) free &= ~(ways << 2 * axis);
    }
  });
  return free != 0;
}

class PieceTest {
 public:
  PieceTest(const Scene& scene, ObjectPair objects)
      : scene_(scene),
        objects_(objects),
        triangles_(scene.objects[objects.a].triangle_count +
                   std::size_t{scene.objects[objects.b].triangle_count}) {}

  /// Returns whether pieces of triangle t of object `own` prove that `own` overlaps the other
  /// object. others: the triangles of the other object that meet t.
  Overlap test(std::uint32_t own, std::uint32_t t, std::span<const std::uint32_t> others) {
    const Corners corners = scene_.corners(t);
    if (shape(corners) != Shape::triangle) return Overlap::unknown;
    const Plane plane = plane_of(corners);
    std::vector<Polygon> pieces = {{exact(corners[0]), exact(corners[1]), exact(corners[2])}};
    for (const std::uint32_t other : others) {
      cut_by(pieces, plane, scene_.corners(other));
      if (pieces.size() > kMostPieces) return Overlap::unknown;
    }
    // Triangles of t's own object also cut t: beyond a cut, the inside may lie on the other side.
    const Box box = box_of(corners);
    for_triangles(scene_, own, [&](const Corners& other) {
      if (pieces.size() > kMostPieces || !overlap(box, box_of(other))) return;
      if (other != corners && intersects_beyond_shared(corners, other))
        cut_by(pieces, plane, other);
    });
    tests_ += pieces.size() * triangles_;
    if (pieces.size() > kMostPieces || tests_ > kMostTests) return Overlap::unknown;
    int axis = 0;
    for (int k = 1; k < 3; ++k) {
      if (abs(plane.normal[k]) > abs(plane.normal[axis])) axis = k;
    }
    for (const Polygon& piece : pieces) {
      const Overlap answer = test(own == objects_.a, plane, piece, axis);
      if (answer != Overlap::no) return answer;
    }
    return Overlap::no;
  }

 private:
  Overlap test(bool of_a, const Plane& plane, const Polygon& piece, int axis) {
    constexpr int kDraws = 8;
    for (int draw = 0; draw < kDraws; ++draw) {
      const Q3 p = point_inside(piece, random_);
      const std::optional<Sides> a = sides_of(scene_, objects_.a, plane, p, axis);
      if (!a) continue;
      const std::optional<Sides> b = sides_of(scene_, objects_.b, plane, p, axis);
      if (!b) continue;
      Overlap out = Overlap::no;
      for (std::size_t side = 0; side < 2; ++side) {
        if (a->inside[side] && b->inside[side]) return Overlap::yes;
        if (a->perhaps[side] && b->perhaps[side]) out = Overlap::unknown;
      }
      const Sides &own = of_a ? *a : *b, &other = of_a ? *b : *a;
      if (!own.perhaps[0] && !own.perhaps[1] && other.perhaps[0] && other.perhaps[1])
        out = Overlap::unknown;  // the surface around the piece may be inside the other object
      return out;
    }
    return Overlap::unknown;
  }

  const Scene& scene_;
  ObjectPair objects_;
  RandomNumbers random_{1};
  std::size_t triangles_;  // number of triangles of both objects
  std::size_t tests_ = 0;
};

}  // namespace

bool plane_divides(const Scene& scene, ObjectPair objects, std::span<const TrianglePair> contacts) {
  const FloatingPointGuard guard;
  Box a = Box::empty(), b = Box::empty();
  for_triangles(scene, objects.a, [&](const Corners& t) { a.add(box_of(t)); });
  for_triangles(scene, objects.b, [&](const Corners& t) { b.add(box_of(t)); });
  for (int axis = 0; axis < 3; ++axis) {
    if (a.hi[axis] <= b.lo[axis] || b.hi[axis] <= a.lo[axis]) return true;
  }
  std::vector<std::uint32_t> triangles;
  for (const TrianglePair& pair : contacts) {
    for (const std::uint32_t t : {pair.a, pair.b}) {
      if (triangles.size() < kMostPlanes && std::ranges::find(triangles, t) == triangles.end())
        triangles.push_back(t);
    }
  }
  return std::ranges::any_of(triangles, [&](std::uint32_t t) {
    const Corners corners = scene.corners(t);
    if (shape(corners) != Shape::triangle) return false;
    const unsigned of_a = sides_of(scene, objects.a, corners);
    if (of_a == 3) return false;
    const unsigned of_b = sides_of(scene, objects.b, corners);
    return ((of_a & 1) == 0 && (of_b & 2) == 0) || ((of_a & 2) == 0 && (of_b & 1) == 0);
  });
}

Overlap overlap_at(const Scene& scene, std::uint32_t object, const Vec3& point, Surface surface) {
  if (inside(scene, object, point, surface) == Inside::yes) return Overlap::yes;
  return surface == Surface::oriented || sees_out(scene, object, point) ? Overlap::no
                                                                        : Overlap::unknown;
}

Overlap overlap_of_touching(const Scene& scene, ObjectPair objects,
                            std::span<const TrianglePair> contacts, std::span<const Vec3> parts_a,
                            std::span<const Vec3> parts_b, std::array<Surface, 2> surfaces) {
  const FloatingPointGuard guard;
  if (plane_divides(scene, objects, contacts)) return Overlap::no;
  for (const Surface surface : surfaces) {
    if (surface == Surface::open || surface == Surface::doubled) return Overlap::unknown;
  }
  PieceTest test(scene, objects);
  std::vector<TrianglePair> sorted(contacts.begin(), contacts.end());
  for (const bool second : {false, true}) {
    if (second) {
      for (TrianglePair& pair : sorted) std::swap(pair.a, pair.b);
    }
    std::ranges::sort(sorted);
    for (std::size_t k = 0; k < sorted.size();) {
      std::vector<std::uint32_t> others;
      const std::uint32_t t = sorted[k].a;
      for (; k < sorted.size() && sorted[k].a == t; ++k) others.push_back(sorted[k].b);
      const Overlap answer = test.test(second ? objects.b : objects.a, t, others);
      if (answer != Overlap::no) return answer;
    }
  }
  // A point on the other object's surface decides nothing; the pieces decide there.
  Overlap out = Overlap::no;
  for (const bool second : {false, true}) {
    for (const Vec3& point : second ? parts_b : parts_a) {
      const Overlap here =
          overlap_at(scene, second ? objects.a : objects.b, point, surfaces[second ? 0 : 1]);
      if (here == Overlap::yes) return here;
      if (here == Overlap::unknown) out = here;
    }
  }
  return out;
}

}  // namespace farcull
