// Test cases that are hard for the kernels (verify/kernel_check.h).
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <vector>

#include "core/canvas/kernel_case.h"
#include "verify/rational.h"
#include "verify/solid_lines.h"

namespace farcull::interval_cases {

// Triangles and pixels that are hard for the kernel of FAR pairs (core/pairs/interval.glsl), and
// the real triangles that a triangle of floats may stand for.

using rational::Draws;
using rational::Q;
using rational::Q3;
using FloatTriangle = std::array<std::array<float, 3>, 3>;

inline float usable(double x) { return std::abs(x) < 0x1p-60 ? 0.f : static_cast<float>(x); }

// A random triangle of one of the kinds that have been hard.
inline FloatTriangle random_triangle(Draws& random) {
  const double reach = std::exp2(random.uniform(2, random.below(8) == 0 ? 20 : 12));
  const Vec3 at(random.uniform(0, reach), random.uniform(0, reach), random.uniform(-reach, reach));
  const double size = std::exp2(random.uniform(-6, 4));
  std::array<Vec3, 3> t;
  for (Vec3& p : t) p = at + random.cube(size);
  const Vec3 along = random.cube(1).normalized();
  switch (random.below(9)) {
    case 0:  // needles
      t[1] = t[0] + 40 * size * along;
      t[2] = t[1] + random.scaled3(-24, -8);
      break;
    case 1:  // corners at the centres, borders and corners of pixels
      for (Vec3& p : t) {
        p = p.array().round() + 0.5 * random.below(2);
        if (random.coin()) p += random.scaled3(-24, -12);
      }
      break;
    case 2:  // the plane all but contains the view
      t[2].head<2>() = t[0].head<2>() + random.uniform(-2, 3) * (t[1] - t[0]).head<2>() +
                       random.scaled3(-28, -16).head<2>();
      t[2].z() += random.scaled(0, 6);
      break;
    case 3:  // segments and points
      t[2] = t[random.below(2)];
      if (random.below(4) == 0) t[1] = t[0];
      break;
    case 4:  // edges all but along a row or a column
      t[1][random.below(2)] = t[0][0] + random.scaled(-26, -14);
      t[1].y() = std::nextafter(t[0].y(), random.sign() * 1e30);
      break;
    case 5:  // an edge on the border of a pixel
      t[0].y() = t[1].y() = std::round(t[0].y());
      break;
    case 6:  // a corner on the border, the others on both sides
      t[0].y() = std::round(t[0].y());
      t[1].y() = t[0].y() + random.uniform(0, size);
      t[2].y() = t[0].y() - random.uniform(0, size);
      break;
    default:
      break;
  }
  FloatTriangle out;
  for (int k = 0; k < 3; ++k) {
    for (int axis = 0; axis < 3; ++axis) {
      out[k][axis] = usable(std::clamp(t[k][axis], -0x1p20, 0x1p20));
    }
  }
  return out;
}

/// A case with one of the nine pixels around a point of the triangle. The corners of the real
/// triangle are mostly as far from the floats as the widening allows.
inline IntervalCase random_case(Draws& random) {
  IntervalCase out{};
  out.corners = random_triangle(random);
  out.widening = static_cast<float>(
      random.coin() ? 0x1p-40 : std::exp2(random.uniform(-12, random.below(4) == 0 ? 4 : -2)));
  const bool together = random.coin();
  std::array<std::int8_t, 3> all{};
  for (std::int8_t& s : all) s = static_cast<std::int8_t>(random.below(3) - 1);
  for (auto& corner : out.shift) {
    for (int axis = 0; axis < 3; ++axis)
      corner[axis] = together ? all[axis] : static_cast<std::int8_t>(random.below(3) - 1);
  }
  const int k = random.below(3);
  const double mix = random.coin() ? 0 : random.uniform(0, 1);
  const FloatTriangle& t = out.corners;
  const auto near = [&](int axis) {
    return static_cast<std::int32_t>(
               std::floor(t[k][axis] + mix * (t[(k + 1) % 3][axis] - t[k][axis]))) +
           random.below(3) - 1;
  };
  out.i = near(0);
  out.j = near(1);
  return out;
}

/// The real triangle of the case.
inline std::vector<Q3> real_triangle(const IntervalCase& c) {
  std::vector<Q3> out(3);
  for (int k = 0; k < 3; ++k) {
    for (int axis = 0; axis < 3; ++axis) {
      const double room = c.widening + 0x1p-24 * std::abs(c.corners[k][axis]);
      out[k][axis] = Q(c.corners[k][axis]) + c.shift[k][axis] * Q(room);
    }
  }
  return out;
}

/// The part of a triangle in columns i0 .. i1 and rows j0 .. j1 of the image (px).
inline std::vector<Q3> part_in(const std::vector<Q3>& triangle, const Q& i0, const Q& i1,
                               const Q& j0, const Q& j1) {
  using rational::clipped;
  return clipped(clipped(clipped(clipped(triangle, 1, -1, j0), 1, 1, j1), 0, -1, i0), 0, 1, i1);
}

}  // namespace farcull::interval_cases

