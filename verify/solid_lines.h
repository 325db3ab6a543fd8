// Checks a kernel's answer about a solid: the answer must contain the interval in which a line
// along z lies in the solid. The floats of a Solid define the solid exactly.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>

#include "core/canvas/canvas.h"
#include "verify/rational.h"

namespace farcull::box_line {

// The solid here is an oriented box, as the floats of a Solid define it (offsets/obb.glsl): three
// slabs |a . (p - m)| <= h, cut by zlo <= z <= zhi. The line is along z through (cx, cy).

using rational::Draws;
using rational::Q;

template <typename Number>
struct Interval {
  Number lo, hi;
};

/// Returns the solid's interval along the line, without rounding; none if the line misses the
/// solid.
inline std::optional<Interval<Q>> exact_interval(float cx, float cy, const Solid& s) {
  Interval<Q> z{Q(s[0][3]), Q(s[4][0])};
  for (int i = 1; i <= 3; ++i) {
    const Q at = Q(s[i][0]) * (Q(cx) - Q(s[0][0])) + Q(s[i][1]) * (Q(cy) - Q(s[0][1]));
    const Q h(s[i][3]), a(s[i][2]);
    if (a == 0) {
      if (abs(at) > h) return std::nullopt;
      continue;
    }
    Q z0 = Q(s[0][2]) + (-h - at) / a, z1 = Q(s[0][2]) + (h - at) / a;
    if (a < 0) std::swap(z0, z1);
    z.lo = std::max(z.lo, z0);
    z.hi = std::min(z.hi, z1);
  }
  if (z.lo > z.hi) return std::nullopt;
  return z;
}

/// Returns the interval in doubles, a little too large; none if the line certainly misses the
/// solid. Products of floats are exact in double. Each difference and sum is off by 2^-53 of the
/// magnitudes of its terms. 2^-49 is more than all of these errors together.
inline std::optional<Interval<double>> outer_interval(float cx, float cy, const Solid& s) {
  Interval<double> z{s[0][3], s[4][0]};
  for (int i = 1; i <= 3; ++i) {
    const double x = double(s[i][0]) * (double(cx) - s[0][0]);
    const double y = double(s[i][1]) * (double(cy) - s[0][1]);
    const double at = x + y, h = s[i][3], a = s[i][2];
    const double e = 0x1p-49 * (std::abs(x) + std::abs(y) + h) + 0x1p-1000;
    if (a == 0) {
      if (std::abs(at) > h + e) return std::nullopt;
      continue;
    }
    double z0 = (-h - at) / a, z1 = (h - at) / a;
    if (a < 0) std::swap(z0, z1);
    const double f =
        e / std::abs(a) + 0x1p-49 * (std::abs(z0) + std::abs(z1) + std::abs(double(s[0][2])));
    z.lo = std::max(z.lo, s[0][2] + z0 - f);
    z.hi = std::min(z.hi, s[0][2] + z1 + f);
  }
  if (z.lo > z.hi) return std::nullopt;
  return z;
}

inline float number(double x) { return static_cast<float>(x); }

/// Returns a solid whose floats are drawn directly, not computed from a triangle. Its slabs may be
/// nearly parallel to the line, thin or thick, with zeros and subnormals in their normals. The
/// middle of the slabs may be far away. The line passes through the solid or close to its border.
inline Solid adversarial_at(Draws& random, float cx, float cy) {
  Solid s{};
  const double far = random.below(3) == 0 ? 1e9 : 1000;
  s[0] = {number(cx + random.scaled(-2, 8)), number(cy + random.scaled(-2, 8)),
          number(random.uniform(-far, far)), 0};
  if (random.below(10) == 0) s[0][random.below(3)] = 0;
  for (int i = 1; i <= 3; ++i) {
    const Vec3 a = random.cube(1).normalized();
    for (int k = 0; k < 3; ++k) s[i][k] = number(a[k]);
    const int change = random.below(8);
    if (change == 0) s[i][2] = 0;
    if (change == 1) s[i][2] = number(random.sign() * 0x1p-20 * random.uniform(0.99, 1.01));
    if (change == 2) s[i][2] = std::nextafter(0x1p-20f, random.coin() ? 0.f : 1.f);
    if (change == 3) s[i][2] = number(random.scaled(-149, -18));
    if (change == 4) s[i][random.below(3)] = number(random.scaled(-149, -100));
    if (change == 5) s[i][random.below(2)] = 0;
    // Chooses the half thickness h; the slab's border is often close to the line.
    const double at =
        double(s[i][0]) * (double(cx) - s[0][0]) + double(s[i][1]) * (double(cy) - s[0][1]);
    double h = std::abs(random.scaled(-10, 10));
    if (random.coin()) h = std::abs(at) * (1 + random.scaled(-30, -18));
    if (random.below(4) == 0) h = std::abs(at + s[i][2] * random.uniform(-far, far) * 0.01);
    s[i][3] = std::max(number(h), 0.f);
  }
  const double thick = std::abs(random.scaled(-6, 12));
  double mid = s[0][2] + random.scaled(-6, 8);
  s[0][3] = number(mid - thick);
  s[4][0] = std::max(number(mid + thick), s[0][3]);
  if (random.below(4) == 0) {  // zlo and zhi cut nothing off the slabs
    s[0][3] = number(-2 * far);
    s[4][0] = number(2 * far);
  }
  return s;
}

}  // namespace farcull::box_line

