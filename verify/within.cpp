// Two disjoint triangles have two closest points of which one is a corner, or of which each lies on
// an edge. For suppose that one point lies inside a face, and the other inside a face or an edge.
// Then this edge or face is parallel to the first face, and both points can be moved along it,
// keeping their difference, until one of them reaches an edge or a corner (Ericson, Real-Time
// Collision Detection, 2005, section 5.1.10). A degenerate triangle is the union of its edges.
#include "verify/within.h"

#include "verify/scaled.h"

namespace farcull {
namespace {

using Vector = std::array<mpz_class, 3>;
using Corners = Scaled::Corners;

Vector minus(const Vector& x, const Vector& y) { return {x[0] - y[0], x[1] - y[1], x[2] - y[2]}; }

mpz_class dot(const Vector& x, const Vector& y) { return x[0] * y[0] + x[1] * y[1] + x[2] * y[2]; }

Vector cross(const Vector& x, const Vector& y) {
  return {x[1] * y[2] - x[2] * y[1], x[2] * y[0] - x[0] * y[2], x[0] * y[1] - x[1] * y[0]};
}

/// The clearance of the question, in units of 2^exponent.
class Asked {
 public:
  Asked(double clearance, int exponent) : squared_(clearance) {
    if (exponent > 0) squared_ >>= static_cast<mp_bitcnt_t>(exponent);
    if (exponent < 0) squared_ <<= static_cast<mp_bitcnt_t>(-exponent);
    squared_ *= squared_;
  }
  /// True iff the squared distance x / y is within the clearance. Precondition: y > 0.
  bool holds(const mpz_class& x, const mpz_class& y = 1) const {
    return x * squared_.get_den() <= squared_.get_num() * y;
  }

 private:
  mpq_class squared_;
};

/// True iff the point w is within the clearance of the segment from 0 to u, which may be a point.
bool near_segment(const Vector& w, const Vector& u, const Asked& asked) {
  const mpz_class uu = dot(u, u), ww = dot(w, w), along = dot(w, u);
  if (along <= 0) return asked.holds(ww);
  if (along >= uu) return asked.holds(ww - 2 * along + uu);
  return asked.holds(ww * uu - along * along, uu);
}

/// True iff the segments p + [0, 1] u and q + [0, 1] v are within the clearance.
bool segments_within(const Vector& p, const Vector& u, const Vector& q, const Vector& v,
                     const Asked& asked) {
  const Vector w = minus(p, q);
  const Vector p_end = {w[0] + u[0], w[1] + u[1], w[2] + u[2]};
  const Vector back = {-w[0], -w[1], -w[2]};
  const Vector q_end = {back[0] + v[0], back[1] + v[1], back[2] + v[2]};
  if (near_segment(w, v, asked) || near_segment(p_end, v, asked)) return true;
  if (near_segment(back, u, asked) || near_segment(q_end, u, asked)) return true;
  // Else both closest points lie inside the segments, and their difference is perpendicular to
  // both.
  const mpz_class uu = dot(u, u);
  const mpz_class uv = dot(u, v);
  const mpz_class vv = dot(v, v);
  const mpz_class uw = dot(u, w);
  const mpz_class vw = dot(v, w);
  const mpz_class den = uu * vv - uv * uv;
  if (den == 0) return false;  // parallel: an end is as near
  const mpz_class s = uv * vw - vv * uw;
  const mpz_class t = uu * vw - uv * uw;
  if (s < 0 || s > den || t < 0 || t > den) return false;
  const Vector normal = cross(u, v);
  const mpz_class height = dot(normal, w);
  return asked.holds(height * height, den);  // |normal|^2 = den
}

/// True iff p lies over the face of t, within the clearance.
bool face_within(const Vector& p, const Corners& t, const Asked& asked) {
  const Vector normal = cross(minus(t[1], t[0]), minus(t[2], t[0]));
  const mpz_class nn = dot(normal, normal);
  if (nn == 0) return false;
  for (int i = 0; i < 3; ++i) {
    if (dot(normal, cross(minus(t[(i + 1) % 3], t[i]), minus(p, t[i]))) < 0) return false;
  }
  const mpz_class height = dot(normal, minus(p, t[0]));
  return asked.holds(height * height, nn);
}

}  // namespace

bool disjoint_within(const std::array<Vec3, 3>& a, const std::array<Vec3, 3>& b, double clearance) {
  const Scaled scaled(a, b);
  const Corners &s = scaled.a, &t = scaled.b;
  const Asked asked(clearance, scaled.exponent);
  for (int i = 0; i < 3; ++i) {
    if (face_within(s[i], t, asked) || face_within(t[i], s, asked)) return true;
  }
  for (int i = 0; i < 3; ++i) {
    const Vector u = minus(s[(i + 1) % 3], s[i]);
    for (int j = 0; j < 3; ++j) {
      if (segments_within(s[i], u, t[j], minus(t[(j + 1) % 3], t[j]), asked)) return true;
    }
  }
  return false;
}

}  // namespace farcull
