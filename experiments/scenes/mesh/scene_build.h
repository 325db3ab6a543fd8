// Putting meshes into a scene: where an object stands and how a mesh becomes objects. Scene files
// and built-in scenes share it, so the same numbers give the same doubles.
#pragma once

#include <array>
#include <optional>
#include <span>
#include <string>
#include <unordered_map>
#include <vector>

#include "core/scene/scene.h"
#include "experiments/scenes/mesh/mesh.h"

namespace farcull {

/// Scale, then rotate, then translate, each step in double and about the origin. A step that is
/// absent or does nothing (angle 0, translation 0 along an axis) is left out, so an identity leaves
/// every bit as it is, -0.0 included.
struct Placement {
  struct Rotation {
    Vec3 axis = Vec3::UnitZ();  // any length but 0; finite
    double angle = 0;           // radians, counterclockwise seen from the tip of the axis
  };
  std::optional<Vec3> scale;  // per coordinate
  std::optional<Rotation> rotate;
  std::optional<Vec3> translate;
};

/// Every point placed. Precondition: finite numbers and an axis that is not 0.
std::vector<Vec3> place(std::vector<Vec3> points, const Placement& placement);

enum class Split {
  kNone,        // one object
  kGroups,      // one per group that has triangles, in order of the groups
  kComponents,  // one per set of triangles connected through shared vertices, in order of their
                // first triangles
};

/// A scene under construction.
class SceneBuilder {
 public:
  /// `where` stands in errors: the scene file, or the name of the scene.
  SceneBuilder(std::string scene_name, std::string where);

  /// Appends a mesh as one object or several. Within an object triangles keep the order of the
  /// file. A part is called NAME/GROUP or NAME/1, NAME/2, ...; a mesh with a single part keeps
  /// NAME. `self`: each part is tested against itself as well. A name that the scene has already
  /// gets the first suffix "#2", "#3", ... that is free. Folded faces are named in Scene::folded.
  /// Throws Error if a placed coordinate is not
  /// finite or the scene would have more than 2^32 - 1 triangles or vertices.
  void add(const Mesh& mesh, const std::string& name, Split split, const Placement& placement,
           bool self = false);
  /// Takes out what was added since the last part, as a scene of its own, validated. Names stay in
  /// use.
  Scene take_part();
  /// The scene, validated; the builder is spent.
  Scene finish() { return take_part(); }

 private:
  std::string free_name(const std::string& name);

  Scene scene_;
  std::string where_;
  std::unordered_map<std::string, int>
      names_;  // names in use, each with the last suffix tried for it
};

/// Cuts parts out of a mesh or a scene, whose vertices must outlive it.
class PartMaker {
 public:
  explicit PartMaker(std::span<const Vec3> vertices)
      : vertices_(vertices), number_(vertices.size(), kNone) {}
  /// Adds a triangle to the part at hand, whose vertices come in order of first mention.
  void add(std::array<std::uint32_t, 3> corners);
  /// The part, and the next one begins.
  MeshPart take();

 private:
  static constexpr std::uint32_t kNone = 0xffffffff;
  std::span<const Vec3> vertices_;
  std::vector<std::uint32_t> number_;  // of each vertex in the part
  std::vector<std::uint32_t> used_;    // vertices of the part
  MeshPart part_;
};

/// Appends an object with vertices of its own, as they are and unchecked; triangles name positions
/// in `vertices`.
void append_object(const std::string& name, std::span<const Vec3> vertices,
                   std::span<const std::array<std::uint32_t, 3>> triangles,
                   std::span<const std::uint32_t> source_face, Scene& scene);

/// The box around all triangles of a scene; empty without triangles.
Box bounds(const Scene& scene);
/// The same of a mesh.
Box bounds(const Mesh& mesh);
/// The middle of a box that is not empty.
Vec3 centre(const Box& box);
/// The length of the diagonal of a box that is not empty.
double diagonal(const Box& box);

}  // namespace farcull
