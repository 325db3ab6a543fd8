// The 38 directions of a pair of triangles, and the proofs that one of them gives. Gottschalk, Lin,
// Manocha, "OBBTree" (1996) for the idea; docs/certificate.md proves that the 38 are complete for
// triangles, degenerate ones included. For integer_pair.cpp alone.
#pragma once

#include <algorithm>

#include "verify/certificate/integer_vector.h"

namespace farcull::integer {

/// The intermediate results of a test. They are kept between tests, since GMP's integers own
/// memory.
template <class Integer>
struct Scratch {
  Vector<Integer> e, f, w, d;
  Integer ee, we;
  std::array<Integer, 3> on_a, on_b;
};

/// s.d = the direction; see kDirections in integer_pair.h.
template <class Integer>
void make_direction(Scratch<Integer>& s, const Corners<Integer>& a, const Corners<Integer>& b,
                    int direction) {
  if (direction < 2) {
    edge(s.e, direction == 0 ? a : b, 0);
    edge(s.f, direction == 0 ? a : b, 1);
    cross(s.d, s.e, s.f);
    return;
  }
  const int family = (direction - 2) / 9;
  const int i = (direction - 2) % 9 / 3;
  const int j = (direction - 2) % 3;
  if (family == 0) {
    edge(s.e, a, i);
    edge(s.f, b, j);
    cross(s.d, s.e, s.f);
    return;
  }
  if (family == 3) {
    minus(s.d, b[j], a[i]);
    return;
  }
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

/// True iff the projections onto s.d have a gap. False if s.d is zero.
template <class Integer>
bool has_gap(Scratch<Integer>& s, const Corners<Integer>& a, const Corners<Integer>& b) {
  for (int i = 0; i < 3; ++i) {
    dot(s.on_a[i], s.d, a[i]);
    dot(s.on_b[i], s.d, b[i]);
  }
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

/// gap = the length, times |d|, of the gap that has_gap() has found.
template <class Integer>
void gap_length(const Scratch<Integer>& s, Integer& gap) {
  const auto [a_lo, a_hi] = std::minmax_element(s.on_a.begin(), s.on_a.end());
  const auto [b_lo, b_hi] = std::minmax_element(s.on_b.begin(), s.on_b.end());
  if (*a_hi < *b_lo) {
    gap = *b_lo - *a_hi;
  } else {
    gap = *a_lo - *b_hi;
  }
}

/// True iff the gap that has_gap() has found is longer than the clearance, which is > 0: then so is
/// the distance, since along no direction is the gap longer. Squares are compared: gap / |d| >
/// clearance.
template <class Integer>
bool gap_exceeds(Scratch<Integer>& s, const Integer& clearance) {
  gap_length(s, s.we);
  multiply(s.w[0], s.we, s.we);
  dot(s.ee, s.d, s.d);
  multiply(s.w[1], clearance, clearance);
  multiply(s.w[2], s.w[1], s.ee);
  return s.w[0] > s.w[2];
}

/// True iff the gap that has_gap() has found is so long that the square of the distance is more
/// than over / under (over >= 0, under > 0), or with or_as_far at least that: gap^2 / |d|^2 is
/// compared.
inline bool gap_reaches(Scratch<mpz_class>& s, const mpz_class& over, const mpz_class& under,
                        bool or_as_far) {
  gap_length(s, s.we);
  multiply(s.w[0], s.we, s.we);
  multiply(s.w[1], s.w[0], under);
  dot(s.ee, s.d, s.d);
  multiply(s.w[2], s.ee, over);
  return or_as_far ? s.w[1] >= s.w[2] : s.w[1] > s.w[2];
}

/// True iff the direction s.d proves that a and b share no more than their shared part; shared_a
/// and shared_b are the corners that stand in both. Where all of a lies on one side of a plane
/// across d and all of b on the other, they meet only in what both have in the plane: in the hulls
/// of their corners there. That is no more than the shared part where these corners of one triangle
/// are all shared, or where two edges that are not parallel (d is their product) lie in the plane.
template <class Integer>
bool parts_at_shared(Scratch<Integer>& s, const Corners<Integer>& a, const Corners<Integer>& b,
                     int direction, unsigned shared_a, unsigned shared_b) {
  for (int i = 0; i < 3; ++i) {
    dot(s.on_a[i], s.d, a[i]);
    dot(s.on_b[i], s.d, b[i]);
  }
  const auto [a_lo, a_hi] = std::minmax_element(s.on_a.begin(), s.on_a.end());
  const auto [b_lo, b_hi] = std::minmax_element(s.on_b.begin(), s.on_b.end());
  const bool a_below = *a_hi <= *b_lo;
  if (!a_below && !(*b_hi <= *a_lo)) return false;
  const Integer plane = a_below ? *a_hi : *a_lo;  // a shared corner lies in it
  unsigned in_a = 0;
  unsigned in_b = 0;
  for (int i = 0; i < 3; ++i) {
    if (s.on_a[i] == plane) in_a |= 1u << i;
    if (s.on_b[i] == plane) in_b |= 1u << i;
  }
  if ((in_a & ~shared_a) == 0 || (in_b & ~shared_b) == 0) return true;
  if (direction < 2 || direction >= 11 || is_zero(s.d)) return false;
  const auto edge_of = [](int i) { return 1u << i | 1u << ((i + 1) % 3); };
  return in_a == edge_of((direction - 2) / 3) && in_b == edge_of((direction - 2) % 3);
}

/// The largest bits for which has_gap(make_direction()) stays in 127 bits. With |differences| < D =
/// 2^bits, each coordinate itself the difference from a's first corner:
///   corner-corner: |d| < D, |projection| < 3 D^2 < 2^(2 bits + 2)
///   cross products: |d| < 2 D^2, |projection| < 6 D^3 < 2^(3 bits + 3)
///   perpendiculars: e.e, |w.e| < 3 D^2, |d| < 6 D^3, |projection| < 18 D^4 < 2^(4 bits + 5)
/// Sums that are still being formed are smaller than these bounds.
inline int most_bits(int direction) {
  if (direction >= 29) return 62;
  return direction < 11 ? 41 : 30;
}

}  // namespace farcull::integer
