// Bounds the distances of pairs of triangles, one pair on each lane. The two closest points are
// guessed (Ericson, Real-Time Collision Detection, 2005, sections 5.1.5 and 5.1.9). Even a wrong
// guess proves two bounds: the distance of the points is an upper bound, and the direction between
// the points gives a lower bound (core/proximity/scene_trees.h).
#if defined(FARCULL_PROXIMITY_TRIANGLE_PAIRS_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef FARCULL_PROXIMITY_TRIANGLE_PAIRS_INL_H_
#undef FARCULL_PROXIMITY_TRIANGLE_PAIRS_INL_H_
#else
#define FARCULL_PROXIMITY_TRIANGLE_PAIRS_INL_H_
#endif

#include <hwy/highway.h>

#include "core/proximity/scene_trees.h"

HWY_BEFORE_NAMESPACE();
namespace farcull::HWY_NAMESPACE::proximity {

namespace hn = hwy::HWY_NAMESPACE;
using Numbers = hn::CappedTag<double, 8>;
using Number = hn::Vec<Numbers>;
using Mask = hn::Mask<Numbers>;
constexpr std::size_t kLanes = hn::MaxLanes(Numbers());
static_assert(kWide % kLanes == 0);

HWY_INLINE Number number(double x) { return hn::Set(Numbers(), x); }
HWY_INLINE Number clamped(Number x) { return hn::Max(number(0), hn::Min(x, number(1))); }
HWY_INLINE Number ratio(Number numerator, Number denominator) {
  return hn::IfThenElseZero(hn::Gt(denominator, number(0)), hn::Div(numerator, denominator));
}

struct Point {
  Number x, y, z;
};
HWY_INLINE Point operator-(const Point& a, const Point& b) {
  return {hn::Sub(a.x, b.x), hn::Sub(a.y, b.y), hn::Sub(a.z, b.z)};
}
HWY_INLINE Point operator+(const Point& a, const Point& b) {
  return {hn::Add(a.x, b.x), hn::Add(a.y, b.y), hn::Add(a.z, b.z)};
}
HWY_INLINE Point times(const Point& a, Number k) {
  return {hn::Mul(a.x, k), hn::Mul(a.y, k), hn::Mul(a.z, k)};
}
HWY_INLINE Number dot(const Point& a, const Point& b) {
  return hn::Add(hn::Add(hn::Mul(a.x, b.x), hn::Mul(a.y, b.y)), hn::Mul(a.z, b.z));
}
HWY_INLINE Point cross(const Point& a, const Point& b) {
  return {hn::Sub(hn::Mul(a.y, b.z), hn::Mul(a.z, b.y)),
          hn::Sub(hn::Mul(a.z, b.x), hn::Mul(a.x, b.z)),
          hn::Sub(hn::Mul(a.x, b.y), hn::Mul(a.y, b.x))};
}

/// Barycentric weights of corners 1 and 2 for a point of a triangle. Corner 0 has the rest.
struct Weights {
  Number one, two;
};
HWY_INLINE Weights at_corner(int k) { return {number(k == 1), number(k == 2)}; }
/// Returns the weights of the point at fraction t (0 to 1) of the edge from corner k to the next
/// corner.
HWY_INLINE Weights on_edge(int k, Number t) {
  const Number rest = hn::Sub(number(1), t);
  if (k == 0) return {t, number(0)};
  return k == 1 ? Weights{rest, t} : Weights{number(0), rest};
}
HWY_INLINE Weights chosen(Mask mask, const Weights& yes, const Weights& no) {
  return {hn::IfThenElse(mask, yes.one, no.one), hn::IfThenElse(mask, yes.two, no.two)};
}

struct LaneTriangle {
  Point corner[3];
  Point edge[3];      // from each corner to the next
  Number squared[3];  // the edges' squared lengths
  // Dot products and Gram determinant of e (edge 0) and f (from corner 0 to corner 2).
  Number ee, ef, ff, determinant;

  HWY_INLINE LaneTriangle(const CornerColumns& columns, std::size_t from, const Point& origin)
      : LaneTriangle(load(columns, 0, from) - origin, load(columns, 1, from) - origin,
                     load(columns, 2, from) - origin) {}
  HWY_INLINE static Point load(const CornerColumns& columns, std::size_t corner, std::size_t from) {
    const Numbers n;
    return {hn::Load(n, &columns[3 * corner][from]), hn::Load(n, &columns[3 * corner + 1][from]),
            hn::Load(n, &columns[3 * corner + 2][from])};
  }
  HWY_INLINE Point at(const Weights& w) const {
    const Number zero = number(0);
    const Number rest = hn::Max(hn::Sub(hn::Sub(number(1), w.one), w.two), zero);
    return times(corner[0], rest) + times(corner[1], w.one) + times(corner[2], w.two);
  }

