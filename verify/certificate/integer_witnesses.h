// The directions and points that prove something about a pair of triangles. For integer_pair.cpp
// and integer_distance.cpp alone.
#pragma once

#include <algorithm>

#include "verify/certificate/integers.h"

namespace farcull::integer {

// The 38 directions of a pair of triangles, and the proofs that a direction gives. The idea is from
// Gottschalk, Lin, Manocha, "OBBTree" (1996). docs/certificate.md proves that the 38 directions are
// complete for triangles, degenerate ones included.

/// The intermediate results of a test. They are reused between tests, since allocating GMP's
/// integers anew takes time.
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

/// Projects the corners onto s.d.
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

/// True iff the gap that has_gap() has found proves that the square of the distance is more than
/// over / under (over >= 0, under > 0); with or_as_far, at least over / under. No gap is longer
/// than the distance. Compares gap^2 / |d|^2.
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

/// True iff the direction s.d proves that a and b share no more than their shared part. shared_a,
/// shared_b: the corners that a and b have in common. The proof: a plane perpendicular to d has all
/// of a on one side and all of b on the other. So the triangles meet only in the plane, where each
/// is the hull of its corners in the plane. These hulls share no more than the shared part if all
/// corners of one hull are shared, or if both hulls are edges that are not parallel (d is their
/// product).
template <class Integer>
bool parts_at_shared(Scratch<Integer>& s, const Corners<Integer>& a, const Corners<Integer>& b,
                     int direction, unsigned shared_a, unsigned shared_b) {
  project(s, a, b);
  const auto [a_lo, a_hi] = std::minmax_element(s.on_a.begin(), s.on_a.end());
  const auto [b_lo, b_hi] = std::minmax_element(s.on_b.begin(), s.on_b.end());
  const bool a_below = *a_hi <= *b_lo;
  if (!a_below && !(*b_hi <= *a_lo)) return false;
  const Integer plane = a_below ? *a_hi : *a_lo;  // a shared corner lies in it
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

/// The largest number of bits for which has_gap(make_direction()) stays in 127 bits. Let |x| < D =
/// 2^bits for all differences x of coordinates; coordinates are relative to a's first corner:
///   corner-corner: |d| < D, |projection| < 3 D^2 < 2^(2 bits + 2)
///   cross products: |d| < 2 D^2, |projection| < 6 D^3 < 2^(3 bits + 3)
///   perpendiculars: e.e, |w.e| < 3 D^2, |d| < 6 D^3, |projection| < 18 D^4 < 2^(4 bits + 5)
/// Sums that are still being formed are smaller than these bounds.
inline int most_bits(int direction) {
  if (direction >= 29) return 62;
  return direction < 11 ? 41 : 30;
}

using BigVector = Vector<mpz_class>;
using BigCorners = Corners<mpz_class>;

/// Constructs points and verifies them. A point is a vector of integers over one integer. The
/// integers are members for the reason that Scratch gives.
class PointSearch {
 public:
  /// These functions construct a point, and return false if it does not exist. The point lies on
  /// its edge, but perhaps in neither triangle.
  bool corner(const BigCorners& t, int i) {
    point_ = t[i];
    scale_ = 1;
    return true;
  }
  /// The point in which edge i of s crosses the plane of t, if it is one point.
  bool edge_and_plane(const BigCorners& s, int i, const BigCorners& t) {
    make_normal(t);
    edge(u_, s, i);
    minus(w_, t[0], s[i]);
    dot(numerator_, normal_, w_);
    dot(scale_, normal_, u_);
    return along(s[i]);
  }
  /// The point of edge i of s nearest to the line of edge j of t, unless the edges are parallel. If
  /// the lines cross, this is their common point.
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

  /// The foot of the perpendicular from a point to the line of edge i of t, if it is on the edge.
  bool foot_on_edge(const BigCorners& t, int i, const BigVector& from) {
    edge(u_, t, i);
    minus(w_, from, t[i]);
    dot(numerator_, w_, u_);
    dot(scale_, u_, u_);
    return along(t[i]);
  }
  /// The foot of the perpendicular from a point to the plane of t, if t has one.
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

  /// True iff the point constructed last is no farther than `distance` from the last point of
  /// another search: |p / m - q / n| <= distance, compared as squares of integers.
  bool is_near(const PointSearch& other, const mpz_class& distance) {
    from_to(other);
    dot(value_, w_, w_);
    multiply(numerator_, scale_, other.scale_);
    multiply(side_[0], numerator_, distance);
    multiply(side_[1], side_[0], side_[0]);
    return value_ <= side_[1];
  }

  /// Let p be the point constructed last and q the last point of another search. True iff
  /// (q - p) . (a_i - p) <= 0 and (q - p) . (b_j - q) >= 0 for all corners: no corner of a lies
  /// beyond p in the direction from p to q, and no corner of b beyond q in the opposite one. So if
  /// p lies in a and q in b, they are nearest points of a and b (docs/certificate.md).
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

  /// The square of the distance from the point constructed last to the last point of another
  /// search, as numerator and denominator > 0, not reduced.
  void squared_distance(const PointSearch& other, mpz_class& over, mpz_class& under) {
    from_to(other);
    dot(over, w_, w_);
    multiply(value_, scale_, other.scale_);
    multiply(under, value_, value_);
  }

  /// The point constructed last, as a vector over an integer > 0.
  const BigVector& point() const { return point_; }
  const mpz_class& scale() const { return scale_; }

  /// True iff the normal of t is not zero.
  bool is_triangle(const BigCorners& t) {
    make_normal(t);
    return !is_zero(normal_);
  }

  /// True iff the point constructed last lies in the closed hull of the corners, whatever its
  /// dimension.
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
    // Collinear corners: the hull is the union of the edges. The point is between two ends if it is
    // on their line and in every coordinate its offsets from the ends differ in sign or are zero.
    // This also decides about two equal ends.
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
  /// w_ = q - p, times both scales; p is the point constructed last, q that of another search.
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
  /// Makes the point from + (numerator / scale) u; false unless the fraction is in [0, 1].
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

  BigVector point_;                // times scale_
  mpz_class scale_;                // > 0 if there is a point
  std::array<BigVector, 3> from_;  // from each corner to the point, times scale_
  BigVector normal_, u_, v_, w_, side_;
  mpz_class numerator_, value_;
};

/// True iff test() holds for one of the 21 points: corners, edges in planes, edges near edges.
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

/// True iff test() holds for one of the 42 pairs of points (docs/certificate.md), one on a and one
/// on b.
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
