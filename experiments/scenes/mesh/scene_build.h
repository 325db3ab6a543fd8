// Puts meshes into a scene: places each mesh and splits it into objects. Scene files and built-in
// scenes share this code, so that equal placements give equal coordinates. Also makes the shapes of
// generated scenes.
#pragma once

#include <cmath>
#include <numbers>
#include <unordered_map>
#include <utility>

#include "core/base/random.h"
#include "experiments/scenes/mesh/load.h"

namespace farcull {

/// A transformation of points: a matrix, or scaling, then rotation, then translation. Scaling and
/// rotation are about the origin. All steps are computed in double. A step that is absent or
/// changes nothing is skipped, so an identity keeps every bit, even the sign of -0.0.
struct Placement {
  struct Rotation {
    Vec3 axis = Vec3::UnitZ();  // any length but 0; finite
    double angle = 0;           // radians, counterclockwise seen from the tip of the axis
    // x, y, z, w; any length but 0. If set, the quaternion replaces axis and angle.
    std::optional<std::array<double, 4>> quaternion = {};
  };
  // The upper three rows of a 4 x 4 matrix. If set, the other members are empty.
  std::optional<std::array<std::array<double, 4>, 3>> matrix = {};
  std::optional<Vec3> scale;  // one factor for each coordinate
  std::optional<Rotation> rotate;
  std::optional<Vec3> translate;
};

/// Applies the placement to every point. Precondition: finite numbers, and an axis that is not 0.
std::vector<Vec3> place(std::vector<Vec3> points, const Placement& placement);

enum class Split {
  kNone,        // one object
  kGroups,      // an object for each group that has triangles, in order of the groups
  kComponents,  // an object for each set of triangles connected through shared vertices, in order
                // of the first triangles of these sets
};

/// A scene under construction.
class SceneBuilder {
 public:
  /// where: named in errors; the scene file, or the name of the scene.
  SceneBuilder(std::string scene_name, std::string where);

  /// Appends a mesh as one object or several. Within an object, triangles keep the order of the
  /// file. A single object is called NAME; several are NAME/GROUP, or NAME/1, NAME/2, .... A name
  /// in use gets the first free suffix "#2", "#3", .... `self`: each object is also tested against
  /// itself. Scene::folded lists the folded faces. Throws Error if a placed coordinate is not
  /// finite or the scene would have more than 2^32 - 1 triangles or vertices.
  void add(const Mesh& mesh, const std::string& name, Split split = Split::kNone,
           const Placement& placement = {}, bool self = false);
  /// Returns the objects added since the previous call as a validated scene, and removes them from
  /// the builder. Their names stay in use.
  Scene take_part();
  /// Returns the scene, validated. Nothing may be added afterwards.
  Scene finish() { return take_part(); }

 private:
  std::string free_name(const std::string& name);

  Scene scene_;
  std::string where_;
  // The names in use, each with the number of the last suffix that was tried for it.
  std::unordered_map<std::string, int> names_;
};

/// Cuts parts out of a mesh or a scene. The given vertices must outlive the PartMaker.
class PartMaker {
 public:
  explicit PartMaker(std::span<const Vec3> vertices)
      : vertices_(vertices), number_(vertices.size(), kNone) {}
  /// Adds a triangle to the current part, whose vertices are in order of first use.
  void add(std::array<std::uint32_t, 3> corners);
  /// Returns the part and begins the next one.
  MeshPart take();

