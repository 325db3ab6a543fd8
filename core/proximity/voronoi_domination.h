// Whether one object is nearer than another one to every point of a block: a test that is sharp
// where both are far away, as distances from the middle of the block are not.
//
// Let v be a corner of one object, T a triangle of the other one, and c a point of the block. The
// square of the distance from v is less than that from T everywhere if one of two bounds of their
// difference is below 0.
//
// Box: if [lo, hi] is the box of T, the difference is at most a sum over the axes of
// (c - v)^2 - |c - [lo, hi]|^2. Each term is convex in c: its slope is 2 (lo - v) up to lo, then
// grows to 2 (hi - v), and stays. So its largest value is at an end of the block (Emrich, Kriegel,
// Kroger, Renz, Zufle: Boosting Spatial Pruning: On Optimal Pruning of MBRs, SIGMOD 2010).
//
// Corners: for a point p of T with weights l_i of its corners p_i,
//   |c - v|^2 - |c - p|^2 = sum l_i (|c - v|^2 - |c - p_i|^2) + sum_{i<j} l_i l_j |p_i - p_j|^2.
// The second sum is at most a third of the square of the longest side. Each bracket of the first
// one is linear in c, so it is largest at a corner of the block.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <span>

#include "core/proximity/voronoi_distance.h"
#include "core/proximity/voronoi_grid.h"

namespace farcull::voronoi {

using Exactly = std::array<double, 3>;  // a point or a step, in units of the grid

/// The points that |x - centre| <= half along each axis.
struct BlockBox {
  Exactly centre, half;
};

namespace domination {

inline Exactly from(const Exactly& centre, const GridPoint& p) {
  return {static_cast<double>(p[0]) - centre[0], static_cast<double>(p[1]) - centre[1],
          static_cast<double>(p[2]) - centre[2]};
}
inline double square(const Exactly& p) { return p[0] * p[0] + p[1] * p[1] + p[2] * p[2]; }

using Corners = std::array<Exactly, 3>;  // relative to the centre of the block, as v

inline double by_box(const Exactly& v, const Corners& t, const Exactly& half) {
  double most = 0;
  for (std::size_t k = 0; k < 3; ++k) {
    const auto [lo, hi] = std::minmax({t[0][k], t[1][k], t[2][k]});
    const auto term = [&, lo = lo, hi = hi](double x) {
      const double to_box = std::max({0.0, lo - x, x - hi});
      return (x - v[k]) * (x - v[k]) - to_box * to_box;
    };
    most += std::max(term(-half[k]), term(half[k]));
  }
  return most;
}

inline double by_corners(const Exactly& v, const Corners& t, const Exactly& half) {
  double most = -HUGE_VAL, longest = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    double along = square(v) - square(t[i]);
    Exactly side;
    for (std::size_t k = 0; k < 3; ++k) {
      along += 2 * half[k] * std::abs(t[i][k] - v[k]);
      side[k] = t[i][k] - t[(i + 1) % 3][k];
    }
    most = std::max(most, along);
    longest = std::max(longest, square(side));
  }
  return most + longest / 3;
}

}  // namespace domination

/// The corner of the triangles `ids` that is nearest to the centre. Precondition: there are some.
inline Exactly nearest_corner(std::span<const std::uint32_t> ids,
                              const std::vector<GridTriangle>& triangles, const BlockBox& block) {
  Exactly out{};
  double least = HUGE_VAL;
  for (const std::uint32_t id : ids) {
    for (const GridPoint& corner : triangles[id].corners) {
      const Exactly relative = domination::from(block.centre, corner);
      const double square = domination::square(relative);
      if (square >= least) continue;
      least = square;
      out = relative;
    }
  }
  return out;
}

/// True only if at every point of the block the exact and the computed distance from `corner`
/// (nearest_corner() of an object) are less than those from all triangles `ids` of another object.
/// The squares then differ by at least the sum of two distances, each at most 1.74 N, times the
/// errors of both. The double arithmetic here errs by far less.
inline bool dominates(const Exactly& corner, std::span<const std::uint32_t> ids,
                      const std::vector<GridTriangle>& triangles, const BlockBox& block,
                      int longest) {
  const double margin =
      2 * static_cast<double>(voronoi_error(longest)) * 3.5 * static_cast<double>(longest);
  return std::all_of(ids.begin(), ids.end(), [&](std::uint32_t id) {
    const auto& corners = triangles[id].corners;
    const domination::Corners t = {domination::from(block.centre, corners[0]),
                                   domination::from(block.centre, corners[1]),
                                   domination::from(block.centre, corners[2])};
    return domination::by_corners(corner, t, block.half) < -margin ||
           domination::by_box(corner, t, block.half) < -margin;
  });
}

}  // namespace farcull::voronoi
