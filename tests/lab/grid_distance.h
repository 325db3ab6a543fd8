// The truth about nearest triangles, by comparing all with all in exact arithmetic that shares no
// code with farcull; and random scenes.
#pragma once

#include "tests/lab/reference.h"
#include "verify/rational.h"

namespace farcull::near_lab {

/// Numbers of which the truth is computed. Exact where coordinates are integers up to 64: then no
/// square below is above 2^126.
__extension__ using Integer = __int128;
template <class T>
using Triple = reference::Vector<T>;
template <class T>
using Corners = std::array<Triple<T>, 3>;
using reference::dot;

/// numerator / denominator, the latter positive.
template <class T>
struct Fraction {
  T numerator = 0, denominator = 1;
  bool operator<(const Fraction& other) const {
    return numerator * other.denominator < other.numerator * denominator;
  }
  bool operator==(const Fraction& other) const {
    return numerator * other.denominator == other.numerator * denominator;
  }
};

/// The square of the distance of two closed triangles. The gap of their projections onto a
/// direction is never longer than the distance times the direction's length, and is that along the
/// direction between two closest points. So it is the largest quotient among all these directions,
/// or 0 where there is no gap.
template <class T>
Fraction<T> squared_distance(const Corners<T>& a, const Corners<T>& b) {
  Fraction<T> out;
  reference::any_direction(a, b, [&](const Triple<T>& d) {
    const T gap = reference::gap(a, b, d);
    const Fraction<T> own = {T(gap * gap), T(dot(d, d))};
    if (gap > 0 && out < own) out = own;
    return false;
  });
  return out;
}

/// The least common denominator of coordinates, a power of two.
inline mpz_class scale_of(std::span<const Vec3> points) {
  mpz_class scale = 1;
  for (const Vec3& p : points) {
    for (const double x : p) scale = std::max(scale, mpz_class(mpq_class(x).get_den()));
  }
  return scale;
}

inline Corners<mpz_class> exact(const std::array<Vec3, 3>& t, const mpz_class& scale) {
  return reference::converted(t,
                              [&](double x) { return mpz_class(mpq_class(x * mpq_class(scale))); });
}

inline mpq_class squared_distance_of(const Corners<mpz_class>& a, const Corners<mpz_class>& b) {
  const auto f = squared_distance(a, b);
  mpq_class out(f.numerator, f.denominator);
  out.canonicalize();
  return out;
}

/// The same of triangles in doubles.
inline mpq_class squared_distance_of(const std::array<Vec3, 3>& a, const std::array<Vec3, 3>& b) {
  const mpz_class scale = std::max(scale_of(a), scale_of(b));
  return squared_distance_of(exact(a, scale), exact(b, scale)) / (scale * scale);
}

/// A scene whose coordinates are (integers + offset) * unit, exact in doubles. The integers are up
/// to 64 and decide what is nearest; distances are `unit` times theirs.
struct GridScene {
  Scene scene;
  std::vector<Corners<Integer>> corners;  // per triangle
  double unit = 1;
};

template <class T>
bool share_position(const Corners<T>& a, const Corners<T>& b) {
  return std::ranges::any_of(a, [&](const auto& p) { return std::ranges::find(b, p) != b.end(); });
}

/// The square of the gap of the boxes of two triangles, which is no longer than their distance.
template <class T>
T square_of_gap(const Corners<T>& a, const Corners<T>& b) {
  T out = 0;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const auto [a_lo, a_hi] = std::minmax({a[0][axis], a[1][axis], a[2][axis]});
    const auto [b_lo, b_hi] = std::minmax({b[0][axis], b[1][axis], b[2][axis]});
    const T gap = std::max({T(a_lo - b_hi), T(b_lo - a_hi), T(0)});
    out += gap * gap;
  }
  return out;
}

