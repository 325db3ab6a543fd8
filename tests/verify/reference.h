// Reference answers for the tests of verify/: slow, exact, and written apart from what they test
// (integers, no CGAL).
#pragma once

#include <gmpxx.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <initializer_list>
#include <vector>

#include "core/scene.h"

namespace farcull::reference {

using Triangle = std::array<Vec3, 3>;

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

/// True iff the projections onto d have a gap. The zero direction has none.
template <typename Integer>
bool gap(const std::array<Vector<Integer>, 3>& a, const std::array<Vector<Integer>, 3>& b,
         const Vector<Integer>& d) {
  const std::array<Integer, 3> s = {dot(d, a[0]), dot(d, a[1]), dot(d, a[2])};
  const std::array<Integer, 3> t = {dot(d, b[0]), dot(d, b[1]), dot(d, b[2])};
  return *std::max_element(s.begin(), s.end()) < *std::min_element(t.begin(), t.end()) ||
         *std::max_element(t.begin(), t.end()) < *std::min_element(s.begin(), s.end());
}

/// True iff two closed triangles (or the segments or points they are) are disjoint. Disjoint
/// compact convex sets have two closest points, and the direction between them separates; it
/// depends only on the features the two points lie inside: corner and corner, corner and edge,
/// corner and face, edge and edge. All such directions are tried: 2 + 9 + 18 + 9.
template <typename Integer>
bool separated(const std::array<Vector<Integer>, 3>& a, const std::array<Vector<Integer>, 3>& b) {
  const auto edge = [](const auto& t, int i) { return minus(t[(i + 1) % 3], t[i]); };
  if (gap(a, b, cross(edge(a, 0), edge(a, 1)))) return true;
  if (gap(a, b, cross(edge(b, 0), edge(b, 1)))) return true;
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) {
      const Vector<Integer> between = minus(b[j], a[i]);
      if (gap(a, b, between) || gap(a, b, cross(edge(a, i), edge(b, j)))) return true;
      for (const Vector<Integer>& e : {edge(a, i), edge(b, j)}) {
        // The part of the corner's offset from the edge's line that is perpendicular to it, times
        // |e|^2. The offset from corner i of a to corner j of b serves both: it is from b[j] to a's
        // edge i and from a[i] to b's edge j.
        const Integer ee = dot(e, e);
        const Integer be = dot(between, e);
        const Vector<Integer> d = {Integer(between[0] * ee - e[0] * be),
                                   Integer(between[1] * ee - e[1] * be),
                                   Integer(between[2] * ee - e[2] * be)};
        if (gap(a, b, d)) return true;
      }
    }
  }
  return false;
}

inline bool small_integers(const Triangle& t) {
  return std::all_of(t.begin(), t.end(), [](const Vec3& p) {
    return (p.array() == p.array().round()).all() && (p.array().abs() <= 64).all();
  });
}

template <typename Convert>
auto converted(const Triangle& t, Convert convert) {
  using Integer = decltype(convert(0.0));
  std::array<Vector<Integer>, 3> result;
  for (int i = 0; i < 3; ++i) {
    for (int axis = 0; axis < 3; ++axis) result[i][axis] = convert(t[i][axis]);
  }
  return result;
}

/// The reference for farcull::intersects: machine integers where coordinates are small integers
/// (degree 4, so below 2^40), else GMP integers after scaling both by 2^1074, which makes every
/// finite double an integer.
inline bool intersects(const Triangle& a, const Triangle& b) {
  if (small_integers(a) && small_integers(b)) {
    const auto convert = [](double x) { return static_cast<std::int64_t>(x); };
    return !separated(converted(a, convert), converted(b, convert));
  }
  const auto convert = [](double x) {
    int exponent = 0;
    mpz_class mantissa(
        std::ldexp(std::frexp(x, &exponent), 53));  // an integer; x = mantissa * 2^(exponent - 53)
    const int shift = exponent - 53 + 1074;
    // A subnormal has trailing zeros enough for the shift to the right to be exact.
    return shift >= 0 ? mpz_class(mantissa << shift) : mpz_class(mantissa >> -shift);
  };
  return !separated(converted(a, convert), converted(b, convert));
}

inline bool boxes_overlap(const Triangle& a, const Triangle& b) {
  for (int axis = 0; axis < 3; ++axis) {
    const auto [a_lo, a_hi] = std::minmax({a[0][axis], a[1][axis], a[2][axis]});
    const auto [b_lo, b_hi] = std::minmax({b[0][axis], b[1][axis], b[2][axis]});
    if (a_hi < b_lo || b_hi < a_lo) return false;
  }
  return true;
}

/// One object per list of triangles, without shared vertices.
inline Scene scene_of(const std::vector<std::vector<Triangle>>& objects) {
  Scene scene;
  for (const auto& triangles : objects) {
    scene.objects.push_back({"", static_cast<std::uint32_t>(scene.triangles.size()),
                             static_cast<std::uint32_t>(triangles.size())});
    for (const Triangle& t : triangles) {
      const auto v = static_cast<std::uint32_t>(scene.vertices.size());
      scene.vertices.insert(scene.vertices.end(), t.begin(), t.end());
      scene.triangles.push_back({v, v + 1, v + 2});
      scene.source_face.push_back(static_cast<std::uint32_t>(scene.source_face.size()));
    }
  }
  return scene;
}

/// Calls visit(pair, boxes overlap) for every pair of triangles of different objects, in sorted
/// order.
template <typename Visit>
void for_each_pair(const Scene& scene, Visit visit) {
  for (const Object& x : scene.objects) {
    for (std::uint32_t a = x.first_triangle; a < x.first_triangle + x.triangle_count; ++a) {
      // Objects are contiguous and ascending: what follows this object belongs to others.
      for (std::uint32_t b = x.first_triangle + x.triangle_count; b < scene.triangles.size(); ++b) {
        visit(TrianglePair{a, b}, boxes_overlap(scene.corners(a), scene.corners(b)));
      }
    }
  }
}

}  // namespace farcull::reference
