// Directions that prove that two triangles are disjoint, and points that prove that two triangles
// meet or are near. Only integer_pair.cpp and integer_distance.cpp include this file.
#pragma once

#include <algorithm>

#include "verify/certificate/integers.h"

namespace farcull::integer {

// The 38 directions of a pair of triangles. The idea is from Gottschalk, Lin, Manocha, "OBBTree"
// (1996). docs/certificate.md proves that one of the 38 directions separates any two disjoint
// triangles, even degenerate ones.

/// Variables for intermediate results. They are reused, since allocating GMP integers takes time.
template <class Integer>
struct Scratch {
  Vector<Integer> e, f, w, d;
  Integer ee, we;
  std::array<Integer, 3> on_a, on_b;
};

/// Sets s.d to the direction; see kDirections in integer_pair.h.
template <class Integer>
void make_direction(Scratch<Integer>& s, const Corners<Integer>& a, const Corners<Integer>& b,
                    int direction) {
  const auto product = [&](const Corners<Integer>& of_e, int e, const Corners<Integer>& of_f,
                           int f) {
    edge(s.e, of_e, e);
    edge(s.f, of_f, f);
    cross(s.d, s.e, s.f);
  };
  if (direction < 2) return product(direction == 0 ? a : b, 0, direction == 0 ? a : b, 1);
  const int family = (direction - 2) / 9;
  const int i = (direction - 2) % 9 / 3;
  const int j = (direction - 2) % 3;
  if (family == 0) return product(a, i, b, j);
  if (family == 3) return minus(s.d, b[j], a[i]);
  minus(s.w, b[j], a[i]);
  if (family == 1) {
    edge(s.e, a, i);
  } else {
    edge(s.e, b, j);
  }
  dot(s.ee, s.e, s.e);
  dot(s.we, s.w, s.e);
  for (int k = 0; k < 3; ++k) {
    multiply(s.d[k], s.w[k], s.ee);
    subtract_product(s.d[k], s.e[k], s.we);
  }
}

template <class Integer>
void project(Scratch<Integer>& s, const Corners<Integer>& a, const Corners<Integer>& b) {
  for (int i = 0; i < 3; ++i) {
    dot(s.on_a[i], s.d, a[i]);
    dot(s.on_b[i], s.d, b[i]);
  }
}

/// True iff the projections onto s.d have a gap. False if s.d is zero.
template <class Integer>
bool has_gap(Scratch<Integer>& s, const Corners<Integer>& a, const Corners<Integer>& b) {
  project(s, a, b);
  const auto all_less = [](const auto& x, const auto& y) {
    for (int i = 0; i < 3; ++i) {
      for (int j = 0; j < 3; ++j) {
        if (!(x[i] < y[j])) return false;
      }
    }
    return true;
  };
  return all_less(s.on_a, s.on_b) || all_less(s.on_b, s.on_a);
}

/// True iff gap^2 / |d|^2 > over / under for the direction d = s.d (with or_as_far: >=). If true,
/// the squared distance exceeds over / under as well, since |d| times the distance is at least the
/// gap. Preconditions: has_gap() was true for s, over >= 0, under > 0.
inline bool gap_reaches(Scratch<mpz_class>& s, const mpz_class& over, const mpz_class& under,
                        bool or_as_far) {
  const auto [a_lo, a_hi] = std::minmax_element(s.on_a.begin(), s.on_a.end());
  const auto [b_lo, b_hi] = std::minmax_element(s.on_b.begin(), s.on_b.end());
  s.we = *a_hi < *b_lo ? *b_lo - *a_hi : *a_lo - *b_hi;
  multiply(s.w[0], s.we, s.we);
  multiply(s.w[1], s.w[0], under);
  dot(s.ee, s.d, s.d);
  multiply(s.w[2], s.ee, over);
  return or_as_far ? s.w[1] >= s.w[2] : s.w[1] > s.w[2];
}

/// True iff the direction d = s.d proves that a and b share no more than their shared part. Bit i
/// of shared_a is set if corner i of a equals a corner of b; likewise shared_b for b. The proof: a
/// plane perpendicular to d has all of a on one side and all of b on the other side. So the
/// triangles meet only in the plane. There, the part of each triangle is the hull of its corners in
/// the plane. These hulls share no more than the shared part if all corners of one hull are shared,
/// or if the hulls are two edges that are not parallel (d is the cross product of these edges).
template <class Integer>
bool parts_at_shared(Scratch<Integer>& s, const Corners<Integer>& a, const Corners<Integer>& b,
                     int direction, unsigned shared_a, unsigned shared_b) {
  project(s, a, b);
  const auto [a_lo, a_hi] = std::minmax_element(s.on_a.begin(), s.on_a.end());
  const auto [b_lo, b_hi] = std::minmax_element(s.on_b.begin(), s.on_b.end());
  const bool a_below = *a_hi <= *b_lo;
  if (!a_below && !(*b_hi <= *a_lo)) return false;
  const Integer plane = a_below ? *a_hi : *a_lo;  // value of s.d . x on the plane
  unsigned in_a = 0, in_b = 0;
  for (int i = 0; i < 3; ++i) {
    if (s.on_a[i] == plane) in_a |= 1u << i;
    if (s.on_b[i] == plane) in_b |= 1u << i;
  }
  if ((in_a & ~shared_a) == 0 || (in_b & ~shared_b) == 0) return true;
  if (direction < 2 || direction >= 11 || is_zero(s.d)) return false;
  const auto edge_of = [](int i) { return 1u << i | 1u << ((i + 1) % 3); };
  return in_a == edge_of((direction - 2) / 3) && in_b == edge_of((direction - 2) % 3);
}

/// Returns how many bits a difference of coordinates may have so that all integers in
/// make_direction() and has_gap() fit in 127 bits. Coordinates are relative to a's first corner.
/// Let D = 2^bits, and let |x| < D for all differences x of coordinates:
///   corner-corner: |d| < D, |projection| < 3 D^2 < 2^(2 bits + 2)
///   cross products: |d| < 2 D^2, |projection| < 6 D^3 < 2^(3 bits + 3)
///   perpendiculars: e.e, |w.e| < 3 D^2, |d| < 6 D^3, |projection| < 18 D^4 < 2^(4 bits + 5)
/// Partial sums are smaller than these bounds.
inline int most_bits(int direction) {
  if (direction >= 29) return 62;
  return direction < 11 ? 41 : 30;
}

using BigVector = Vector<mpz_class>;
using BigCorners = Corners<mpz_class>;

/// Constructs and verifies points. A point is a vector of integers divided by one integer. The
/// integers are members, since allocating GMP integers takes time.
class PointSearch {
 public:
  /// corner() to foot_on_plane() each construct a point, and return false if the point does not
  /// exist. The point may be outside both triangles.
  bool corner(const BigCorners& t, int i) {
    point_ = t[i];
    scale_ = 1;
    return true;
  }
  /// Constructs the point where edge i of s crosses the plane of t; false unless there is one.
  bool edge_and_plane(const BigCorners& s, int i, const BigCorners& t) {
    make_normal(t);
    edge(u_, s, i);
    minus(w_, t[0], s[i]);
    dot(numerator_, normal_, w_);
    dot(scale_, normal_, u_);
    return along(s[i]);
  }
  /// Constructs the point of edge i of s that is nearest to the line of edge j of t, unless the
  /// edges are parallel. If the lines cross, this is their common point.
  bool edge_and_edge(const BigCorners& s, int i, const BigCorners& t, int j) {
    edge(u_, s, i);
    edge(v_, t, j);
    cross(normal_, u_, v_);
    minus(w_, t[j], s[i]);
    cross(side_, w_, v_);
    dot(numerator_, side_, normal_);
    dot(scale_, normal_, normal_);
    return along(s[i]);
  }

