// Windows, triangles that make trouble for clipping, and the exact image of a triangle in a region.
#pragma once

#include "tests/lab/rational.h"

namespace farcull::clip_cases {

using rational::between, rational::Q, rational::Q3, rational::Random;

using Triangle = std::array<Vec3, 3>;

inline std::vector<Q3> keep_below(const std::vector<Q3>& in, int axis, const Q& plane, int sign) {
  std::vector<Q3> out;
  for (std::size_t i = 0; i < in.size(); ++i) {
    const Q3& a = in[i];
    const Q3& b = in[(i + 1) % in.size()];
    const Q over_a = sign * (a[axis] - plane), over_b = sign * (b[axis] - plane);
    if (over_a <= 0) out.push_back(a);
    if (sgn(over_a) * sgn(over_b) < 0)
      out.push_back(between(a, b, (plane - a[axis]) / (b[axis] - a[axis])));
  }
  return out;
}

/// The corners of the exact image inside the region without a margin of `margin` px: one, since
/// that is what a patch answers for.
inline std::vector<Q3> exact_part(const Window& window, const Triangle& corners, int margin = 1) {
  std::vector<Q3> polygon;
  for (const Vec3& p : corners) polygon.push_back(rational::image(window, p));
  for (int axis = 0; axis < 3; ++axis) {
    polygon = keep_below(polygon, axis, Q(window.hi[axis]) - margin, 1);
    polygon = keep_below(polygon, axis, Q(window.lo[axis]) + margin, -1);
  }
  return polygon;
}

inline Window random_window(Random& random) {
  const Vec3 at = random.below(3) == 0 ? random.scaled3(0, 30) : random.cube(3);
  Vec3 size;
  for (int i = 0; i < 3; ++i) size[i] = std::abs(random.scaled(-8, 2));
  if (random.below(4) == 0) size[random.below(3)] = 0;
  const std::vector<Box> region{{at, at + size}};
  return *fit_window(rational::random_view(random), region, 1 + random.below(600));
}

inline Vec3 world(const Window& window, const Vec3& px) {
  return window.origin + window.view.rows.transpose() * px * window.pixel_size;
}

inline Vec3 in_region(Random& random, const Window& window) {
  Vec3 p;
  for (int i = 0; i < 3; ++i) p[i] = random.uniform(window.lo[i], window.hi[i]);
  return p;
}

inline Triangle random_triangle(Random& random, const Window& window) {
  Triangle px;
  const double reach = random.below(3) == 0 ? 45 : 14;  // log2 of px
  const int kind = random.below(7);
  if (kind == 0) {  // corners anywhere
    for (Vec3& p : px) p = in_region(random, window) + random.scaled3(-20, reach);
  }
  if (kind == 1) {  // around a point of the region, whatever the size
    const Vec3 p = in_region(random, window);
    const Vec3 e = random.scaled3(-20, reach), f = random.scaled3(-20, reach);
    px = {p + e, p + f, p - e - f};
  }
  if (kind == 2) {  // a needle through the region
    const Vec3 p = in_region(random, window), e = random.scaled3(0, reach);
    px = {p - e, p + e * random.uniform(0, 1), p + random.scaled3(-40, 2)};
  }
  if (kind == 3) {  // along an edge of the region's box: an ulp decides on which side a corner is
    const int axis = random.below(3);
    const double length = std::exp2(random.uniform(2, reach));
    for (Vec3& p : px) {
      for (int i = 0; i < 3; ++i) {
        p[i] = (i == (axis + 1) % 3 ? window.lo : window.hi)[i] +
               length * random.scaled(-56, -48) * random.below(2);
      }
      p[axis] = random.uniform(-length, length);
    }
  }
  if (kind == 4) {  // a corner on a corner of the box, or just inside the margin
    for (Vec3& p : px) p = in_region(random, window) + random.scaled3(-5, reach);
    for (int i = 0; i < 3; ++i) {
      const double inset = random.below(2);
      px[0][i] = random.coin() ? window.lo[i] + inset : window.hi[i] - inset;
    }
  }
  if (kind == 5) {  // degenerate: a segment or a point
    const Vec3 p = in_region(random, window) + random.scaled3(-20, reach);
    px = {p, p, random.coin() ? p : in_region(random, window)};
  }
  if (kind == 6) {  // lies in a plane of the box, or covers the whole of it
    const int axis = random.below(3);
    const double at = random.coin() ? window.lo[axis] : random.uniform(window.lo[axis], 0);
    for (Vec3& p : px) {
      p = random.scaled3(0, reach);
      p[axis] = at;
    }
  }
  Triangle corners;
  for (int i = 0; i < 3; ++i) corners[i] = world(window, px[i]);
  return corners;
}

}  // namespace farcull::clip_cases
