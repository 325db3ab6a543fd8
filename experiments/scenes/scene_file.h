// Makes a scene from command-line arguments that name mesh files, a built-in scene or a scene file.
// stream_scene() passes on the scene in parts, for callers without memory for the whole scene.
#pragma once

#include <initializer_list>

#include "core/base/stage.h"
#include "experiments/scenes/builtin/scenes.h"
#include "experiments/scenes/mesh/load.h"

namespace farcull {

// The next declarations concern pairs of objects that are not tested against each other. Options
// and files name the objects (ignored.cpp).

/// How to treat a name that no object has. After the first frame such names are passed over, since
/// objects may appear and disappear.
enum class UnknownName { refused, passed_over };

/// Returns all pairs of two different objects in which one object matches the pattern `first`, and
/// the other object matches `second`. A * in a pattern stands for any characters. Throws Error if
/// - a pattern is the name of an object, but also matches other objects;
/// - a pattern matches no object, unless `lacking` is passed_over;
/// - both patterns match the same single object, unless `lacking` is passed_over.
/// where, line, what: the file or option, its line and the name of the pair in errors.
std::vector<ObjectPair> pairs_between(const Scene& scene, const std::string& first,
                                      const std::string& second, const std::string& where,
                                      const std::string& what, long line = 0,
                                      UnknownName lacking = UnknownName::refused);

/// Two groups of objects, given by patterns for their names.
struct IgnoredNames {
  std::string text;   // such as "link*:gripper"; * stands for any characters
  std::string where;  // the option or the file with the text
  long line = 0;      // line of the file, from 1; 0 for --ignore
};

/// Reads a list of pairs such as "a:b,link*:gripper". Throws Error naming the option if a pair is
/// empty. In lists and in files, a comma, colon or * after a backslash is a character of the name.
std::vector<IgnoredNames> parse_ignored(const std::string& list,
                                        const std::string& option = "--ignore");
/// Reads the pairs of a text file, one per line. Skips empty lines, lines that begin with #, and a
/// byte order mark. Throws Error naming the file if it cannot be read or names no pair.
std::vector<IgnoredNames> read_ignored(const std::string& path);
/// Returns the pairs of a list (--ignore) and of a file (--ignore-file). Each argument may be
/// empty.
std::vector<IgnoredNames> ignored_names(const std::optional<std::string>& list,
                                        const std::optional<std::string>& file);

/// Returns the pairs of two different objects, one from each group of an IgnoredNames, in the order
/// of in_order(). A name may hold colons, so each colon of a text is tried as the separator of the
/// groups. Throws Error naming `where` and the line if a text has no colon, or if several of its
/// colons separate groups that have objects. Throws Error as pairs_between() does.
std::vector<ObjectPair> ignored_objects(const Scene& scene, const std::vector<IgnoredNames>& names,
                                        UnknownName lacking = UnknownName::refused);

/// A scene as a command line describes it. Only `names` is required.
struct SceneArguments {
  SceneArguments() = default;
  SceneArguments(std::vector<std::string> of) : names(std::move(of)) {}
  SceneArguments(std::initializer_list<std::string> of) : names(of) {}

  std::vector<std::string> names;     // names of files, or the name of a built-in scene
  std::optional<std::string> weld;    // read by parse_weld() (load.h)
  std::optional<std::string> format;  // format of a mesh on standard input; read by named_format()
  std::optional<std::string> ignore;  // read by parse_ignored()

  /// Returns the arguments as the words of a command line.
  std::vector<std::string> words() const;
};

/// Loads the scene that the arguments name. arguments.names has one of these forms:
/// - one or more mesh files (.obj, .off, .ply or .stl, perhaps with .gz after it). Each file is an
///   object, named after the file without extension. The folder is added if another file has the
///   same name;
/// - one built-in scene, perhaps with numbers and suffixes (builtin/scenes.h);
/// - one scene file, JSON (docs/scenes.md).
/// A mesh that is named several times is read once. If meshes are welded, the name of the scene
/// says so. Scene::ignored has the pairs of the scene file and those of `ignore`. Throws Error
/// naming the file if an argument cannot be read or has none of these forms. For a scene file, the
/// Error also names the line, or the place of a wrong value such as objects[1].rotate.axis.
Scene load_scene(const SceneArguments& arguments);
/// Throws Error if `weld` or `format` is given, but applies to no mesh in `names`.
void require_meshes(const SceneArguments& arguments);
/// Adds the pairs of `ignore` to Scene::ignored, as load_scene() does. Throws Error as
/// ignored_objects() does.
void ignore_more(Scene& scene, const SceneArguments& arguments, UnknownName lacking);
/// Does the same as load_scene(arguments), and keeps the meshes in `meshes` for later calls.
Scene load_scene(const SceneArguments& arguments, MeshCache& meshes);

/// True if load_scene() treats the name as that of a scene file.
bool is_scene_file(const std::string& name);
/// Returns the paths of the meshes that a scene file names. A path that is named twice is returned
/// twice. If the file cannot be read or is no scene file, returns the paths that were found.
std::vector<std::string> meshes_of_scene_file(const std::string& path);

/// Does the same as load_scene() for the text of a scene file. path: named in errors; mesh paths
/// are relative to the folder of `path`.
Scene parse_scene_file(const std::string& text, const std::string& path);

struct SceneFileObject {
  std::string name, mesh;
  bool self = false;
};
/// Returns the text of a scene file. ignored: pairs of objects, each given by two names.
std::string scene_file_text(const std::string& name, const std::vector<SceneFileObject>& objects,
                            const std::vector<std::pair<std::string, std::string>>& ignored);

/// Throws Error if `name` is neither a file nor a name that parse_scene_name() accepts. Accepts all
/// names that contain a %, since a name with %d may stand for the files of several frames.
void require_known(const std::string& name);

/// Receives a part of a scene: some consecutive objects, as a valid scene with the name of the
/// whole scene. The function may change the part.
using TakePart = std::function<void(Scene& part)>;

/// Calls take() with one part after the other. Together the parts have the objects, names,
/// triangles and coordinates of load_scene(arguments), in the same order. Only the indices of
/// vertices start at 0 in each part. A part is a mesh file, an object of a scene file, or some
/// objects of the built-in scene `field`; any other built-in scene is a single part. Needs memory
/// for the largest part with its file, for up to 256 MiB of meshes that a scene file may name
/// again, and for the names of objects. Returns the pairs of objects that the scene file ignores,
/// by numbers in the whole scene; parts have no ignored pairs. Throws Error as load_scene() does,
/// perhaps after some parts. Passes on exceptions of take(). Precondition: `ignore` is not given.
std::vector<ObjectPair> stream_scene(const SceneArguments& arguments, const TakePart& take);

// Scenes as files (write_scene.cpp): a mesh for each object, and a scene file that names the
// meshes. Numbers have 17 significant digits, so that every double is read back unchanged.

/// The files that one call of write_scene() has written.
struct WrittenScene {
  std::string scene_file;  // FOLDER/scene.json
  std::uint64_t files = 0;
  std::uint64_t bytes = 0;
};

/// Writes each object as NAME.off, with the vertices that the object uses. Then writes scene.json;
/// loading this file gives a scene with the same scene_hash(). NAME is the object's name, with '-'
/// in place of other characters than letters, digits, '.' and '-'. Equal names get a number.
/// Creates `folder`, but not its parents, if it does not exist; replaces existing files. If the
/// system refuses a path, removes the new files and throws Error naming the path. Precondition:
/// every object has a triangle.
WrittenScene write_scene(const Scene& scene, const std::string& folder);

}  // namespace farcull