namespace farcull::minkowski_cases {

// Triangles, lines and solids that are hard for the exact offset.

using minkowski_line::Weights;
using rational::Draws;
using Triangle = std::array<Vec3, 3>;

inline constexpr const char* kKinds[] = {
    "ordinary",      "needle",           "edge-on",       "nearly edge-on", "flat",
    "vertical edge", "segment",          "point",         "huge z",         "tiny",
    "needle end-on", "halves of pixels", "nearly a line", "far and small"};
inline constexpr int kKindCount = static_cast<int>(std::size(kKinds));

inline Triangle random_triangle(Draws& random, int kind) {
  const Vec3 at = random.cube(500);
  const auto all = [&](const std::function<Vec3(int)>& corner) {
    return Triangle{at + corner(0), at + corner(1), at + corner(2)};
  };
  const double slope = random.uniform(0, 6.3);
  const Vec3 across(std::cos(slope), std::sin(slope), 0);
  switch (kind) {
    case 0:
      return all([&](int) { return random.cube(20); });
    case 1: {  // aspect 1e3 .. 1e12
      const Vec3 e = random.scaled3(0, 9);
      const double thin = e.norm() * std::pow(10, -random.uniform(3, 12));
      return {at - e, at + e, at + e * random.uniform(-1, 1) + random.cube(thin)};
    }
    case 2:
    case 3: {
      const double off = kind == 2 ? 0 : std::abs(random.scaled(-50, -4));
      return all([&](int) {
        return Vec3(across * random.uniform(-20, 20) + Vec3(0, 0, random.uniform(-20, 20)) +
                    random.cube(off));
      });
    }
    case 4: {
      const double off = random.coin() ? 0 : std::abs(random.scaled(-50, -4));
      return all([&](int) {
        return Vec3(random.uniform(-20, 20), random.uniform(-20, 20), random.uniform(-off, off));
      });
    }
    case 5: {
      const Vec3 p = random.cube(20);
      return {at, at + Vec3(0, 0, random.scaled(-10, 9)), at + p};
    }
    case 6: {
      const Vec3 p = random.scaled3(-20, 9);
      return {at, at + p, random.coin() ? at : Vec3(at + 0.5 * p)};
    }
    case 7:
      return {at, at, at};
    case 8: {
      const double most = std::pow(10, random.uniform(3, 9));
      return all([&](int) {
        return Vec3(random.uniform(-20, 20), random.uniform(-20, 20), random.uniform(-most, most));
      });
    }
    case 9: {
      const double size = std::pow(10, -random.uniform(3, 12));
      const Vec3 centre(std::floor(at[0]) + 0.5, std::floor(at[1]) + 0.5, random.uniform(-1, 1));
      return {centre + random.cube(size), centre + random.cube(size), centre + random.cube(size)};
    }
    case 10: {
      const double most = std::pow(10, random.uniform(1, 9));
      return all([&](int) {
        return Vec3(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-most, most));
      });
    }
    case 11:
      return all([&](int) {
        return Vec3(0.5 * random.below(20) - at[0] + std::floor(at[0]),
                    0.5 * random.below(20) - at[1] + std::floor(at[1]), 0.5 * random.below(20));
      });
    case 12: {  // a corner a little off the line of the others
      const Vec3 e = random.cube(20);
      return {at, at + e, at + e * random.uniform(-1, 2) + random.scaled3(-60, -10)};
    }
    default: {
      const Vec3 far(at[0], at[1], random.sign() * std::pow(10, random.uniform(3, 9)));
      return {far + random.cube(2), far + random.cube(2), far + random.cube(2)};
    }
  }
}

inline double random_radius(Draws& random) {
  constexpr double kRadii[] = {0, 0.7, 0.7, 0.7, 5, 0.7166};
  const int pick = random.below(8);
  return pick < 6 ? kRadii[pick] : std::abs(random.scaled(-20, 7));
}

inline Weights random_weights(Draws& random) {
  switch (random.below(4)) {
    case 0:
      return minkowski_line::on_edge(random.below(3), random.below(2));
    case 1:
      return minkowski_line::on_edge(random.below(3), random.uniform(0, 1));
    default: {
      const double a = random.uniform(0, 1), b = random.uniform(0, 1);
      return minkowski_line::weights(std::min(a, b), std::abs(a - b));
    }
  }
}

