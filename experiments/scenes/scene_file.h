// Makes a scene from command-line arguments: mesh files, a built-in scene, or a scene file; as a
// whole, or part by part for callers that cannot hold all of it.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <initializer_list>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "core/base/error.h"
#include "core/base/stage.h"
#include "core/scene/scene.h"
#include "experiments/scenes/builtin/scenes.h"
#include "experiments/scenes/ignored.h"
#include "experiments/scenes/mesh/load.h"

namespace farcull {

/// A scene as a command line describes it. Only names are required.
struct SceneArguments {
  SceneArguments() = default;
  SceneArguments(std::vector<std::string> of) : names(std::move(of)) {}
  SceneArguments(std::initializer_list<std::string> of) : names(of) {}

  std::vector<std::string> names;     // of files, or of a built-in scene
  std::optional<std::string> weld;    // as parse_weld() takes it (load.h)
  std::optional<std::string> format;  // of a mesh on standard input, "-": named_format()
  std::optional<std::string> ignore;  // as parse_ignored() takes it

  /// The arguments as words of a command line.
  std::vector<std::string> words() const;
};

/// The scene that the arguments name. Their names are one of
/// - one or more mesh files (.obj, .off, .ply, .stl, or these and .gz). Each is an object with the
///   name of its file without extension, and with its folder if another file has the same name;
/// - one built-in scene, perhaps with suffixes (builtin/scenes.h);
/// - one scene file, JSON:
///     {"name": "two-bunnies", "objects": [
///       {"name": "a", "mesh": "bunny00.off"},
///       {"mesh": "bunny00.off", "scale": 1, "rotate": {"axis": [0, 0, 1], "angle": 0.7},
///        "translate": [0.02, 0.0026, 0.0014], "split": "none",
///        "self": false}],
///      "ignore": [["a", "bunny00"], ["link*", "base"]]}
///   Only `objects` and `mesh` must be there. `mesh` is relative to the scene file. `scale` is a
///   number or an array of 3, none of them 0; negative ones mirror. Angles are in radians about an
///   axis through the origin. A mesh is scaled, then rotated, then translated, in double; absent
///   steps are skipped, so that the doubles of the mesh stay as they are. `split` is "none",
///   "groups" (the groups of an OBJ) or "components" (triangles connected through shared vertices).
///   `self` is true or false (the default): whether the object is tested against itself as well;
///   with a split, each part is. Different parts are always tested against each other. `ignore`
///   lists pairs of objects that are not tested against each other, by their names in the scene; a
///   * stands for any characters, and the pattern for every object that it matches
///   (Scene::ignored).
/// A mesh that is named several times is read once. Names are completed as SceneBuilder says.
/// Throws Error if an argument cannot be read or is not of this form. The Error names the file. In
/// a scene file it also names the line (wrong syntax, names of ignored objects) or the place of a
/// wrong value, such as objects[1].rotate.axis. If meshes are welded, the name of the scene says
/// so. Scene::ignored has the pairs of the scene file and those of `ignore`.
Scene load_scene(const SceneArguments& arguments);
/// Throws Error if `weld` or `format` is given, but no named mesh can be affected by it. Called by
/// load_scene() and stream_scene().
void require_meshes(const SceneArguments& arguments);
/// Adds the pairs of `ignore` to Scene::ignored, as load_scene() does. Throws Error as
/// ignored_objects().
void ignore_more(Scene& scene, const SceneArguments& arguments, UnknownName lacking);
/// load_scene() that reads meshes through the cache `meshes`, which keeps them.
Scene load_scene(const SceneArguments& arguments, MeshCache& meshes);

/// Whether load_scene() treats the name as that of a scene file.
bool is_scene_file(const std::string& name);
/// The paths of the meshes that a scene file names, each as often as it is named. If the file
/// cannot be read or is not of the form above, returns the paths that were found.
std::vector<std::string> meshes_of_scene_file(const std::string& path);

/// load_scene() for the text of a scene file. `path` is named in errors, and mesh paths are
/// relative to it.
Scene parse_scene_file(const std::string& text, const std::string& path);

/// An object in a scene file to be written, without a placement.
struct SceneFileObject {
  std::string name, mesh;
  bool self = false;
};
/// The text of a scene file; ignored: pairs of names.
std::string scene_file_text(const std::string& name, const std::vector<SceneFileObject>& objects,
                            const std::vector<std::pair<std::string, std::string>>& ignored);

/// Throws Error if load_scene({name}) is sure to fail: `name` is neither a built-in scene for
/// parse_scene_name() nor a file. Files of a name with a frame's number (%d) are not looked for.
void require_known(const std::string& name);

/// Receives a part of a scene: some consecutive whole objects, as a valid scene with the name of
/// the whole scene. May change the part.
using TakePart = std::function<void(Scene& part)>;

/// Calls take() with one part after the other. Together they are load_scene(arguments): the same
/// objects, names, triangles and doubles in the same order; only the indices of vertices start at 0
/// in each part. A part is a mesh file, an object of a scene file, or some objects of the built-in
/// scene `field`; every other built-in scene, or one with suffixes, is a single part. Memory: the
/// largest part with its file, up to 256 MiB of meshes that a scene file may name again, and the
/// names of the objects of mesh and scene files. Returns the pairs of objects that the scene file
/// ignores, in the numbers of the whole scene; parts ignore none. Throws Error as load_scene(),
/// perhaps after some parts, and what take() throws. Precondition: `ignore` is not given.
std::vector<ObjectPair> stream_scene(const SceneArguments& arguments, const TakePart& take);

// Scenes as files (write_scene.cpp): meshes with 17 significant digits, so that every double is
// read back unchanged, and the scene file that puts them together again.

/// The files that one call has written.
struct WrittenScene {
  std::string scene_file;  // FOLDER/scene.json
  std::uint64_t files = 0;
  std::uint64_t bytes = 0;
};

/// Writes each object as NAME.off, with the vertices that it uses and 17 significant digits. Writes
/// scene.json, whose scene has the same scene_hash(). NAME is the object's name, in which
/// everything but letters, digits, '.' and '-' is replaced; a number is added if two names are
/// equal. Creates the last part of `folder` if it does not exist; replaces existing files, as other
/// outputs do; writes scene.json last. If the system refuses a path, removes the new files and
/// throws Error naming the path. Precondition: every object has a triangle.
WrittenScene write_scene(const Scene& scene, const std::string& folder);

}  // namespace farcull