 private:
  HWY_INLINE LaneTriangle(const Point& p, const Point& q, const Point& r)
      : corner{p, q, r}, edge{q - p, r - q, p - r} {
    for (int k = 0; k < 3; ++k) squared[k] = dot(edge[k], edge[k]);
    ee = squared[0];
    ff = squared[2];
    ef = hn::Neg(dot(edge[0], edge[2]));
    determinant = hn::Sub(hn::Mul(ee, ff), hn::Mul(ef, ef));
  }
};

class Guess {
 public:
  HWY_INLINE Guess(const LaneTriangle& a, const LaneTriangle& b)
      : a_(a),
        b_(b),
        squared_(number(std::numeric_limits<double>::infinity())),
        on_a_(at_corner(0)),
        on_b_(at_corner(0)) {
    for (int i = 0; i < 3; ++i) {
      for (int j = 0; j < 3; ++j) offer_edges(i, j);
    }
    for (int k = 0; k < 3; ++k) {
      offer_face(a_.corner[k], at_corner(k), b_, on_a_, on_b_);
      offer_face(b_.corner[k], at_corner(k), a_, on_b_, on_a_);
    }
  }
  HWY_INLINE void offer_piercings() {
    for (int k = 0; k < 3; ++k) {
      offer_piercing(a_, k, b_, on_a_, on_b_);
      offer_piercing(b_, k, a_, on_b_, on_a_);
    }
  }
  HWY_INLINE Point difference() const { return b_.at(on_b_) - a_.at(on_a_); }

 private:
  HWY_INLINE void offer(const Point& difference, Mask counts, const Weights& own,
                        const Weights& other, Weights& own_best, Weights& other_best) {
    const Number squared = dot(difference, difference);
    const Mask better = hn::And(counts, hn::Lt(squared, squared_));
    squared_ = hn::IfThenElse(better, squared, squared_);
    own_best = chosen(better, own, own_best);
    other_best = chosen(better, other, other_best);
  }
  // Offers the nearest points of two edges as closest points. Starts with the nearest points of
  // their lines. Then takes, on each edge, the point nearest to the chosen point of the other edge.
  HWY_INLINE void offer_edges(int i, int j) {
    const Point &u = a_.edge[i], &v = b_.edge[j];
    const Point w = a_.corner[i] - b_.corner[j];
    const Number uu = a_.squared[i], vv = b_.squared[j];
    const Number uv = dot(u, v), uw = dot(u, w), vw = dot(v, w);
    const Number first = clamped(ratio(hn::Sub(hn::Mul(uv, vw), hn::Mul(vv, uw)),
                                       hn::Sub(hn::Mul(uu, vv), hn::Mul(uv, uv))));
    const Number t = clamped(ratio(hn::Add(hn::Mul(uv, first), vw), vv));
    const Number s = clamped(ratio(hn::Sub(hn::Mul(uv, t), uw), uu));
    const Point difference = w + times(u, s) - times(v, t);
    offer(difference, hn::Eq(s, s), on_edge(i, s), on_edge(j, t), on_a_, on_b_);
  }
  // Offers a corner and its projection on the face's plane, if the projection is in the face.
  HWY_INLINE void offer_face(const Point& p, const Weights& corner, const LaneTriangle& face,
                             Weights& own_best, Weights& other_best) {
    const Point w = p - face.corner[0];
    Mask inside;
    const Weights foot = over(w, face, inside);
    const Point difference = w - times(face.edge[0], foot.one) + times(face.edge[2], foot.two);
    offer(difference, inside, corner, foot, own_best, other_best);
  }
  // Offers the point where an edge crosses the face's plane, if that point is in the face.
  HWY_INLINE void offer_piercing(const LaneTriangle& own, int k, const LaneTriangle& face,
                                 Weights& own_best, Weights& other_best) {
    const Point normal = cross(face.edge[2], face.edge[0]);
    const Point w = own.corner[k] - face.corner[0];
    const Number at = dot(normal, w), slope = dot(normal, own.edge[k]);
    // t = -at / slope, computed with a positive denominator.
    const Mask falls = hn::Lt(slope, number(0));
    const Number t = clamped(ratio(hn::IfThenElse(falls, at, hn::Neg(at)), hn::Abs(slope)));
    const Point p = w + times(own.edge[k], t);
    Mask inside;
    const Weights foot = over(p, face, inside);
    const Point difference = p - times(face.edge[0], foot.one) + times(face.edge[2], foot.two);
    offer(difference, inside, on_edge(k, t), foot, own_best, other_best);
  }
  // Returns the weights of the projection of w on the face's plane. w is relative to the face's
  // corner 0. Sets `inside` on the lanes whose projection is in the face.
  HWY_INLINE static Weights over(const Point& w, const LaneTriangle& face, Mask& inside) {
    const Number zero = number(0), det = face.determinant;
    const Number ew = dot(face.edge[0], w), fw = hn::Neg(dot(face.edge[2], w));
    const Number one = ratio(hn::Sub(hn::Mul(face.ff, ew), hn::Mul(face.ef, fw)), det);
    const Number two = ratio(hn::Sub(hn::Mul(face.ee, fw), hn::Mul(face.ef, ew)), det);
    inside = hn::And(hn::And(hn::Gt(det, zero), hn::Le(hn::Add(one, two), number(1))),
                     hn::And(hn::Ge(one, zero), hn::Ge(two, zero)));
    return {one, two};
  }

