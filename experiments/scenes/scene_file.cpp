// Loads scenes: scene files, mesh files and built-in scenes.
#include "experiments/scenes/scene_file.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <iterator>
#include <map>
#include <new>
#include <nlohmann/json.hpp>
#include <numbers>
#include <set>

#include "core/base/text.h"
#include "experiments/scenes/mesh/scene_build.h"
#include "experiments/scenes/mesh/text.h"

namespace farcull {
namespace {

using nlohmann::json;

constexpr std::uint64_t kMaxSceneFileBytes = std::uint64_t{64} << 20;
// Linux opens no file with a longer path (PATH_MAX).
constexpr std::size_t kMaxPathBytes = 4096;

// Iterates over the characters of a text, and counts its lines.
class Reading {
 public:
  using iterator_category = std::input_iterator_tag;
  using value_type = char;
  using difference_type = std::ptrdiff_t;
  using pointer = const char*;
  using reference = const char&;

  // Each newline increases *line.
  Reading(const char* at, long* line) : at_(at), line_(line) {}
  reference operator*() const { return *at_; }
  Reading& operator++() {
    if (*at_++ == '\n') ++*line_;
    return *this;
  }
  bool operator==(const Reading& other) const { return at_ == other.at_; }

 private:
  const char* at_;
  long* line_;
};

// The line numbers of the keys "mesh" in "objects" and of the pairs in "ignore".
struct Lines {
  std::vector<long> meshes, ignored;
};

// Checks the syntax of a JSON text. Finds data that json::parse does not report: the place of the
// first error, a key that occurs twice in one object, and line numbers (Lines).
class Syntax : public nlohmann::json_sax<json> {
 public:
  // line: a reference to the line of the character that was read last.
  explicit Syntax(const long& line) : line_(line) {}
  bool null() override { return true; }
  bool boolean(bool) override { return true; }
  bool number_integer(number_integer_t) override { return true; }
  bool number_unsigned(number_unsigned_t) override { return true; }
  bool number_float(number_float_t, const string_t&) override { return true; }
  bool string(string_t&) override { return true; }
  bool binary(binary_t&) override { return true; }
  bool start_array(std::size_t) override {
    if (++arrays_ == 2 && keys_.size() == 1 && last_ == "ignore") lines.ignored.push_back(line_);
    return true;
  }
  bool end_array() override {
    --arrays_;
    return true;
  }
  bool start_object(std::size_t) override {
    keys_.emplace_back();
    return true;
  }
  bool end_object() override {
    keys_.pop_back();
    return true;
  }
  bool key(string_t& name) override {
    if (!keys_.back().insert(name).second && twice.empty()) twice = name;
    if (keys_.size() == 1) last_ = name;
    if (keys_.size() == 2 && name == "mesh" && last_ == "objects") lines.meshes.push_back(line_);
    return true;
  }
  bool parse_error(std::size_t position, const std::string&,
                   const json::exception& error) override {
    at = position;
    reason = json_fault(error.what());
    return false;
  }

  std::string twice;   // a key that occurs twice in one object
  std::size_t at = 0;  // bytes read when the error was found
  std::string reason;
  Lines lines;

 private:
  const long& line_;
  std::vector<std::set<std::string>> keys_;
  int arrays_ = 0;    // number of open arrays
  std::string last_;  // the key that was read last in the outermost object
};

// Returns the path of a mesh whose name is relative to the folder of the scene file.
std::string mesh_path(const std::string& scene_file, const std::string& mesh) {
  return (std::filesystem::path(scene_file).parent_path() / mesh).string();
}

// Reads the values of a scene file. Many functions take a value and its place in the file, such as
// objects[1].scale. Such a function throws Error naming file and place if the type is wrong.
class SceneFile {
 public:
  SceneFile(std::string path, Lines lines, MeshCache& meshes)
      : path_(std::move(path)), lines_(std::move(lines)), meshes_(meshes) {}

