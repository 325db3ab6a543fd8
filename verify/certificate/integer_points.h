// The 21 points of a pair of triangles: corners, edges with planes, edges with edges; and, for a
// clearance, 42 pairs of points, one on each triangle. Each point is a vector of integers over one
// integer. For integer_pair.cpp alone.
#pragma once

#include "verify/certificate/integer_vector.h"

namespace farcull::integer {

using BigVector = Vector<mpz_class>;
using BigCorners = Corners<mpz_class>;

/// Constructs points and verifies them. Its integers are members because GMP's own memory: a search
/// that made them anew would spend most of its time on that.
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
  /// The point of edge i of s nearest to the line of edge j of t, unless they are parallel. Where
  /// the lines cross it is their common point.
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

  /// True iff the point constructed last is no farther than `distance` from that of another search:
  /// |p / m - q / n| <= distance, as squares of integers.
  bool is_near(const PointSearch& other, const mpz_class& distance) {
    from_to(other);
    dot(value_, w_, w_);
    multiply(numerator_, scale_, other.scale_);
    multiply(side_[0], numerator_, distance);
    multiply(side_[1], side_[0], side_[0]);
    return value_ <= side_[1];
  }

  /// With p the point constructed last and q that of another search: true iff q - p has no part
  /// that leads from p into a, nor one that leads from q out of b: (q - p) . (a_i - p) <= 0 and
  /// (q - p) . (b_j - q) >= 0 for all corners. Where p lies in a and q in b, no two points of a and
  /// b are then nearer (docs/certificate.md).
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

  /// The square of the distance of the point constructed last from that of another search, as
  /// numerator and denominator > 0, not reduced.
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
    // Collinear corners: the hull is the union of its edges. Between two ends: on their line, and
    // the offsets from the ends differ in sign in every coordinate or are zero (which pins a point
    // that both ends coincide in).
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
  /// w_ = q - p, times both scales; p the point constructed last, q that of another search.
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
  /// from + (numerator / scale) u; none unless the fraction is in [0, 1].
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
  mpz_class scale_;                // > 0 where there is a point
  std::array<BigVector, 3> from_;  // from each corner to the point, times scale_
  BigVector normal_, u_, v_, w_, side_;
  mpz_class numerator_, value_;
};

/// True iff one of the 21 points passes.
template <class Test>
bool any_point(PointSearch& search, const BigCorners& a, const BigCorners& b, const Test& test) {
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
template <class Test>
bool any_two_points(PointSearch& on_a, PointSearch& on_b, const BigCorners& a, const BigCorners& b,
                    const Test& test) {
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) {
      on_a.corner(a, i);
      on_b.corner(b, j);
      if (test()) return true;
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
