// Triangles and pixels that make trouble for the kernel of FAR pairs (core/pairs/interval.glsl),
// and the real triangles that a float one stands for.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "core/canvas/kernel_case.h"
#include "verify/rational.h"

namespace farcull::interval_cases {

using rational::Draws;
using rational::Q;
using rational::Q3;
using FloatTriangle = std::array<std::array<float, 3>, 3>;

inline float usable(double x) { return std::abs(x) < 0x1p-60 ? 0.f : static_cast<float>(x); }

// Triangles of every kind that has been trouble, near the pixels around `at`.
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

/// A case whose real triangle is mostly at the limit, in one of the nine pixels around a point of
/// it.
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
