// Shapes of generated scenes, the draws that place them, and finer meshes of the same surface.
#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <vector>

#include "core/base/random.h"
#include "experiments/scenes/mesh/mesh.h"
#include "experiments/scenes/mesh/scene_build.h"

namespace farcull {

/// Divides the longest edge, all its triangles with it, again and again (Rivara 1984), until there
/// are `triangles` or a few more: one division adds as many as the edge has, two on a closed
/// surface. New vertices are midpoints, so the surface stays up to their rounding, and closed stays
/// closed; a triangle that names a vertex twice is left as it is. Edges of equal length are taken
/// in the order of their vertices: the same on every run. A part keeps the source face and the
/// group of its triangle. Nothing happens to a mesh that has as many already. Precondition: mesh
/// has a triangle.
Mesh refined(Mesh mesh, std::uint64_t triangles);

namespace shapes {

constexpr double kTurn = 2 * std::numbers::pi;  // radians

/// Draws of points, directions and places.
class Random : public RandomNumbers {
 public:
  using RandomNumbers::RandomNumbers;

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
  /// About as many in each octave of [2^-octaves, 1).
  double over_octaves(std::uint32_t octaves) {
    const auto octave = static_cast<int>(below(octaves));
    return std::ldexp(between(0.5, 1), -octave);
  }
  /// Some orientation at `at`.
  Placement anywhere(const Vec3& at) {
    const Vec3 axis = direction();
    return {.scale = {}, .rotate = Placement::Rotation{axis, between(-3, 3)}, .translate = at};
  }
};

using Corners = std::array<Vec3, 3>;

/// A mesh whose faces are its triangles, in one group.
Mesh finished(std::vector<Vec3> vertices, std::vector<std::array<std::uint32_t, 3>> triangles);

/// Triangles that share no vertices.
Mesh soup(const std::vector<Corners>& list);

/// An icosahedron, each triangle divided into 4^level, on the unit sphere. Square roots only, so
/// the same everywhere.
Mesh sphere(int level);

/// Vertex i * (cells + 1) + j is (i/cells, j/cells, 0), i and j from 0 to cells; each cell is two
/// triangles.
Mesh grid(std::uint32_t cells);

/// The corners of a square parallel to the x-y plane, counterclockwise seen from above; triangles
/// are (0, 1, 2) and (0, 2, 3).
std::array<Vec3, 4> square(const Vec3& centre, double side);

/// About the z axis; `around` steps along the ring, `across` around the tube (each >= 3), 2 *
/// around * across triangles. Vertex i * across + j is at step i along and j around.
Mesh torus(double ring, double tube, std::uint32_t around, std::uint32_t across);

/// A sphere with bumps and dents of up to about a third of its radius.
Mesh blob(int level, Random& random);

Corners shifted(Corners corners, const Vec3& by);

/// A vector of this length across another one, in a direction that is drawn.
Vec3 across(const Vec3& along, double length, Random& random);

/// A point well inside.
Vec3 inner_point(const Corners& corners, Random& random);

}  // namespace shapes

}  // namespace farcull