  /// Constructs the foot of the perpendicular from the point `from` to edge i of t, if the foot is
  /// on the edge.
  bool foot_on_edge(const BigCorners& t, int i, const BigVector& from) {
    edge(u_, t, i);
    minus(w_, from, t[i]);
    dot(numerator_, w_, u_);
    dot(scale_, u_, u_);
    return along(t[i]);
  }
  /// Constructs the foot of the perpendicular from the point `from` to the plane of t. Returns
  /// false if t is degenerate.
  bool foot_on_plane(const BigCorners& t, const BigVector& from) {
    make_normal(t);
    minus(w_, from, t[0]);
    dot(numerator_, normal_, w_);
    dot(scale_, normal_, normal_);
    for (int k = 0; k < 3; ++k) {
      multiply(point_[k], from[k], scale_);
      subtract_product(point_[k], normal_[k], numerator_);
    }
    return scale_ != 0;
  }

  /// True iff |p / m - q / n| <= distance, where p / m is the last point of this search and q / n
  /// the last point of `other`. Compares squares of integers.
  bool is_near(const PointSearch& other, const mpz_class& distance) {
    from_to(other);
    dot(value_, w_, w_);
    multiply(numerator_, scale_, other.scale_);
    multiply(side_[0], numerator_, distance);
    multiply(side_[1], side_[0], side_[0]);
    return value_ <= side_[1];
  }