  const LaneTriangle& a_;
  const LaneTriangle& b_;
  Number squared_;
  Weights on_a_, on_b_;
};

/// Computes the bounds of the distance that core/proximity/scene_trees.h derives.
class Proof {
 public:
  HWY_INLINE Proof(const LaneTriangle& a, const LaneTriangle& b) : a_(a), b_(b) {
    most_ = {number(0), number(0), number(0)};
    for (const LaneTriangle* t : {&a, &b}) {
      for (const Point& p : t->corner) {
        most_ = {hn::Max(most_.x, hn::Abs(p.x)), hn::Max(most_.y, hn::Abs(p.y)),
                 hn::Max(most_.z, hn::Abs(p.z))};
      }
    }
  }
  HWY_INLINE void bound(const Point& d, Number& lower, Number& upper) const {
    const Number squared = dot(d, d), least_square = number(near::kLeastSquare);
    const Number length = hn::Sqrt(hn::Max(squared, least_square));
    const Number most = hn::Max(hn::Max(most_.x, most_.y), most_.z);
    const Number absolute = number(near::kAbsolute);
    upper = hn::Add(hn::Add(length, hn::Mul(most, number(near::kPoint))), absolute);
    const Number a_most =
        hn::Max(hn::Max(dot(d, a_.corner[0]), dot(d, a_.corner[1])), dot(d, a_.corner[2]));
    const Number b_least =
        hn::Min(hn::Min(dot(d, b_.corner[0]), dot(d, b_.corner[1])), dot(d, b_.corner[2]));
    const Number doubt =
        hn::Add(hn::Mul(number(near::kGap), dot({hn::Abs(d.x), hn::Abs(d.y), hn::Abs(d.z)}, most_)),
                absolute);
    const Number gap = hn::Sub(hn::Sub(b_least, a_most), doubt);
    // The factor 1 - 8 u covers the roundings of the gap, of the length (3 u) and of the quotient.
    const Number quotient = hn::Mul(hn::Div(gap, length), number(1 - 8 * near::kUnit));
    lower = hn::IfThenElseZero(hn::Ge(squared, least_square), hn::Max(quotient, number(0)));
  }