  // Adds the objects of the file to a builder. Calls added() after each object.
  SceneBuilder read(const json& root, const std::function<void(SceneBuilder&)>& added = {}) {
    require(root.is_object(), "", "the file must be a JSON object", "write {\"objects\": [...]}");
    check_keys(root, "", {"name", "objects", "ignore"});
    const std::string name = root.contains("name") ? text(root["name"], "name") : mesh_stem(path_);
    const std::string form = "write \"objects\": [{\"mesh\": FILE}, ...]";
    require(root.contains("objects"), "objects", "is missing", form);
    const json& objects = root["objects"];
    require(objects.is_array(), "objects", "must be an array", form);
    require(!objects.empty(), "objects", "is empty", form);
    SceneBuilder builder(clean_name(name) + meshes_.note(), path_);
    for (std::size_t i = 0; i < objects.size(); ++i) {
      add_object(objects[i], i, builder);
      if (added) added(builder);
    }
    return builder;
  }

  // Returns the pairs of ignored objects. Precondition: `scene` has the objects of the file. Only
  // the names of these objects are used.
  std::vector<ObjectPair> read_ignored(const json& pairs, const Scene& scene,
                                       UnknownName lacking = UnknownName::refused) const {
    const std::string form = "write \"ignore\": [[\"NAME\", \"NAME\"], ...]";
    require(pairs.is_array(), "ignore", "must be an array", form);
    std::vector<ObjectPair> out;
    for (std::size_t k = 0; k < pairs.size(); ++k) {
      const std::string place = fmt::format("ignore[{}]", k);
      const json& pair = pairs[k];
      require(pair.is_array() && pair.size() == 2 && pair[0].is_string() && pair[1].is_string(),
              place, "must be an array of two names", form);
      const std::vector<ObjectPair> named =
          pairs_between(scene, pair[0].get<std::string>(), pair[1].get<std::string>(), path_, place,
                        lines_.ignored.at(k), lacking);
      out.insert(out.end(), named.begin(), named.end());
    }
    return in_order(std::move(out));
  }

 private:
  void add_object(const json& object, std::size_t number, SceneBuilder& builder) const {
    const std::string place = fmt::format("objects[{}]", number);
    require(object.is_object(), place, "must be a JSON object", "write {\"mesh\": FILE}");
    check_keys(object, place,
               {"name", "mesh", "matrix", "scale", "rotate", "translate", "split", "self"});
    require(object.contains("mesh"), place + ".mesh", "is missing", "name a mesh file");
    const std::string mesh = text(object["mesh"], place + ".mesh");
    require(!mesh.empty(), place + ".mesh", "is empty", "name a mesh file");
    require(mesh.size() <= kMaxPathBytes, place + ".mesh",
            fmt::format("is a path of {} bytes", mesh.size()), "name a mesh file");
    // The system would end the path at a NUL byte and open another file.
    require(mesh.find('\0') == std::string::npos, place + ".mesh", "contains a NUL byte",
            "name a mesh file");
    std::string name = mesh_stem(mesh);
    if (object.contains("name")) name = text(object["name"], place + ".name");
    const Placement placement = placement_of(object, place);
    Split split = Split::kNone;
    if (object.contains("split")) split = read_split(object["split"], place + ".split");
    const bool self = object.contains("self") && truth(object["self"], place + ".self");
    try {
      builder.add(meshes_.get(mesh_path(path_, mesh)), name, split, placement, self);
    } catch (const Error& error) {
      if (error.reason != "the file does not exist") throw;
      throw Error(error.where, error.reason,
                  fmt::format("{}: {}.mesh in line {} of {} names this one", error.remedy, place,
                              lines_.meshes.at(number), path_));
    }
  }

  Split read_split(const json& value, const std::string& place) const {
    const std::string word = text(value, place);
    if (word == "groups") return Split::kGroups;
    if (word == "components") return Split::kComponents;
    require(word == "none", place, "is " + quote_token(word),
            "use \"none\", \"groups\" or \"components\"");
    return Split::kNone;
  }

  template <class Value>
  Value typed(const json& value, const std::string& place, bool right, const char* type,
              const char* remedy) const {
    require(right, place, fmt::format("is of type {}, not {}", value.type_name(), type), remedy);
    return value.get<Value>();
  }

  std::string text(const json& value, const std::string& place) const {
    return typed<std::string>(value, place, value.is_string(), "a string", "write it in quotes");
  }

