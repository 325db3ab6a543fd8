// Reference answers for the tests of verify/: slow, exact, and written apart from what they test
// (integers, no CGAL).
#pragma once

#include <gmpxx.h>
#include "tests/lab/standard.h"

namespace farcull::reference {

using Triangle = std::array<Vec3, 3>;

constexpr double kTiny = std::numeric_limits<double>::denorm_min();
constexpr double kMax = std::numeric_limits<double>::max();
constexpr std::array<std::array<int, 3>, 6> kPermutations = {
    {{0, 1, 2}, {0, 2, 1}, {1, 0, 2}, {1, 2, 0}, {2, 0, 1}, {2, 1, 0}}};

inline Triangle reordered(const Triangle& t, const std::array<int, 3>& order) {
  return {t[order[0]], t[order[1]], t[order[2]]};
}

/// The corners of a pair that fails, all bits of them.
inline std::string text(const Triangle& a, const Triangle& b) {
  std::ostringstream out;
  out << std::hexfloat;
  for (const Triangle& t : {a, b})
    for (const Vec3& p : t) out << p.x() << ' ' << p.y() << ' ' << p.z() << "; ";
  return out.str();
}

template <typename Integer>
using Vector = std::array<Integer, 3>;

template <typename Integer>
Vector<Integer> minus(const Vector<Integer>& a, const Vector<Integer>& b) {
  return {Integer(a[0] - b[0]), Integer(a[1] - b[1]), Integer(a[2] - b[2])};
}

template <typename Integer>
Integer dot(const Vector<Integer>& a, const Vector<Integer>& b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

template <typename Integer>
Vector<Integer> cross(const Vector<Integer>& a, const Vector<Integer>& b) {
  return {Integer(a[1] * b[2] - a[2] * b[1]), Integer(a[2] * b[0] - a[0] * b[2]),
          Integer(a[0] * b[1] - a[1] * b[0])};
}

/// The gap of the projections onto d, times its length; negative or 0 where there is none. The zero
/// direction has none.
template <typename Integer>
Integer gap(const std::array<Vector<Integer>, 3>& a, const std::array<Vector<Integer>, 3>& b,
            const Vector<Integer>& d) {
  const std::array<Integer, 3> s = {dot(d, a[0]), dot(d, a[1]), dot(d, a[2])};
  const std::array<Integer, 3> t = {dot(d, b[0]), dot(d, b[1]), dot(d, b[2])};
  const auto [s_lo, s_hi] = std::minmax_element(s.begin(), s.end());
  const auto [t_lo, t_hi] = std::minmax_element(t.begin(), t.end());
  return *s_hi < *t_lo ? Integer(*t_lo - *s_hi) : Integer(*s_lo - *t_hi);
}

/// Whether visit(d) holds of a direction along which two triangles (or the segments or points that
/// they are) can be as far apart as they are. Disjoint compact convex sets have two closest points.
/// Along the direction between them the gap of the projections is their distance, along no
/// direction more; it depends only on the features the two points lie inside: corner and corner,
/// corner and edge, corner and face, edge and edge. All such directions are tried: 2 + 9 + 18 + 9.
template <typename Integer, typename Visit>
bool any_direction(const std::array<Vector<Integer>, 3>& a, const std::array<Vector<Integer>, 3>& b,
                   const Visit& visit) {
  const auto edge = [](const auto& t, int i) { return minus(t[(i + 1) % 3], t[i]); };
  if (visit(cross(edge(a, 0), edge(a, 1)))) return true;
  if (visit(cross(edge(b, 0), edge(b, 1)))) return true;
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) {
      const Vector<Integer> between = minus(b[j], a[i]);
      if (visit(between) || visit(cross(edge(a, i), edge(b, j)))) return true;
      for (const Vector<Integer>& e : {edge(a, i), edge(b, j)}) {
        // The part of the corner's offset from the edge's line that is perpendicular to it, times
        // |e|^2. The offset from corner i of a to corner j of b serves both: it is from b[j] to a's
        // edge i and from a[i] to b's edge j.
        const Integer ee = dot(e, e), be = dot(between, e);
        const Vector<Integer> d = {Integer(between[0] * ee - e[0] * be),
                                   Integer(between[1] * ee - e[1] * be),
                                   Integer(between[2] * ee - e[2] * be)};
        if (visit(d)) return true;
      }
    }
  }
  return false;
}

/// True iff two closed triangles are farther apart than the clearance; with 0, iff they are
/// disjoint.
template <typename Integer>
bool separated(const std::array<Vector<Integer>, 3>& a, const std::array<Vector<Integer>, 3>& b,
               const Integer& clearance = 0) {
  return any_direction(a, b, [&](const Vector<Integer>& d) {
    const Integer between = gap(a, b, d);
    if (clearance == 0) return between > 0;
    return between > 0 && between * between > clearance * clearance * dot(d, d);
  });
}