 private:
  const LaneTriangle& a_;
  const LaneTriangle& b_;
  Point most_;
};

/// The sign of a determinant. Both masks are false on a lane whose sign is uncertain.
struct Sign {
  Mask positive, negative;
};
HWY_INLINE Sign sign_of_determinant(const Point& a, const Point& b, const Point& c) {
  const auto products = [](const Point& p, const Point& q, const Point& r, auto join) {
    const auto term = [&](Number x, Number y, Number z, Number v, Number w) {
      return hn::Mul(x, join(hn::Mul(y, z), hn::Mul(v, w)));
    };
    return hn::Add(hn::Add(term(p.x, q.y, r.z, q.z, r.y), term(p.y, q.z, r.x, q.x, r.z)),
                   term(p.z, q.x, r.y, q.y, r.x));
  };
  const auto magnitude = [](const Point& p) {
    return Point{hn::Abs(p.x), hn::Abs(p.y), hn::Abs(p.z)};
  };
  const Number value = products(a, b, c, [](Number x, Number y) { return hn::Sub(x, y); });
  const Number sum = products(magnitude(a), magnitude(b), magnitude(c),
                              [](Number x, Number y) { return hn::Add(x, y); });
  const Number doubt = hn::Add(hn::Mul(sum, number(near::kDeterminant)), number(near::kAbsolute));
  return {hn::Gt(value, doubt), hn::Lt(value, hn::Neg(doubt))};
}

/// True on lanes where an edge of one triangle certainly passes through the other triangle.
HWY_INLINE Mask meet_for_certain(const PairBatch& batch, std::size_t from) {
  Point a[3], b[3];
  for (std::size_t k = 0; k < 3; ++k) {
    a[k] = LaneTriangle::load(batch.a, k, from);
    b[k] = LaneTriangle::load(batch.b, k, from);
  }
  Sign a_side[3], b_side[3], passes[3][3];
  for (int k = 0; k < 3; ++k) {
    a_side[k] = sign_of_determinant(a[k] - b[0], b[1] - b[0], b[2] - b[0]);
    b_side[k] = sign_of_determinant(b[k] - a[0], a[1] - a[0], a[2] - a[0]);
    for (int j = 0; j < 3; ++j) {
      // Orientation of edge k of a and edge j of b. Exchanging the edges gives the same sign.
      passes[k][j] = sign_of_determinant(a[(k + 1) % 3] - a[k], b[j] - a[k], b[(j + 1) % 3] - a[k]);
    }
  }
  const auto across = [](const Sign& p, const Sign& q) {
    return hn::Or(hn::And(p.positive, q.negative), hn::And(p.negative, q.positive));
  };
  const auto inside = [](const Sign& p, const Sign& q, const Sign& r) {
    return hn::Or(hn::And(p.positive, hn::And(q.positive, r.positive)),
                  hn::And(p.negative, hn::And(q.negative, r.negative)));
  };
  const Number zero = number(0);
  Mask out = hn::Lt(zero, zero);
  for (int k = 0; k < 3; ++k) {
    const int next = (k + 1) % 3;
    out = hn::Or(out, hn::And(across(a_side[k], a_side[next]),
                              inside(passes[k][0], passes[k][1], passes[k][2])));
    out = hn::Or(out, hn::And(across(b_side[k], b_side[next]),
                              inside(passes[0][k], passes[1][k], passes[2][k])));
  }
  return out;
}

/// Bounds the distance of each pair of a batch. Lanes after the last pair get arbitrary numbers.
HWY_INLINE void bound_batch(const PairBatch& batch, BatchBounds& out) {
  const Numbers n;
  for (std::size_t from = 0; from < batch.count; from += kLanes) {
    const Point origin = LaneTriangle::load(batch.a, 0, from);
    const LaneTriangle a(batch.a, from, origin), b(batch.b, from, origin);
    const Proof proof(a, b);
    Guess guess(a, b);
    Point d = guess.difference();
    Number lower, upper;
    proof.bound(d, lower, upper);
    // If the triangles of a pair are apart, no edge pierces a face. Such a pair keeps its bounds,
    // so that its bounds do not depend on other pairs of the batch.
    const Mask apart = hn::Gt(lower, number(0));
    if (!hn::AllTrue(n, apart)) {
      guess.offer_piercings();
      const Point piercing = guess.difference();
      Number piercing_lower, piercing_upper;
      proof.bound(piercing, piercing_lower, piercing_upper);
      lower = hn::IfThenElse(apart, lower, piercing_lower);
      upper = hn::IfThenElse(apart, upper, piercing_upper);
      upper = hn::IfThenElse(hn::AndNot(apart, meet_for_certain(batch, from)), number(0), upper);
      d = {hn::IfThenElse(apart, d.x, piercing.x), hn::IfThenElse(apart, d.y, piercing.y),
           hn::IfThenElse(apart, d.z, piercing.z)};
    }
    hn::Store(lower, n, &out.lower[from]);
    hn::Store(upper, n, &out.upper[from]);
    hn::Store(d.x, n, &out.direction[0][from]);
    hn::Store(d.y, n, &out.direction[1][from]);
    hn::Store(d.z, n, &out.direction[2][from]);
  }
}

}  // namespace farcull::HWY_NAMESPACE::proximity
HWY_AFTER_NAMESPACE();

#endif