  bool truth(const json& value, const std::string& place) const {
    return typed<bool>(value, place, value.is_boolean(), "true or false",
                       "write true or false, without quotes");
  }

  double number(const json& value, const std::string& place) const {
    const auto x =
        typed<double>(value, place, value.is_number(), "a number", "give a finite number");
    require(std::isfinite(x), place, "is not finite", "give a finite number");
    return x;
  }

  Vec3 vec3(const json& value, const std::string& place) const {
    require(value.is_array() && value.size() == 3, place, "must be an array of 3 numbers",
            "write it as [X, Y, Z]");
    Vec3 v;
    for (std::size_t i = 0; i < 3; ++i)
      v[static_cast<int>(i)] = number(value[i], fmt::format("{}[{}]", place, i));
    return v;
  }

  void check_keys(const json& object, const std::string& place,
                  std::initializer_list<std::string_view> known) const {
    for (const auto& item : object.items()) {
      require(std::ranges::find(known, item.key()) != known.end(),
              (place.empty() ? "" : place + ".") + clean_name(item.key()), "is an unknown key",
              fmt::format("use only {}", fmt::join(known, ", ")));
    }
  }

  void require(bool condition, const std::string& place, const std::string& reason,
               const std::string& remedy) const {
    if (!condition) throw Error(path_, place.empty() ? reason : place + " " + reason, remedy);
  }

  Placement placement_of(const json& object, const std::string& place) const {
    Placement out;
    if (object.contains("matrix")) {
      for (const char* other : {"scale", "rotate", "translate"}) {
        require(!object.contains(other), place + "." + other, "stands beside a matrix",
                "give the matrix alone, or scale, rotate and translate");
      }
      out.matrix = matrix(object["matrix"], place + ".matrix");
    }
    if (object.contains("scale")) {
      const json& scale = object["scale"];
      const std::string at = place + ".scale";
      const std::string form = "give a number or an array of 3 numbers, none of them 0";
      require(scale.is_number() || scale.is_array(), at, "must be a number or an array of 3", form);
      out.scale = scale.is_array() ? vec3(scale, at) : Vec3(Vec3::Constant(number(scale, at)));
      require((out.scale->array() != 0).all(), at, "is 0, which leaves no mesh", form);
    }
    if (object.contains("rotate")) {
      const json& rotate = object["rotate"];
      const std::string at = place + ".rotate";
      const std::string form = "write {\"axis\": [0, 0, 1], \"angle\": RADIANS}";
      require(rotate.is_object(), at, "must be a JSON object", form);
      if (rotate.contains("quaternion")) {
        check_keys(rotate, at, {"quaternion"});
        const json& q = rotate["quaternion"];
        const std::string of = at + ".quaternion";
        const std::string four =
            "write {\"w\": W, \"x\": X, \"y\": Y, \"z\": Z} or [X, Y, Z, W], not all of them 0";
        std::array<double, 4> values{};
        if (q.is_object()) {
          check_keys(q, of, {"w", "x", "y", "z"});
          for (std::size_t i = 0; i < 4; ++i) {
            const std::string key(1, "xyzw"[i]);
            require(q.contains(key), of + "." + key, "is missing", four);
            values[i] = number(q[key], of + "." + key);
          }
        } else {
          require(q.is_array() && q.size() == 4, of, "is neither four named numbers nor an array",
                  four);
          for (std::size_t i = 0; i < 4; ++i)
            values[i] = number(q[i], fmt::format("{}[{}]", of, i));
        }
        require(values != std::array<double, 4>{}, of, "is 0", four);
        out.rotate = Placement::Rotation{.quaternion = values};
      } else {
        out.rotate = rotation(rotate, at, form);
      }
    }
    if (object.contains("translate"))
      out.translate = vec3(object["translate"], place + ".translate");
    return out;
  }

  Placement::Rotation rotation(const json& rotate, const std::string& at,
                               const std::string& form) const {
    check_keys(rotate, at, {"axis", "angle"});
    require(rotate.contains("axis"), at + ".axis", "is missing", form);
    require(rotate.contains("angle"), at + ".angle", "is missing", form);
    const Placement::Rotation out{.axis = vec3(rotate["axis"], at + ".axis"),
                                  .angle = number(rotate["angle"], at + ".angle")};
    require((out.axis.array() != 0).any(), at + ".axis", "is the zero vector",
            "give a direction of any length");
    if (std::abs(out.angle) > 2 * std::numbers::pi)
      add_reading_notes(path_, {fmt::format("{}: {} rad: angles are in radians", at, out.angle)});
    return out;
  }