namespace farcull::minkowski_line {

// The solid here is a triangle fattened by a ball, as the floats of a Solid define it
// (offsets/minkowski.glsl). Let m be the solid's centre, and v0, v1, v2 its corners relative to m.
// The line is along z through c in the image; d = c - m. The ball about a point p of the triangle
// cuts the line in the chord m.z + p.z +- root, with root = sqrt(r^2 - |d - p.xy|^2). The solid's
// interval is the hull of all chords. So a kernel's answer has to contain every chord. Long doubles
// decide this for most points, and rationals for the other points.

using rational::Q;
using Real = long double;
using Real3 = std::array<Real, 3>;
// The error bounds below assume that an operation on Real rounds by at most 2^-64 of its result.
static_assert(std::numeric_limits<Real>::digits >= 64);
using Kernel = bool (*)(float cx, float cy, const Solid& solid, float& entry, float& exit);

/// The point p = v0 + w1 (v1 - v0) + w2 (v2 - v0). w1 and w2 are multiples of 2^-62, and
/// w1, w2 >= 0 and w1 + w2 <= 1 hold exactly, so p is in the triangle.
struct Weights {
  Real w1, w2;
};

inline Weights weights(Real w1, Real w2) {
  const auto grid = [](Real w) { return std::floor(w * 0x1p62L) * 0x1p-62L; };
  const Real first = grid(std::clamp<Real>(w1, 0, 1));
  return {first, grid(std::clamp<Real>(w2, 0, 1 - first))};
}

/// Returns the weights of the point at fraction t along an edge.
inline Weights on_edge(int edge, Real t) {
  t = weights(t, 0).w1;
  return edge == 0 ? Weights{t, 0} : edge == 1 ? Weights{1 - t, t} : Weights{0, 1 - t};
}

/// The part of the line in the ball about one point.
struct Chord {
  Real square;    // square of the half-length; negative: the line misses the ball
  Real lo, hi;    // depths of the chord's ends if square >= 0
  Real doubt;     // bounds the error of lo and hi
  Real no_chord;  // if square < -no_chord, the line certainly misses the ball
};

class Line {
 public:
  Line(const Solid& s, float cx, float cy)
      : dx_(Real(cx) - s[0][0]), dy_(Real(cy) - s[0][1]), mz_(s[0][2]), r_(s[1][3]) {
    for (int i = 0; i < 3; ++i) {
      for (int k = 0; k < 3; ++k) {
        v_[i][k] = s[1 + i][k];
        (k < 2 ? flat_ : deep_) = std::max(k < 2 ? flat_ : deep_, std::abs(v_[i][k]));
      }
    }
    flat_ += std::abs(dx_) + std::abs(dy_) + r_;
    deep_ += std::abs(mz_) + r_;
  }