  /// True iff p, the last point of this search, and q, the last point of `other`, satisfy
  /// (q - p) . (a_i - p) <= 0 and (q - p) . (b_j - q) >= 0 for all corners a_i and b_j. So no point
  /// of a lies beyond p in the direction from p to q, and no point of b lies beyond q in the
  /// opposite direction. If p lies in a and q lies in b, they are nearest points
  /// (docs/certificate.md).
  bool is_nearest(const PointSearch& other, const BigCorners& a, const BigCorners& b) {
    from_to(other);
    for (int i = 0; i < 3; ++i) {
      for (int k = 0; k < 3; ++k) {
        multiply(side_[k], a[i][k], scale_);
        side_[k] -= point_[k];
      }
      dot(value_, w_, side_);
      if (value_ > 0) return false;
      for (int k = 0; k < 3; ++k) {
        multiply(side_[k], b[i][k], other.scale_);
        side_[k] -= other.point_[k];
      }
      dot(value_, w_, side_);
      if (value_ < 0) return false;
    }
    return true;
  }

  /// Sets over / under to the squared distance from the last point of this search to the last point
  /// of `other`; under > 0. The fraction is not in lowest terms.
  void squared_distance(const PointSearch& other, mpz_class& over, mpz_class& under) {
    from_to(other);
    dot(over, w_, w_);
    multiply(value_, scale_, other.scale_);
    multiply(under, value_, value_);
  }

  /// The last point is point() / scale(), a vector over an integer > 0.
  const BigVector& point() const { return point_; }
  const mpz_class& scale() const { return scale_; }

  /// True iff the normal of t is not zero.
  bool is_triangle(const BigCorners& t) {
    make_normal(t);
    return !is_zero(normal_);
  }

