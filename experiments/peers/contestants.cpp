// Lists the contestants that the study knows, and runs ask.py by Python.
#include "experiments/peers/contestants.h"

#include <unistd.h>

#include <algorithm>
#include <array>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "core/base/error.h"
#include "embedded/ask_py.h"
#include "experiments/system/python.h"
#include "experiments/system/text_table.h"

namespace farcull {
namespace {

using Names = std::vector<const char*>;

std::vector<KnownContestant> make_list() {
  std::vector<KnownContestant> all;
  const auto add = [&](const char* program, const char* package, const char* answers,
                       const Names& names) {
    for (const char* name : names) all.push_back({name, program, package, answers});
  };
  constexpr const char* kNode = "nodejs, npm, and then packages of npm: experiments/libraries.sh";
  add("ours", "", "pair mesh", {"boxes"});
  add("ours", "", "pair mesh distance self inside clash", {"exact"});
  add("ours", "", "pair mesh", {"far", "i-collide", "far-at-0.9"});
  add("cgal", "libcgal-dev", "pair mesh inside", {"cgal-exact"});
  add("cgal", "libcgal-dev", "pair mesh self", {"cgal-self-intersections"});
  add("cgal", "libcgal-dev", "pair", {"cgal-do-intersect", "cgal-double"});
  add("peers", "libcgal-dev", "distance", {"cgal-aabb"});
  add("peers", "libfcl-dev", "pair mesh distance", {"fcl-double", "fcl-float"});
  add("bullet_double", "libbullet-dev", "pair mesh",
      {"bullet-gimpact-double", "bullet-gimpact-margin-double"});
  add("bullet_float", "libbullet-dev", "pair mesh",
      {"bullet-gimpact-float", "bullet-gimpact-margin-float"});
  add("peers", "libode-dev", "pair mesh", {"ode-trimesh"});
  add("libccd", "libccd-dev", "pair", {"libccd-gjk", "libccd-mpr"});
  add("gts", "libgts-dev", "pair mesh", {"gts"});
  add("vtk", "libvtk9-dev", "pair mesh", {"vtk-collision"});
  add("vtk", "libvtk9-dev", "pair", {"vtk-triangle", "vtk-intersection"});
  add("open3d", "libopen3d-dev", "pair mesh", {"open3d"});
  add("node", kNode, "pair mesh distance", {"three-mesh-bvh"});
  add("node", kNode, "pair distance inside", {"rapier3d"});
  add("node", kNode, "pair", {"cannon-es"});
  add("node", kNode, "clash", {"manifold-3d"});
  add("node", kNode, "inside", {"jolt-physics"});
  add("textbook", "", "pair",
      {"moeller-double", "moeller-double-0", "moeller-float", "guigue-devillers-double",
       "guigue-devillers-float", "edge-face-double"});
  return all;
}

}  // namespace

const std::vector<KnownContestant>& known_contestants() {
  static const std::vector<KnownContestant> all = make_list();
  return all;
}

const KnownContestant& known_contestant(const std::string& name) {
  const std::vector<KnownContestant>& all = known_contestants();
  const auto at = std::find_if(all.begin(), all.end(),
                               [&](const KnownContestant& of) { return of.name == name; });
  if (at == all.end()) {
    std::string names;
    for (const KnownContestant& of : all) names += (names.empty() ? "" : ", ") + of.name;
    throw Error("contestant", "'" + name + "' is none", "choose of " + names);
  }
  return *at;
}

std::string command_of(const KnownContestant& contestant) {
  const char* const named = std::getenv("FARCULL_CONTESTANTS");
  std::error_code error;
  const std::string folder =
      named != nullptr && *named != '\0'
          ? named
          : std::filesystem::read_symlink("/proc/self/exe", error).parent_path() / "contestants";
  const std::string path = folder + "/farcull_contestant_" + contestant.program;
  return ::access(path.c_str(), X_OK) == 0 ? quoted(path) + " " + contestant.name : "";
}

nlohmann::json ask_program(const std::string& command, const std::vector<std::string>& options) {
  std::string line;
  for (const char* word : {"-I", "-B", "-c", embedded::ask_py, "--json"})
    line += " " + quoted(word);
  for (const std::string& word : options) line += " " + quoted(word);
  line = "exec " + quoted(python()) + line + " -- " + quoted(command) + " 2>&1";
  FILE* const pipe = ::popen(line.c_str(), "re");
  if (pipe == nullptr) throw Error("ask.py", "cannot be started", "allow more processes");
  std::string text;
  std::array<char, 1 << 16> part;
  for (std::size_t size; (size = std::fread(part.data(), 1, part.size(), pipe)) > 0;)
    text.append(part.data(), size);
  const int status = ::pclose(pipe);
  nlohmann::json out = nlohmann::json::parse(text, nullptr, false);
  if (status != 0 || out.is_discarded()) {
    throw Error(command, "cannot be asked: " + text.substr(0, text.find('\n')),
                "install Python 3.8 or later; docs/ask.md has the protocol");
  }
  return out;
}

}  // namespace farcull