inline bool small_integers(const Triangle& t) {
  return std::ranges::all_of(t, [](const Vec3& p) {
    return (p.array() == p.array().round()).all() && (p.array().abs() <= 64).all();
  });
}

template <typename Convert>
auto converted(const Triangle& t, Convert convert) {
  using Integer = decltype(convert(0.0));
  std::array<Vector<Integer>, 3> result;
  for (int i = 0; i < 3; ++i)
    for (int axis = 0; axis < 3; ++axis) result[i][axis] = convert(t[i][axis]);
  return result;
}

/// x 2^1074, which is an integer for every finite double.
inline mpz_class scaled(double x) {
  int exponent = 0;
  mpz_class mantissa(
      std::ldexp(std::frexp(x, &exponent), 53));  // an integer; x = mantissa * 2^(exponent - 53)
  const int shift = exponent - 53 + 1074;
  // A subnormal has trailing zeros enough for the shift to the right to be exact.
  return shift >= 0 ? mpz_class(mantissa << shift) : mpz_class(mantissa >> -shift);
}

/// The reference for farcull::intersects: machine integers where coordinates are small integers
/// (degree 4, so below 2^40), else GMP integers after scaling both by 2^1074, which makes every
/// finite double an integer.
inline bool intersects(const Triangle& a, const Triangle& b) {
  if (small_integers(a) && small_integers(b)) {
    const auto convert = [](double x) { return static_cast<std::int64_t>(x); };
    return !separated(converted(a, convert), converted(b, convert));
  }
  return !separated(converted(a, scaled), converted(b, scaled));
}

/// The reference for farcull::within.
inline bool within(const Triangle& a, const Triangle& b, double clearance) {
  if (clearance == 0) return intersects(a, b);
  return !separated(converted(a, scaled), converted(b, scaled), scaled(clearance));
}

using Rational = mpq_class;
using RationalPoint = Vector<Rational>;
using RationalTriangle = std::array<RationalPoint, 3>;

inline bool is_zero(const RationalPoint& p) { return p[0] == 0 && p[1] == 0 && p[2] == 0; }

/// True iff p lies in the closed hull of the corners, whatever its dimension.
inline bool lies_in(const RationalPoint& p, const RationalTriangle& t) {
  const RationalPoint n = cross(minus(t[1], t[0]), minus(t[2], t[0]));
  if (!is_zero(n)) {
    if (dot(n, minus(p, t[0])) != 0) return false;
    for (int i = 0; i < 3; ++i)
      if (dot(n, cross(minus(t[(i + 1) % 3], t[i]), minus(p, t[i]))) < 0) return false;
    return true;
  }
  for (int i = 0; i < 3; ++i) {  // on an edge: the offsets from its ends are opposite
    const RationalPoint u = minus(p, t[i]);
    const RationalPoint v = minus(p, t[(i + 1) % 3]);
    if (is_zero(cross(u, v)) && dot(u, v) <= 0) return true;
  }
  return false;
}

/// The reference for farcull::intersects_beyond_shared. The intersection is the hull of those of 21
/// points that lie in both (docs/certificate.md): corners, edges with planes, edges with edges. It
/// lies in the shared part, which is convex unless all three corners of a real triangle are shared,
/// iff they do.
inline bool intersects_beyond_shared(const Triangle& a, const Triangle& b) {
  const auto exact = [](double x) { return Rational(x); };
  const RationalTriangle s = converted(a, exact);
  const RationalTriangle t = converted(b, exact);
  std::vector<RationalPoint> shared;
  for (const RationalPoint& p : s)
    if (std::ranges::find(t, p) != t.end() && std::ranges::find(shared, p) == shared.end())
      shared.push_back(p);
  if (shared.empty()) return intersects(a, b);
  const RationalTriangle part = {shared.front(), shared[shared.size() / 2], shared.back()};
  if (shared.size() == 3 && !is_zero(cross(minus(s[1], s[0]), minus(s[2], s[0])))) return true;

  const auto beyond = [&](const RationalPoint& p) {
    return lies_in(p, s) && lies_in(p, t) && !lies_in(p, part);
  };
  const auto along = [](const RationalPoint& p, const RationalPoint& u, const Rational& x) {
    return RationalPoint{Rational(p[0] + u[0] * x), Rational(p[1] + u[1] * x),
                         Rational(p[2] + u[2] * x)};
  };
  for (const auto& [x, y] : {std::pair(s, t), std::pair(t, s)}) {
    const RationalPoint n = cross(minus(y[1], y[0]), minus(y[2], y[0]));
    for (int i = 0; i < 3; ++i) {
      if (beyond(x[i])) return true;
      const RationalPoint u = minus(x[(i + 1) % 3], x[i]);
      const Rational slope = dot(n, u);
      if (slope != 0 && beyond(along(x[i], u, Rational(dot(n, minus(y[0], x[i])) / slope))))
        return true;
      for (int j = 0; j < 3; ++j) {
        const RationalPoint v = minus(y[(j + 1) % 3], y[j]);
        const RationalPoint c = cross(u, v);
        if (is_zero(c)) continue;
        const Rational at = dot(cross(minus(y[j], x[i]), v), c) / dot(c, c);
        if (beyond(along(x[i], u, at))) return true;
      }
    }
  }
  return false;
}