  /// Returns the chord in the ball around a point. A dozen operations each err by 2^-64 of the
  /// largest coordinate. So x and y are off by at most 2^-56 flat_, and z by 2^-56 deep_.
  Chord chord(const Weights& w) const {
    Real3 p;
    for (int k = 0; k < 3; ++k)
      p[k] = v_[0][k] + w.w1 * (v_[1][k] - v_[0][k]) + w.w2 * (v_[2][k] - v_[0][k]);
    const Real x = p[0] - dx_, y = p[1] - dy_;
    Chord out{};
    out.square = r_ * r_ - x * x - y * y;
    // x and y are the differences from the line in the image. Where `square` is near 0, |x| and |y|
    // are at most r. Their errors are at most 2^-56 of `flat`.
    const Real e = 0x1p-56L * flat_;
    out.no_chord = 8 * e * (r_ + e) + 0x1p-56L * r_ * r_ + 0x1p-300L;
    const Real root = std::sqrt(std::max<Real>(out.square, 0));
    out.lo = mz_ + p[2] - root;
    out.hi = mz_ + p[2] + root;
    // |sqrt(a) - sqrt(b)| <= min(sqrt|a - b|, |a - b| / sqrt(a)).
    const Real step = std::sqrt(2 * out.no_chord);
    out.doubt = 0x1p-56L * deep_ + (root > 0 ? std::min(step, 2 * out.no_chord / root) : step);
    return out;
  }

  /// Finds the place where the line enters the solid (sign -1) or leaves it (sign 1): the best of
  /// the three corners, the contacts with the cylinders of the three edges, and the contact with
  /// the face. Writes the place's depth to `depth`. Returns false if the line misses the solid.
  bool contact(int sign, Weights& best, Real& depth) const {
    bool found = false;
    const auto offer = [&](const Weights& w) {
      const Chord c = chord(w);
      if (c.square < 0) return;
      const Real z = sign < 0 ? c.lo : c.hi;
      if (found && sign * z <= sign * depth) return;
      found = true;
      depth = z;
      best = w;
    };
    for (int edge = 0; edge < 3; ++edge) {
      offer(on_edge(edge, 0));
      const Real3 &a = v_[edge], &b = v_[(edge + 1) % 3];
      const Real fx = b[0] - a[0], fy = b[1] - a[1], fz = b[2] - a[2];
      const Real px = a[0] - dx_, py = a[1] - dy_, along2 = fx * fx + fy * fy;
      if (along2 == 0) continue;
      const Real cross = px * fy - py * fx, rho2 = r_ * r_ - cross * cross / along2;
      const Real foot = -(px * fx + py * fy) / along2;
      offer(on_edge(edge, foot));
      if (rho2 < 0) continue;
      offer(on_edge(edge,
                    foot + sign * fz * std::sqrt(rho2 / (along2 + fz * fz)) / std::sqrt(along2)));
    }
    using closest::cross, closest::dot;
    const Real3 u = closest::minus(v_[1], v_[0]), v = closest::minus(v_[2], v_[0]);
    const Real3 n = cross(u, v);
    const Real size2 = dot(n, n);
    if (size2 == 0 || n[2] == 0) return found;
    const Real scale = sign * (n[2] > 0 ? 1 : -1) / std::sqrt(size2);
    const Real qx = dx_ - v_[0][0], qy = dy_ - v_[0][1];
    const Real qz = (r_ / scale - n[0] * qx - n[1] * qy) / n[2];
    const Real3 q = {qx - r_ * scale * n[0], qy - r_ * scale * n[1], qz - r_ * scale * n[2]};
    offer(weights(dot(cross(q, v), n) / size2, dot(cross(u, q), n) / size2));
    return found;
  }

  /// Returns the distance in the image from the line to the triangle; 0 if inside.
  Real distance() const {
    Real nearest = HUGE_VALL;
    int turns[3];
    for (int edge = 0; edge < 3; ++edge) {
      const Real3 &a = v_[edge], &b = v_[(edge + 1) % 3];
      const Real fx = b[0] - a[0], fy = b[1] - a[1], px = a[0] - dx_, py = a[1] - dy_;
      const Real along2 = fx * fx + fy * fy, turn = px * fy - py * fx;
      turns[edge] = turn > 0 ? 1 : turn < 0 ? -1 : 0;
      const Real t = along2 > 0 ? std::clamp<Real>(-(px * fx + py * fy) / along2, 0, 1) : 0;
      nearest = std::min(nearest, std::hypot(px + t * fx, py + t * fy));
    }
    return turns[0] != 0 && turns[0] == turns[1] && turns[1] == turns[2] ? 0 : nearest;
  }

