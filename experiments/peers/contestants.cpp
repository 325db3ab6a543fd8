// Lists the contestants that the study knows, and runs study.py by Python.
#include "experiments/peers/contestants.h"

#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "core/base/error.h"
#include "core/view/view.h"
#include "embedded/ask_py.h"
#include "embedded/study_py.h"
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
  add("peers", "libcgal-dev", "mesh", {"cgal-boxes-exact", "cgal-aabb-exact"});
  add("peers", "libfcl-dev", "mesh", {"fcl-obbrss-exact"});
  add("peers", "libembree-dev", "mesh", {"embree-medium-exact"});
  add("peers", "libbullet-dev", "mesh", {"bullet-gimpact-exact"});
  return all;
}

/// study.py imports ask.py, which is handed to it as its argument.
constexpr const char* kImport =
    "import sys, types\nsys.modules['ask'] = ask = types.ModuleType('ask')\n"
    "exec(sys.argv.pop(1), ask.__dict__)\n";

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

bool answers(const KnownContestant& contestant, const std::string& question) {
  const std::vector<std::string> all = split_list(contestant.answers, ' ');
  return std::find(all.begin(), all.end(), question) != all.end();
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
  // One process of Python answers all: to start it takes longer than most questions.
  static FILE *questions = nullptr, *answers = nullptr;
  if (questions == nullptr) {
    std::array<int, 2> ends = {-1, -1};
    if (::pipe(ends.data()) != 0) throw Error("study.py", "got no pipe", "allow more open files");
    ::fcntl(ends[0], F_SETFD, FD_CLOEXEC);
    std::string line = "exec";
    const std::string program = std::string(kImport) + embedded::study_py;
    for (const std::string& word : {python(), {"-I"}, {"-B"}, {"-c"}, program, {embedded::ask_py}})
      line += " " + quoted(word);
    questions = ::popen((line + " >/dev/fd/" + std::to_string(ends[1])).c_str(), "we");
    ::close(ends[1]);
    answers = ::fdopen(ends[0], "r");
  }
  std::string call;
  for (const std::string& word : options) call += word + '\0';
  call += std::string("--") + '\0' + command + '\0' + '\0';
  char* text = nullptr;
  std::size_t size = 0;
  if (questions != nullptr) {
    std::fwrite(call.data(), 1, call.size(), questions);
    std::fflush(questions);
  }
  const bool answered = answers != nullptr && ::getline(&text, &size, answers) > 0;
  nlohmann::json out = nlohmann::json::parse(answered ? text : "", nullptr, false);
  std::free(text);
  if (!answered) {  // it has ended; the next call starts another one
    if (questions != nullptr) ::pclose(questions);
    std::fclose(answers);
    questions = nullptr;
  }
  if (out.is_discarded() || out.contains("error")) {
    throw Error(command, out.is_discarded() ? "cannot be asked" : out["error"].get<std::string>(),
                "install Python 3.8 or later; docs/ask.md has the protocol");
  }
  return out;
}

}  // namespace farcull