/// What is nearest of two objects.
struct Truth {
  bool any = false;
  Fraction<Integer> squared;
  std::vector<TrianglePair> pairs;  // all that are as near, sorted
};
inline Truth truth_of(const GridScene& grid, std::uint32_t a, std::uint32_t b) {
  Truth out;
  const auto range = [&](std::uint32_t o) {
    const Object& object = grid.scene.objects[o];
    return std::pair(object.first_triangle, object.first_triangle + object.triangle_count);
  };
  const auto [a_from, a_to] = range(a);
  const auto [b_from, b_to] = range(b);
  for (std::uint32_t i = a_from; i < a_to; ++i) {
    for (std::uint32_t j = a == b ? i + 1 : b_from; j < b_to; ++j) {
      if (a == b && share_position(grid.corners[i], grid.corners[j])) continue;
      if (out.any &&
          out.squared < Fraction<Integer>{square_of_gap(grid.corners[i], grid.corners[j])})
        continue;
      const Fraction<Integer> own = squared_distance(grid.corners[i], grid.corners[j]);
      if (out.any && out.squared < own) continue;
      if (!out.any || own < out.squared) out.pairs.clear();
      out.any = true;
      out.squared = own;
      out.pairs.push_back({i, j});
    }
  }
  return out;
}

/// True iff the distance is at most `most`, decided exactly.
inline bool at_most(const Fraction<Integer>& squared, double unit, double most) {
  if (most == HUGE_VAL) return true;
  const auto q = [](Integer x) {
    // Below 2^126.
    const mpz_class high = static_cast<long>(x >> 62);
    return rational::Q(mpz_class((high << 62) + static_cast<long>(x & ((Integer{1} << 62) - 1))));
  };
  const rational::Q u = unit, m = most;
  return q(squared.numerator) * u * u <= m * m * q(squared.denominator);
}

inline void add_object(GridScene& grid, const std::vector<Corners<Integer>>& triangles) {
  Object object;
  object.first_triangle = static_cast<std::uint32_t>(grid.corners.size());
  object.triangle_count = static_cast<std::uint32_t>(triangles.size());
  grid.scene.objects.push_back(object);
  grid.corners.insert(grid.corners.end(), triangles.begin(), triangles.end());
}
/// Makes the doubles. Zeros become negative zeros where `negative` says so: the same positions.
template <class Negative>
void finish(GridScene& grid, double unit, double offset, const Negative& negative) {
  grid.unit = unit;
  for (const Corners<Integer>& t : grid.corners) {
    const auto first = static_cast<std::uint32_t>(grid.scene.vertices.size());
    for (const Triple<Integer>& p : t) {
      Vec3 x;
      for (int axis = 0; axis < 3; ++axis) {
        x[axis] = (static_cast<double>(p[static_cast<std::size_t>(axis)]) + offset) * unit;
        if (x[axis] == 0 && negative()) x[axis] = -0.0;
      }
      grid.scene.vertices.push_back(x);
    }
    grid.scene.triangles.push_back({first, first + 1, first + 2});
    grid.scene.source_face.push_back(static_cast<std::uint32_t>(grid.scene.source_face.size()));
  }
}

/// Triangles with corners on a grid, `half` its half width, near `middle`; some are segments or
/// points, some are there twice.
inline std::vector<Corners<Integer>> random_triangles(rational::Draws& random, int count, int half,
                                                      const Triple<Integer>& middle) {
  std::vector<Corners<Integer>> out;
  const int size = 1 + random.below(half);
  for (int k = 0; k < count; ++k) {
    if (!out.empty() && random.below(8) == 0) {
      out.push_back(out[static_cast<std::size_t>(random.below(static_cast<int>(out.size())))]);
      continue;
    }
    Triple<Integer> place;
    for (std::size_t axis = 0; axis < 3; ++axis)
      place[axis] = middle[axis] + random.below(2 * half + 1) - half;
    Corners<Integer> t;
    for (Triple<Integer>& p : t)
      for (std::size_t axis = 0; axis < 3; ++axis)
        p[axis] = place[axis] + random.below(size + 1) - size / 2;
    if (random.below(10) == 0) t[1] = t[0];
    if (random.below(20) == 0) t[2] = t[1] = t[0];
    out.push_back(t);
  }
  return out;
}

/// Scales of the whole range of doubles, and places far from the origin.
inline std::pair<double, double> random_unit_and_offset(rational::Draws& random) {
  constexpr std::pair<double, double> kAll[8] = {
      {0x1p-1074, 0}, {0x1p-1060, 0x1p20}, {0x1p1016, 0}, {0x1p970, 0x1p50},
      {1, 0x1p46},    {0x1p-30, 0x1p30},   {1, 0},        {1, 0}};
  return kAll[random.below(8)];
}

}  // namespace farcull::near_lab