  // Returns the upper three rows of a 4 x 4 matrix. The last row must be 0, 0, 0, 1.
  std::array<std::array<double, 4>, 3> matrix(const json& value, const std::string& place) const {
    const std::string form =
        "write four rows of four numbers, as in [[1,0,0,X],[0,1,0,Y],[0,0,1,Z],[0,0,0,1]]";
    require(value.is_array() && value.size() == 4, place, "must be an array of 4 rows", form);
    std::array<std::array<double, 4>, 3> out{};
    for (std::size_t i = 0; i < 4; ++i) {
      const std::string row = fmt::format("{}[{}]", place, i);
      require(value[i].is_array() && value[i].size() == 4, row, "must be an array of 4 numbers",
              form);
      for (std::size_t k = 0; k < 4; ++k) {
        const double x = number(value[i][k], fmt::format("{}[{}]", row, k));
        if (i < 3) out[i][k] = x;
        require(i < 3 || x == (k == 3 ? 1 : 0), row, "must be [0, 0, 0, 1]", form);
      }
    }
    std::array<double, 9> linear{};
    for (std::size_t k = 0; k < 9; ++k) linear[k] = out[k / 3][k % 3];
    require(is_invertible(linear), place, "has no inverse, so it flattens the mesh",
            "give a matrix whose determinant is not 0");
    return out;
  }