 private:
  static constexpr std::uint32_t kNone = 0xffffffff;
  std::span<const Vec3> vertices_;
  std::vector<std::uint32_t> number_;  // for each vertex, its number in the current part, or kNone
  std::vector<std::uint32_t> used_;
  MeshPart part_;
};

/// Appends an object with its own copy of the vertices. Does not check the arguments. The triangles
/// are indices into `vertices`.
void append_object(const std::string& name, std::span<const Vec3> vertices,
                   std::span<const std::array<std::uint32_t, 3>> triangles,
                   std::span<const std::uint32_t> source_face, Scene& scene);

/// Returns the box around all triangles of a Scene or a Mesh. The box is empty without triangles.
template <class Triangles>
Box bounds(const Triangles& of) {
  Box box = Box::empty();
  for (const auto& triangle : of.triangles) {
    for (const std::uint32_t v : triangle) box.add(of.vertices[v]);
  }
  return box;
}
/// Returns the middle of a box that is not empty.
Vec3 centre(const Box& box);
/// Returns the length of the diagonal of a box that is not empty.
double diagonal(const Box& box);

/// Refines a mesh until it has `triangles` triangles or a few more. Each step divides the longest
/// edge and all triangles at this edge (Rivara 1984). New vertices are midpoints, so only their
/// rounding changes the surface, and a closed surface stays closed. Among edges of equal length,
/// the edge with the lower vertex indices is divided first, so every run gives the same mesh. A
/// triangle that names a vertex twice is left unchanged. The parts of a triangle keep its source
/// face and group. Precondition: the mesh has a triangle.
Mesh refined(Mesh mesh, std::uint64_t triangles);

namespace shapes {

constexpr double kTurn = 2 * std::numbers::pi;  // a full turn, in radians

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
  /// Returns a random number in [2^-octaves, 1). Each interval [2^-k, 2^(1-k)) is equally likely,
  /// and the number is uniform in its interval.
  double over_octaves(std::uint32_t octaves) {
    const auto octave = static_cast<int>(below(octaves));
    return std::ldexp(between(0.5, 1), -octave);
  }
  /// Returns a random rotation, followed by a translation by `at`.
  Placement anywhere(const Vec3& at) {
    const Vec3 axis = direction();
    return {.scale = {}, .rotate = Placement::Rotation{axis, between(-3, 3)}, .translate = at};
  }
};

using Corners = std::array<Vec3, 3>;

/// Returns a mesh in one group, in which each triangle is a face.
Mesh finished(std::vector<Vec3> vertices, std::vector<std::array<std::uint32_t, 3>> triangles);

/// Returns a surface of columns * rows cells, each of two triangles. Vertex (i, j) is place(i, j).
/// closed: the last column is joined to the first column, and the last row to the first row. A
/// surface that is not closed has (columns + 1) * (rows + 1) vertices.
template <class Place>
Mesh surface(std::uint32_t columns, std::uint32_t rows, bool closed, const Place& place) {
  std::vector<Vec3> vertices;
  std::vector<std::array<std::uint32_t, 3>> triangles;
  const std::uint32_t wide = columns + !closed, high = rows + !closed;
  for (std::uint32_t i = 0; i < wide; ++i) {
    for (std::uint32_t j = 0; j < high; ++j) vertices.push_back(place(i, j));
  }
  const auto at = [&](std::uint32_t i, std::uint32_t j) { return i % wide * high + j % high; };
  for (std::uint32_t i = 0; i < columns; ++i) {
    for (std::uint32_t j = 0; j < rows; ++j) {
      triangles.push_back({at(i, j), at(i + 1, j), at(i + 1, j + 1)});
      triangles.push_back({at(i, j), at(i + 1, j + 1), at(i, j + 1)});
    }
  }
  return finished(std::move(vertices), std::move(triangles));
}

/// Returns a mesh of triangles that share no vertices.
Mesh soup(const std::vector<Corners>& list);

/// Returns the unit sphere: an icosahedron, with each triangle divided into 4^level triangles.
/// Coordinates need only arithmetic and square roots, so the mesh is the same on every platform.
Mesh sphere(int level);

/// Returns a unit square of cells^2 cells, each of two triangles. Vertex i * (cells + 1) + j is at
/// (i/cells, j/cells, 0), with i and j from 0 to `cells`.
Mesh grid(std::uint32_t cells);

/// Returns the corners of a square parallel to the x-y plane, counterclockwise seen from above. The
/// square's triangles are (0, 1, 2) and (0, 2, 3).
std::array<Vec3, 4> square(const Vec3& centre, double side);

/// Returns a torus about the z axis with radii `ring` and `tube`. The ring has `around` steps, the
/// tube has `across` steps, and the torus has 2 * around * across triangles. Vertex i * across + j
/// is at step i of the ring and step j of the tube. Precondition: around and across are at least 3.
Mesh torus(double ring, double tube, std::uint32_t around, std::uint32_t across);

/// Returns a unit sphere with a smooth bump at four random directions, and dents opposite to them.
Mesh blob(int level, Random& random);

Corners shifted(Corners corners, const Vec3& by);

/// Returns a vector of length `length`, perpendicular to `along`, in a random direction.
Vec3 across(const Vec3& along, double length, Random& random);

/// Returns a random point of the triangle, whose barycentric coordinates are 0.2 or more.
Vec3 inner_point(const Corners& corners, Random& random);

}  // namespace shapes

}  // namespace farcull
