// What generated scenes are drawn with and made of.
#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <random>
#include <vector>

#include "experiments/mesh.h"
#include "experiments/scene_build.h"

namespace farcull::shapes {

/// Uniform draws made of the 53 high bits of each word, so that every platform sees the same
/// doubles.
class Random {
 public:
  explicit Random(std::uint64_t seed) : words_(seed) {}

  double unit() { return static_cast<double>(words_() >> 11) * 0x1p-53; }  // [0, 1)
  double between(double lo, double hi) { return lo + (hi - lo) * unit(); }
  std::uint32_t below(std::uint32_t n) { return static_cast<std::uint32_t>(words_() % n); }
  Vec3 in_cube(double half) {
    const double x = between(-half, half);
    const double y = between(-half, half);
    const double z = between(-half, half);
    return {x, y, z};
  }
  Vec3 in_ball() {
    for (;;) {
      const Vec3 p = in_cube(1);
      if (p.squaredNorm() <= 1) return p;
    }
  }
  Vec3 direction() {
    for (;;) {
      const Vec3 p = in_ball();
      if (p.squaredNorm() > 0.01) return p / p.norm();
    }
  }
  // About as many in each octave of [2^-octaves, 1).
  double over_octaves(std::uint32_t octaves) {
    const auto octave = static_cast<int>(below(octaves));
    return std::ldexp(between(0.5, 1), -octave);
  }
  // Some orientation at `at`.
  Placement anywhere(const Vec3& at) {
    const Vec3 axis = direction();
    return {.scale = {}, .rotate = Placement::Rotation{axis, between(-3, 3)}, .translate = at};
  }

 private:
  std::mt19937_64 words_;
};

using Corners = std::array<Vec3, 3>;

/// A mesh whose faces are its triangles, in one group.
Mesh finished(std::vector<Vec3> vertices, std::vector<std::array<std::uint32_t, 3>> triangles);

/// Triangles that share no vertices.
Mesh soup(const std::vector<Corners>& list);

/// An icosahedron, each triangle divided into 4^level, on the unit sphere. Square roots only, so
/// the same everywhere.
Mesh sphere(int level);

/// About the z axis; `around` steps along the ring, `across` around the tube (each >= 3), 2 *
/// around * across triangles. Vertex i * across + j is at step i along and j around.
Mesh torus(double ring, double tube, std::uint32_t around, std::uint32_t across);

/// A sphere with bumps and dents of up to about a third of its radius.
Mesh blob(int level, Random& random);

Corners shifted(Corners corners, const Vec3& by);

/// A point well inside.
Vec3 inner_point(const Corners& corners, Random& random);

}  // namespace farcull::shapes