  std::string path_;
  Lines lines_;
  MeshCache& meshes_;
};

struct Parsed {
  json root;
  Lines lines;
};

// Parses a scene file. Throws Error if the syntax is wrong or a key occurs twice in one object.
Parsed parsed(const std::string& text, const std::string& path) {
  const std::string remedy = "correct the JSON";
  if (text.empty()) throw Error(path, "the file is empty", "write {\"objects\": [...]}");
  long at = 1;
  Syntax syntax(at);
  const Reading begin(text.data(), &at), end(text.data() + text.size(), &at);
  if (!json::sax_parse(begin, end, &syntax)) {
    const std::size_t before = std::min(syntax.at - (syntax.at > 0), text.size());
    const long line = 1 + std::count(text.begin(), text.begin() + static_cast<long>(before), '\n');
    throw Error(path, clean_name(syntax.reason), remedy, line);
  }
  if (!syntax.twice.empty()) {
    throw Error(path, "the key " + quote_token(syntax.twice) + " occurs twice in one object",
                "delete one of them");
  }
  return {json::parse(text), syntax.lines};
}

Scene parse(const std::string& text, const std::string& path, MeshCache& meshes) {
  const Parsed file = parsed(text, path);
  SceneFile reader(path, file.lines, meshes);
  const bool later_frame = !meshes.numbered_paths().empty();  // the first frame fills the cache
  Scene scene = reader.read(file.root).finish();
  if (file.root.contains("ignore")) {
    scene.ignored = reader.read_ignored(
        file.root["ignore"], scene, later_frame ? UnknownName::passed_over : UnknownName::refused);
  }
  return scene;
}

// Meshes up to this total size stay in the cache, since a scene file may name a mesh again.
constexpr std::size_t kKeptBytes = std::size_t{256} << 20;

std::vector<ObjectPair> stream_file(const std::string& path, MeshCache& meshes,
                                    const TakePart& take) {
  std::size_t bytes = 0;  // total size of the parts since the cache was emptied
  const Parsed file = parsed(read_file(path, kMaxSceneFileBytes), path);
  const bool ignores = file.root.contains("ignore");
  Scene names;  // has all objects, but only their names
  SceneFile reader(path, file.lines, meshes);
  reader.read(file.root, [&](SceneBuilder& builder) {
    Scene part = builder.take_part();
    if (ignores) {
      for (const Object& object : part.objects) names.objects.push_back({.name = object.name});
    }
    bytes += part.vertices.size() * sizeof(Vec3) + part.triangles.size() * 20;
    if (bytes > kKeptBytes) {
      meshes.clear();
      bytes = 0;
    }
    take(part);
  });
  if (!ignores) return {};
  return reader.read_ignored(file.root["ignore"], names);
}

// Returns a name for the object of each mesh file: the file's name without its extension. If
// several files have the same name, their folders are added.
std::vector<std::string> object_names(const std::vector<std::string>& paths) {
  std::map<std::string, std::set<std::string>> called;  // keys: names without extension
  for (const std::string& path : paths) called[mesh_stem(path)].insert(path);
  std::vector<std::string> out;
  for (const std::string& path : paths) {
    const std::string stem = mesh_stem(path);
    const std::string folder = std::filesystem::path(path).parent_path().filename().string();
    const bool alone = called[stem].size() == 1 || folder.empty();
    out.push_back(path == "-" ? "stdin" : alone ? stem : folder + "/" + stem);
  }
  return out;
}

// Builds a scene of mesh files. First checks all extensions, so that a bad argument is refused
// before minutes of reading. Calls added() after each file.
SceneBuilder scene_of_meshes(const std::vector<std::string>& paths, MeshCache& meshes,
                             const std::function<void(SceneBuilder&)>& added = {}) {
  for (const std::string& path : paths) {
    if (is_scene_file(path) || is_builtin_scene(path)) {
      throw Error(path, "a scene stands among other arguments",
                  "name one scene alone, or only mesh files");
    }
    if (path != "-") mesh_format(path);
  }
  const std::vector<std::string> names = object_names(paths);
  std::string name = names[0];
  for (std::size_t i = 1; i < paths.size() && i < 3; ++i) name += "+" + names[i];
  if (paths.size() > 3) name += fmt::format("+{} more", paths.size() - 3);
  SceneBuilder builder(clean_name(name + meshes.note()), paths[0]);
  for (std::size_t i = 0; i < paths.size(); ++i) {
    builder.add(meshes.get(paths[i]), names[i]);
    if (added) added(builder);
  }
  return builder;
}

MeshReading reading_of(const SceneArguments& arguments) {
  MeshReading out{.weld = arguments.weld.value_or(""), .format = {}};
  if (arguments.weld) parse_weld(*arguments.weld);
  if (arguments.format) out.format = named_format(*arguments.format);
  return out;
}

Scene load_any_scene(const std::vector<std::string>& arguments, MeshCache& meshes) {
  if (arguments.empty()) {
    throw Error("SCENE", "no scene is named",
                "name mesh files, a scene file or a built-in scene (farcull scenes lists them)");
  }
  if (arguments.size() > 1) return scene_of_meshes(arguments, meshes).finish();
  const std::string& name = arguments[0];
  if (is_builtin_scene(name)) return make_builtin_scene(name);
  if (is_scene_file(name)) return parse(read_file(name, kMaxSceneFileBytes), name, meshes);
  if (name == "-" || has_mesh_extension(name)) return scene_of_meshes(arguments, meshes).finish();
  std::error_code error;
  if (std::filesystem::is_directory(name, error)) {
    throw Error(name, "is a folder",
                "name its files, as in " + (std::filesystem::path(name) / "*.stl").string() +
                    "; farcull clash takes the folder itself");
  }
  if (const std::optional<Error> foreign = foreign_mesh(name)) throw *foreign;
  require_known(name);
  throw Error(name,
              "neither a built-in scene nor a file that ends in .obj, .off, .ply, .stl or .json",
              likely_name(name) + "farcull scenes lists the built-in scenes");
}

}  // namespace

std::vector<std::string> SceneArguments::words() const {
  std::vector<std::string> out = names;
  if (weld) out.push_back("--weld=" + *weld);
  if (format) out.push_back("--format=" + *format);
  if (ignore) out.push_back("--ignore=" + *ignore);
  return out;
}

void ignore_more(Scene& scene, const SceneArguments& arguments, UnknownName lacking) {
  scene.ignored =
      in_order(ignored_objects(scene, ignored_names(arguments.ignore, {}), lacking), scene.ignored);
}

void require_meshes(const SceneArguments& arguments) {
  const std::vector<std::string>& names = arguments.names;
  if (arguments.weld && names.size() == 1 && is_builtin_scene(names[0]))
    throw Error("--weld", "has no meaning for a built-in scene", "leave it out");
  const auto may_read = [](const std::string& name) { return name == "-" || is_scene_file(name); };
  if (arguments.format && std::ranges::none_of(names, may_read)) {
    throw Error("--format", "is of a mesh on standard input, and none is named",
                "name it, by -, or leave --format out");
  }
}

Scene load_scene(const SceneArguments& arguments) {
  MeshCache meshes;
  return load_scene(arguments, meshes);
}

Scene load_scene(const SceneArguments& arguments, MeshCache& meshes) {
  const bool later_frame = !meshes.numbered_paths().empty();
  require_meshes(arguments);
  try {
    meshes.read_as(reading_of(arguments));
    Scene out = load_any_scene(arguments.names, meshes);
    ignore_more(out, arguments, later_frame ? UnknownName::passed_over : UnknownName::refused);
    return out;
  } catch (const std::bad_alloc&) {
    throw Error(arguments.names[0], "the scene does not fit into memory",
                "give fewer or smaller objects, or use a larger machine");
  }
}

std::vector<ObjectPair> stream_scene(const SceneArguments& given, const TakePart& take) {
  const std::vector<std::string>& arguments = given.names;
  require_meshes(given);
  MeshCache meshes;
  meshes.read_as(reading_of(given));
  if (arguments.size() == 1 && is_builtin_scene(arguments[0])) {
    const SceneRequest request = parse_scene_name(arguments[0]);
    if (request.entry->name == "field" && request.suffixes.empty()) {
      const std::uint64_t seed = request.parameters.seed.value_or(*request.entry->seed);
      stream_field(request.parameters, seed, arguments[0], take);
      return {};
    }
  } else if (arguments.size() == 1 && is_scene_file(arguments[0])) {
    return stream_file(arguments[0], meshes, take);
  } else if (arguments.size() > 1 || (arguments.size() == 1 && has_mesh_extension(arguments[0]))) {
    scene_of_meshes(arguments, meshes, [&](SceneBuilder& builder) {
      meshes.clear();  // frees the mesh: the builder has a copy
      Scene part = builder.take_part();
      take(part);
    });
    return {};
  }
  Scene whole = load_scene(given);
  const std::vector<ObjectPair> ignored = std::exchange(whole.ignored, {});
  take(whole);
  return ignored;
}

bool is_scene_file(const std::string& name) {
  return lower_case(std::filesystem::path(name).extension().string()) == ".json";
}

std::vector<std::string> meshes_of_scene_file(const std::string& path) {
  std::vector<std::string> out;
  json root;
  try {
    root = json::parse(read_file(path, kMaxSceneFileBytes), nullptr, false);
  } catch (const Error&) {
    return out;
  }
  if (!root.is_object() || !root.contains("objects") || !root["objects"].is_array()) return out;
  for (const json& object : root["objects"]) {
    if (!object.is_object() || !object.contains("mesh") || !object["mesh"].is_string()) continue;
    const auto mesh = object["mesh"].get<std::string>();
    if (mesh.size() <= kMaxPathBytes) out.push_back(mesh_path(path, mesh));
  }
  return out;
}

Scene parse_scene_file(const std::string& text, const std::string& path) {
  MeshCache meshes;
  return parse(text, path, meshes);
}

void require_known(const std::string& name) {
  if (is_builtin_scene(name)) {
    parse_scene_name(name);
    return;
  }
  std::error_code error;
  const std::filesystem::path path = name, folder = path.parent_path();
  if (name.find('%') != std::string::npos || std::filesystem::exists(path, error)) return;
  std::vector<std::string> files;
  for (const auto& entry :
       std::filesystem::directory_iterator(folder.empty() ? "." : folder, error)) {
    const std::string file = entry.path().filename().string();
    if (has_mesh_extension(file) || is_scene_file(file)) files.push_back(file);
  }
  std::ranges::sort(files);
  const std::string file = likely_word(path.filename().string(), files);
  throw Error(name, "no built-in scene has this name, and there is no such file",
              (file.empty() ? likely_name(name) : did_you_mean((folder / file).string())) +
                  "farcull scenes lists the built-in scenes");
}

}  // namespace farcull