  /// True iff the last point lies in the closed hull of the corners. The hull may be a triangle, a
  /// segment or a point.
  bool lies_in(const BigCorners& t) {
    for (int i = 0; i < 3; ++i) {
      for (int k = 0; k < 3; ++k) {
        from_[i][k] = point_[k];
        subtract_product(from_[i][k], scale_, t[i][k]);
      }
    }
    make_normal(t);
    if (!is_zero(normal_)) {
      dot(value_, normal_, from_[0]);
      if (value_ != 0) return false;
      for (int i = 0; i < 3; ++i) {
        edge(v_, t, i);
        cross(side_, v_, from_[i]);
        dot(value_, normal_, side_);
        if (value_ < 0) return false;
      }
      return true;
    }
    // Collinear corners: the hull is the union of the edges. The point is on an edge if it is on
    // the line of the edge and, in every coordinate, its offsets from the two ends differ in sign
    // or one of them is zero. This is right for an edge of length 0 as well.
    for (int i = 0; i < 3; ++i) {
      edge(v_, t, i);
      cross(side_, v_, from_[i]);
      if (!is_zero(side_)) continue;
      bool between = true;
      for (int k = 0; k < 3; ++k)
        between = between && sgn(from_[i][k]) * sgn(from_[(i + 1) % 3][k]) <= 0;
      if (between) return true;
    }
    return false;
  }

 private:
  /// Sets w_ to q - p, times both scales, for the last points p of this search and q of `other`.
  void from_to(const PointSearch& other) {
    for (int k = 0; k < 3; ++k) {
      multiply(w_[k], other.point_[k], scale_);
      subtract_product(w_[k], point_[k], other.scale_);
    }
  }
  void make_normal(const BigCorners& t) {
    edge(v_, t, 0);
    edge(w_, t, 1);
    cross(normal_, v_, w_);
  }
  /// Sets the point to from + (numerator_ / scale_) u_. Returns false unless the factor is from
  /// 0 to 1.
  bool along(const BigVector& from) {
    if (scale_ < 0) {
      mpz_neg(scale_.get_mpz_t(), scale_.get_mpz_t());
      mpz_neg(numerator_.get_mpz_t(), numerator_.get_mpz_t());
    }
    if (scale_ == 0 || numerator_ < 0 || numerator_ > scale_) return false;
    for (int k = 0; k < 3; ++k) {
      multiply(point_[k], from[k], scale_);
      add_product(point_[k], u_[k], numerator_);
    }
    return true;
  }

  BigVector point_;                // the point times scale_
  mpz_class scale_;                // > 0 after a point was constructed
  std::array<BigVector, 3> from_;  // vectors from each corner to the point, times scale_
  BigVector normal_, u_, v_, w_, side_;
  mpz_class numerator_, value_;
};

/// True iff test() is true for one of the 21 points: corners, crossings of an edge and a plane,
/// crossings of two edges. The tested point is the last point of `search`.
bool any_point(PointSearch& search, const BigCorners& a, const BigCorners& b, const auto& test) {
  for (int i = 0; i < 3; ++i) {
    if (search.edge_and_plane(a, i, b) && test()) return true;
    if (search.edge_and_plane(b, i, a) && test()) return true;
  }
  for (int i = 0; i < 3; ++i) {
    if (search.corner(a, i) && test()) return true;
    if (search.corner(b, i) && test()) return true;
  }
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) {
      if (search.edge_and_edge(a, i, b, j) && test()) return true;
    }
  }
  return false;
}

/// True iff test() is true for one of the 42 pairs of points (docs/certificate.md), one point on a
/// and one point on b.
bool any_two_points(PointSearch& on_a, PointSearch& on_b, const BigCorners& a, const BigCorners& b,
                    const auto& test) {
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) {
      if (on_a.corner(a, i) && on_b.corner(b, j) && test()) return true;
    }
  }
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) {
      on_b.corner(b, j);
      if (on_a.foot_on_edge(a, i, b[j]) && test()) return true;
      on_a.corner(a, i);
      if (on_b.foot_on_edge(b, j, a[i]) && test()) return true;
      if (on_a.edge_and_edge(a, i, b, j) && on_b.edge_and_edge(b, j, a, i) && test()) return true;
    }
  }
  for (int i = 0; i < 3; ++i) {
    on_b.corner(b, i);
    if (on_a.foot_on_plane(a, b[i]) && test()) return true;
    on_a.corner(a, i);
    if (on_b.foot_on_plane(b, a[i]) && test()) return true;
  }
  return false;
}

}  // namespace farcull::integer
