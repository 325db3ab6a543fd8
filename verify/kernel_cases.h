// Draws random triangles and solids that are hard for the exact offset (offsets/minkowski.glsl).
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>

#include "core/canvas/canvas.h"
#include "verify/rational.h"
#include "verify/solid_lines.h"

namespace farcull::minkowski_cases {

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
  const auto in_box = [&](double wide, double deep) {
    return all([&](int) {
      return Vec3(random.uniform(-wide, wide), random.uniform(-wide, wide),
                  random.uniform(-deep, deep));
    });
  };
  const double slope = random.uniform(0, 6.3);
  const Vec3 across(std::cos(slope), std::sin(slope), 0);
  switch (kind) {
    case 0:
      return all([&](int) { return random.cube(20); });
    case 1: {  // length 1e3 to 1e12 times the width
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
    case 4:
      return in_box(20, random.coin() ? 0 : std::abs(random.scaled(-50, -4)));
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
    case 8:
      return in_box(20, std::pow(10, random.uniform(3, 9)));
    case 9: {
      const double size = std::pow(10, -random.uniform(3, 12));
      const Vec3 centre(std::floor(at[0]) + 0.5, std::floor(at[1]) + 0.5, random.uniform(-1, 1));
      return {centre + random.cube(size), centre + random.cube(size), centre + random.cube(size)};
    }
    case 10:
      return in_box(1, std::pow(10, random.uniform(1, 9)));
    case 11:
      return all([&](int) {
        return Vec3(0.5 * random.below(20) - at[0] + std::floor(at[0]),
                    0.5 * random.below(20) - at[1] + std::floor(at[1]), 0.5 * random.below(20));
      });
    case 12: {  // a corner a little off the line of the other two
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
  const int pick = random.below(4);
  if (pick == 0) return minkowski_line::on_edge(random.below(3), random.below(2));
  if (pick == 1) return minkowski_line::on_edge(random.below(3), random.uniform(0, 1));
  const double a = random.uniform(0, 1), b = random.uniform(0, 1);
  return minkowski_line::weights(std::min(a, b), std::abs(a - b));
}

/// A triangle and the centre of a pixel near it. The centre is inside the triangle's image, or
/// outside, or about a radius from a point of the image (off by 2^-50 to 2^-5 of the radius).
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

inline float number(double x) { return static_cast<float>(x); }

/// Returns a solid whose floats are drawn directly, not computed from a triangle. It may have
/// zeros, subnormals, equal coordinates, edges along and across the line, squared lengths on both
/// sides of the kernel's threshold 1e-12, a radius from 0 to 2^20, and any depths zlo <= zhi.
inline Solid adversarial_at(Draws& random, float cx, float cy) {
  Solid s{};
  const double far = random.below(3) == 0 ? 1e9 : 1000;
  const double reach = random.scaled(-20, 10), radius = std::abs(random.scaled(-10, 8));
  s[1][3] = random.below(6) == 0 ? 0 : number(random.below(20) == 0 ? 0x1p20 : radius);
  for (int i = 1; i <= 3; ++i) {
    for (int k = 0; k < 3; ++k) s[i][k] = number(reach * random.uniform(-1, 1));
    const int change = random.below(9);
    if (change == 0) s[i][random.below(3)] = 0;
    if (change == 1) s[i][random.below(3)] = number(random.scaled(-149, -30));
    if (change == 2) s[i] = {s[1][0], s[1][1], s[i][2], s[i][3]};
    if (change == 3)  // about 1e-6 px beside the first corner
      s[i] = {number(s[1][0] + random.scaled(-22, -18)), s[1][1], s[i][2], s[i][3]};
    if (change == 4) s[i][2] = s[1][2];
    if (change == 5) s[i][2] = number(random.uniform(-far, far));
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
  if (random.below(3) == 0) {  // zlo and zhi cut nothing off the fattened triangle
    s[0][3] = number(-4 * far);
    s[2][3] = number(4 * far);
  }
  return s;
}

}  // namespace farcull::minkowski_cases