/// A triangle and the centre of a pixel near it. The centre is inside the triangle's image,
/// outside, or at the radius, up to 2^-5 to 2^-50 of it, from a point of the image.
struct Case {
  int kind;
  Triangle triangle;
  double radius;
  float cx, cy;
};

inline Case random_case_at(Draws& random, int kind, float cx, float cy) {
  Case out{kind, random_triangle(random, kind), random_radius(random), cx, cy};
  const Weights w = random_weights(random);
  const Triangle& t = out.triangle;
  const Vec3 p = t[0] + double(w.w1) * (t[1] - t[0]) + double(w.w2) * (t[2] - t[0]);
  const int pick = random.below(8);
  const double angle = pick == 0 ? 1.5707963267948966 * random.below(4) : random.uniform(0, 6.3);
  double distance = out.radius * random.uniform(0, 1.02);
  if (pick < 3) distance = out.radius * (1 + random.scaled(-50, -5));
  if (pick == 3) distance = 0;
  if (pick == 4) distance = out.radius + random.uniform(0, 20);
  const Vec3 shift(out.cx + distance * std::cos(angle) - p[0],
                   out.cy + distance * std::sin(angle) - p[1], 0);
  for (Vec3& corner : out.triangle) corner += shift;
  return out;
}

inline Case random_case(Draws& random, int kind) {
  const float cx = static_cast<float>(random.below(1200) - 600 + 0.5);
  const float cy = static_cast<float>(random.below(1200) - 600 + 0.5);
  return random_case_at(random, kind, cx, cy);
}

inline float number(double x) { return static_cast<float>(x); }

/// A solid whose floats are drawn directly, not computed from a triangle. It may have corners with
/// zeros, denormals and equal coordinates, edges along and across the line, lengths on either side
/// of the kernel's 1e-12, a radius from 0 to 2^20, and any cuts.
inline Solid adversarial_at(Draws& random, float cx, float cy) {
  Solid s{};
  const double far = random.below(3) == 0 ? 1e9 : 1000;
  const double reach = random.scaled(-20, 10), radius = std::abs(random.scaled(-10, 8));
  s[1][3] = random.below(6) == 0 ? 0 : number(random.below(20) == 0 ? 0x1p20 : radius);
  for (int i = 1; i <= 3; ++i) {
    for (int k = 0; k < 3; ++k) s[i][k] = number(reach * random.uniform(-1, 1));
    switch (random.below(9)) {
      case 0:
        s[i][random.below(3)] = 0;
        break;
      case 1:
        s[i][random.below(3)] = number(random.scaled(-149, -30));
        break;
      case 2:
        s[i] = {s[1][0], s[1][1], s[i][2], s[i][3]};
        break;
      case 3:  // about 1e-6 px beside the first corner
        s[i] = {number(s[1][0] + random.scaled(-22, -18)), s[1][1], s[i][2], s[i][3]};
        break;
      case 4:
        s[i][2] = s[1][2];
        break;
      case 5:
        s[i][2] = number(random.uniform(-far, far));
        break;
      default:
        break;
    }
  }
  // Places the line at about the radius from a point of the triangle.
  const Weights w = random_weights(random);
  double p[2];
  for (int k = 0; k < 2; ++k) {
    p[k] = s[1][k] + double(w.w1) * (double(s[2][k]) - s[1][k]) +
           double(w.w2) * (double(s[3][k]) - s[1][k]);
  }
  const double distance =
      s[1][3] * (random.coin() ? 1 + random.scaled(-30, -10) : random.uniform(0, 1.01));
  const double angle = random.uniform(0, 6.3);
  s[0] = {number(cx - p[0] + distance * std::cos(angle)),
          number(cy - p[1] + distance * std::sin(angle)), number(random.uniform(-far, far)), 0};
  if (random.below(10) == 0) s[0][2] = 0;
  const double mid = s[0][2] + random.scaled(-6, 8), thick = std::abs(random.scaled(-6, 12));
  s[0][3] = number(mid - thick);
  s[2][3] = std::max(number(mid + thick), s[0][3]);
  if (random.below(3) == 0) {  // no cuts: the triangle and the ball alone decide
    s[0][3] = number(-4 * far);
    s[2][3] = number(4 * far);
  }
  return s;
}

inline void adversarial(Draws& random, Solid& s, float& cx, float& cy) {
  cx = number(random.below(1000) - 500 + 0.5);
  cy = number(random.below(1000) - 500 + 0.5);
  s = adversarial_at(random, cx, cy);
}

}  // namespace farcull::minkowski_cases