inline bool share_position(const Triangle& a, const Triangle& b) {
  return std::ranges::any_of(a, [&](const Vec3& p) { return std::ranges::find(b, p) != b.end(); });
}

/// Not farther apart than the clearance along any axis, by differences in double.
inline bool boxes_overlap(const Triangle& a, const Triangle& b, double clearance = 0) {
  for (int axis = 0; axis < 3; ++axis) {
    const auto [a_lo, a_hi] = std::minmax({a[0][axis], a[1][axis], a[2][axis]});
    const auto [b_lo, b_hi] = std::minmax({b[0][axis], b[1][axis], b[2][axis]});
    if (b_lo - a_hi > clearance || a_lo - b_hi > clearance) return false;
  }
  return true;
}

/// One object per list of triangles, without shared vertices.
inline Scene scene_of(const std::vector<std::vector<Triangle>>& objects) {
  Scene scene;
  for (const auto& triangles : objects) {
    scene.objects.push_back({"", static_cast<std::uint32_t>(scene.triangles.size()),
                             static_cast<std::uint32_t>(triangles.size())});
    for (const Triangle& t : triangles) add_triangle(scene, t);
  }
  return scene;
}

/// One object of triangles with corners on a grid, which is tested against itself.
template <typename Random>
Scene soup(Random& random, std::uint32_t triangles, int extent) {
  Scene scene;
  const auto corner = [&] {
    return Vec3(random.below(extent), random.below(extent), random.below(extent));
  };
  for (std::uint32_t t = 0; t < triangles; ++t) add_triangle(scene, {corner(), corner(), corner()});
  scene.objects.push_back({"soup", 0, triangles, true});
  return scene;
}

/// The scene with equal vertices made one, as most meshes have them; some are left apart.
inline Scene welded(Scene scene, bool all) {
  std::vector<std::uint32_t> first(scene.vertices.size());
  for (std::uint32_t v = 0; v < first.size(); ++v) {
    first[v] = static_cast<std::uint32_t>(
        std::find(scene.vertices.begin(), scene.vertices.begin() + v, scene.vertices[v]) -
        scene.vertices.begin());
  }
  for (auto& triangle : scene.triangles) {
    for (std::uint32_t& v : triangle)
      if (all || v % 3 != 0) v = first[v];
  }
  return scene;
}

/// So many small triangles on a grid.
inline std::vector<Triangle> on_grid(std::mt19937& random, std::size_t count, int extent) {
  std::vector<Triangle> out(count);
  for (Triangle& t : out) {
    const Vec3 corner(random() % extent, random() % extent, random() % extent);
    for (Vec3& p : t) p = corner + Vec3(random() % 3, random() % 3, random() % 3);
  }
  return out;
}

/// So many objects of small triangles on a grid, some of them empty; many touch, share corners or
/// are degenerate.
inline Scene grid_scene(std::mt19937& random, std::size_t object_count, int extent,
                        int empty_one_in) {
  std::vector<std::vector<Triangle>> objects(object_count);
  for (auto& triangles : objects)
    triangles = on_grid(random, random() % empty_one_in == 0 ? 0 : random() % 40, extent);
  return welded(scene_of(objects), random() % 2 == 0);
}

/// Calls visit(pair, boxes overlap) for every pair of triangles that counts, in sorted order.
template <typename Visit>
void for_each_pair(const Scene& scene, Visit visit, double clearance = 0) {
  for (const Object& x : scene.objects) {
    const std::uint32_t end = x.first_triangle + x.triangle_count;
    for (std::uint32_t a = x.first_triangle; a < end; ++a) {
      // Objects are contiguous and ascending: what follows this object belongs to others.
      for (std::uint32_t b = x.self ? a + 1 : end; b < scene.triangles.size(); ++b)
        visit(TrianglePair{a, b}, boxes_overlap(scene.corners(a), scene.corners(b), clearance));
    }
  }
}

/// Triangles of one object that share a position.
inline bool neighbours(const Scene& scene, const TrianglePair& pair) {
  const auto owner = [&](std::uint32_t t) {
    return std::ranges::find_if(scene.objects, [t](const Object& x) {
      return t >= x.first_triangle && t < x.first_triangle + x.triangle_count;
    });
  };
  return owner(pair.a) == owner(pair.b) &&
         share_position(scene.corners(pair.a), scene.corners(pair.b));
}

/// True where a pair collides, as verify/exact.h says.
inline bool collides(const Scene& scene, const TrianglePair& pair, double clearance) {
  const Triangle a = scene.corners(pair.a), b = scene.corners(pair.b);
  return neighbours(scene, pair) ? intersects_beyond_shared(a, b) : within(a, b, clearance);
}

}  // namespace farcull::reference