  Real radius() const { return r_; }

 private:
  Real dx_, dy_, mz_, r_;
  std::array<Real3, 3> v_;
  Real flat_ = 0, deep_ = 0;
};

using Answer = SolidAnswer;

inline Answer answer(Kernel kernel, float cx, float cy, const Solid& solid) {
  Answer a{};
  a.hit = kernel(cx, cy, solid, a.entry, a.exit);
  return a;
}

/// True if the chord in the sphere around the point with weights w, clipped to [zlo, zhi], extends
/// beyond the answer. Nothing is rounded.
inline bool violates(const Solid& s, float cx, float cy, const Weights& w, const Answer& answer) {
  const auto rational = [](Real x) {
    const double high = static_cast<double>(x);
    return Q(Q(high) + Q(static_cast<double>(x - high)));
  };
  const Q w1 = rational(w.w1), w2 = rational(w.w2), zlo(s[0][3]), zhi(s[2][3]), r(s[1][3]);
  Q p[3];
  for (int k = 0; k < 3; ++k) {
    const Q v0(s[1][k]);
    p[k] = Q(s[0][k]) + v0 + w1 * (Q(s[2][k]) - v0) + w2 * (Q(s[3][k]) - v0);
  }
  const Q x = Q(cx) - p[0], y = Q(cy) - p[1], square = r * r - x * x - y * y;
  if (square < 0) return false;
  // Depths on the line that the solid may contain: the chord's middle and the two cuts.
  const Q* const depths[] = {&p[2], &zlo, &zhi};
  for (const Q* z : depths) {
    const Q off = *z - p[2];
    if (*z < zlo || *z > zhi || off * off > square) continue;
    if (!answer.hit || *z < Q(answer.entry) || *z > Q(answer.exit)) return true;
  }
  if (!answer.hit) return false;
  // If an end of the answer lies strictly inside the chord and between the cuts, the chord extends
  // beyond the answer.
  const auto strictly_inside = [&](const Q& z) {
    const Q off = z - p[2];
    return off * off < square;
  };
  const Q entry(answer.entry), exit(answer.exit);
  return (entry > zlo && entry <= zhi && strictly_inside(entry)) ||
         (exit < zhi && exit >= zlo && strictly_inside(exit));
}

/// False only if the answer certainly contains the chord. Computed in long doubles.
inline bool doubtful(const Solid& s, const Chord& c, const Answer& answer) {
  if (c.square < -c.no_chord) return false;
  if (c.hi + c.doubt < s[0][3] || c.lo - c.doubt > s[2][3]) return false;
  if (!answer.hit) return true;
  const bool entry_held = answer.entry <= s[0][3] || answer.entry <= c.lo - c.doubt;
  const bool exit_held = answer.exit >= s[2][3] || answer.exit >= c.hi + c.doubt;
  return !entry_held || !exit_held;
}

struct Tally {
  long checks = 0, rationals = 0, violations = 0;
};

inline void check(const Line& line, const Solid& s, float cx, float cy, const Weights& w,
                  const Answer& a, Tally& tally) {
  ++tally.checks;
  if (!doubtful(s, line.chord(w), a)) return;
  ++tally.rationals;
  tally.violations += violates(s, cx, cy, w, a);
}

/// Checks an answer where it is most likely to fail: at the contacts.
inline void check_contacts(const Line& line, const Solid& s, float cx, float cy, const Answer& a,
                           Tally& tally) {
  for (const int sign : {-1, 1}) {
    Weights w{};
    Real depth = 0;
    if (line.contact(sign, w, depth)) check(line, s, cx, cy, w, a, tally);
  }
}

}  // namespace farcull::minkowski_line
