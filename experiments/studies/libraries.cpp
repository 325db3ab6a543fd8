// The study "libraries" counts wrong answers of other libraries, textbook tests and our own methods
// on a labelled suite. A point is a contestant and a kind of question. experiments/suite/ask.py
// sends the questions to the contestant's program (docs/ask.md) and counts errors. This file turns
// the counts into a row.
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <map>
#include <nlohmann/json.hpp>

#include "core/base/error.h"
#include "core/view/view.h"
#include "embedded/ask_py.h"
#include "experiments/measure/harness.h"
#include "experiments/studies/study.h"
#include "experiments/suite/writer.h"
#include "experiments/system/python.h"
#include "experiments/system/text_table.h"

namespace farcull {
namespace {

using Json = nlohmann::json;

/// Contestants that one program implements and that answer the same questions.
struct KnownContestants {
  std::vector<std::string> names;
  std::string program;  // the executable's name is farcull_contestant_ and this text
  std::string package;  // the package that the program needs; empty: none
  std::string answers;  // the questions that the study asks, such as "pair mesh"
};

/// Returns all contestants, in the order of the rows of tables. Every build has this order.
const std::vector<KnownContestants>& known_contestants() {
  const std::string npm = "nodejs, npm, and then packages of npm: experiments/libraries.sh";
  static const std::vector<KnownContestants> all = {
      {{"boxes"}, "ours", "", "pair mesh"},
      {{"exact"}, "ours", "", "pair mesh distance self inside clash"},
      {{"far", "i-collide", "far-at-0.9"}, "ours", "", "pair mesh"},
      {{"cgal-exact"}, "cgal", "libcgal-dev", "pair mesh inside"},
      {{"cgal-self-intersections"}, "cgal", "libcgal-dev", "pair mesh self"},
      {{"cgal-do-intersect", "cgal-double"}, "cgal", "libcgal-dev", "pair"},
      {{"cgal-aabb"}, "peers", "libcgal-dev", "distance"},
      {{"fcl-double", "fcl-float"}, "peers", "libfcl-dev", "pair mesh distance"},
      {{"bullet-gimpact-double", "bullet-gimpact-margin-double"},
       "bullet_double",
       "libbullet-dev",
       "pair mesh"},
      {{"bullet-gimpact-float", "bullet-gimpact-margin-float"},
       "bullet_float",
       "libbullet-dev",
       "pair mesh"},
      {{"ode-trimesh"}, "peers", "libode-dev", "pair mesh"},
      {{"libccd-gjk", "libccd-mpr"}, "libccd", "libccd-dev", "pair"},
      {{"gts"}, "gts", "libgts-dev", "pair mesh"},
      {{"vtk-collision"}, "vtk", "libvtk9-dev", "pair mesh"},
      {{"vtk-triangle", "vtk-intersection"}, "vtk", "libvtk9-dev", "pair"},
      {{"open3d"}, "open3d", "libopen3d-dev", "pair mesh"},
      {{"three-mesh-bvh"}, "node", npm, "pair mesh distance"},
      {{"rapier3d"}, "node", npm, "pair distance inside"},
      {{"cannon-es"}, "node", npm, "pair"},
      {{"manifold-3d"}, "node", npm, "clash"},
      {{"jolt-physics"}, "node", npm, "inside"},
      {{"moeller-double", "moeller-double-0", "moeller-float", "guigue-devillers-double",
        "guigue-devillers-float", "edge-face-double"},
       "textbook",
       "",
       "pair"}};
  return all;
}

const KnownContestants& known_contestant(const std::string& name) {
  std::vector<std::string> names;
  for (const KnownContestants& of : known_contestants()) {
    if (std::ranges::count(of.names, name) > 0) return of;
    names.insert(names.end(), of.names.begin(), of.names.end());
  }
  throw Error("contestant", "'" + name + "' is none",
              fmt::format("choose of {}", fmt::join(names, ", ")));
}

/// Returns the command line of the contestant's program. The program is in the folder that the
/// variable FARCULL_CONTESTANTS names, else in the folder `contestants` beside this program.
/// Returns "" if the program was not built.
std::string command_of(const std::string& name) {
  const char* const named = std::getenv("FARCULL_CONTESTANTS");
  std::error_code error;
  const std::string folder =
      named != nullptr && *named != '\0'
          ? named
          : std::filesystem::read_symlink("/proc/self/exe", error).parent_path() / "contestants";
  const std::string path = folder + "/farcull_contestant_" + known_contestant(name).program;
  return ::access(path.c_str(), X_OK) == 0 ? quoted(path) + " " + name : "";
}

/// Runs `ask.py --json` with these options on the program that `command` starts, and returns what
/// ask.py prints. Throws Error with the reason if ask.py fails.
Json ask_program(const std::string& command, const std::vector<std::string>& options) {
  std::string line = "exec " + quoted(python());
  for (const char* word : {"-I", "-B", "-c", embedded::ask_py, "--json"})
    line += " " + quoted(word);
  for (const std::string& word : options) line += " " + quoted(word);
  line += " -- " + quoted(command) + " 2>&1";
  FILE* const pipe = ::popen(line.c_str(), "re");
  if (pipe == nullptr) throw Error("ask.py", "cannot be started", "allow more processes");
  std::string text;
  std::array<char, 1 << 16> part;
  for (std::size_t size; (size = std::fread(part.data(), 1, part.size(), pipe)) > 0;)
    text.append(part.data(), size);
  const int status = ::pclose(pipe);
  Json out = Json::parse(text, nullptr, false);
  if (status != 0 || out.is_discarded()) {
    throw Error(command, "cannot be asked: " + text.substr(0, text.find('\n')),
                "install Python 3.8 or later; docs/ask.md has the protocol");
  }
  return out;
}

/// Returns the points of the study. The points of one kind of question are adjacent.
std::vector<Point> grid(const GridChoice& choice) {
  LibraryPoint point{.small = choice.quick, .seed = choice.seed, .suite = choice.suite};
  if (!choice.suite.empty()) point.suite_name = read_suite(choice.suite).sum.substr(0, 8);
  const std::vector<std::string>& chosen = choice.contestants;
  std::vector<Point> out;
  for (const char* question : {"pair", "mesh", "distance", "self", "inside", "clash"}) {
    point.question = question;
    for (const KnownContestants& contestants : known_contestants()) {
      if (std::ranges::count(split_list(contestants.answers, ' '), question) == 0) continue;
      for (const std::string& name : contestants.names) {
        point.contestant = name;
        if (chosen.empty() || std::ranges::count(chosen, name) > 0) out.emplace_back(point);
      }
    }
  }
  return out;
}

/// Returns point.suite, or if that is empty, the folder that the environment variable
/// FARCULL_MADE_SUITE names. Makes a suite in the variable's folder if the folder has none.
std::string folder_of(const LibraryPoint& point) {
  if (!point.suite.empty()) return point.suite;
  const char* const named = std::getenv("FARCULL_MADE_SUITE");
  if (named == nullptr || *named == '\0')
    throw Error("FARCULL_MADE_SUITE", "names no folder for the suite", "set it");
  const std::string folder = named;
  const SuiteSize size = point.small ? SuiteSize::small : SuiteSize::full;
  if (!std::filesystem::exists(folder + "/suite.txt"))
    write_suite(folder, {.size = size, .seed = point.seed});
  const SuiteIndex index = read_suite(folder);
  if (index.size != (point.small ? "small" : "full") || index.seed != point.seed)
    throw Error(folder, "is a suite of another size or seed", "remove it, or use another folder");
  return folder;
}

/// A contestant's command line and library, or the reason why the contestant cannot be asked.
struct Asked {
  std::string command = {}, library = {}, missing = {};
};

const Asked& ask_card(const std::string& contestant) {
  static std::map<std::string, Asked> known;
  const std::string command = command_of(contestant);
  const auto [at, fresh] = known.try_emplace(contestant + " " + command);
  Asked& out = at->second;
  if (!fresh) return out;
  out.command = command;
  try {
    if (command.empty())
      out.missing = contestant + ": its program was not built";
    else
      out.library = ask_program(command, {"--only", "card"})["counts"]["library"];
  } catch (const Error& error) {
    out.missing = contestant + ": " + error.reason;
  }
  const std::string& package = known_contestant(contestant).package;
  if (!out.missing.empty() && !package.empty()) out.missing += " (Debian: " + package + ")";
  return out;
}

LibraryCounts counts_of(const Json& found) {
  LibraryCounts out;
  for (const auto& [name, value] : found["counts"].items()) {
    if (value.is_boolean())
      out.values.emplace_back(name, value.get<bool>());
    else if (value.is_string())
      out.values.emplace_back(name, value.get<std::string>());
    else
      out.values.emplace_back(name, value.get<std::uint64_t>());
  }
  return out;
}

PointResult measure(const Point& at, MeasurementContext& lab) {
  const auto& point = std::get<LibraryPoint>(at);
  const Asked& asked = ask_card(point.contestant);
  if (!asked.missing.empty()) return {.device = "none", .left_out = asked.missing};
  const bool longer = !point.small && point.question != "pair" && point.question != "distance";
  // Contestants that are methods of farcull read FARCULL_CONTEST_DEVICE.
  const std::string command = "env FARCULL_CONTEST_DEVICE=" + lab.device() + " " + asked.command;
  const Json found =
      ask_program(command, {"--suite", folder_of(point), "--only", point.question, "--limit",
                            longer ? "30" : "5", "--deaths", point.small ? "20" : "100"});
  return {.counts = counts_of(found),
          .times = {.total = found["ns"].get<double>() / 1e6},
          .device = "process"};
}

std::string library(const Point& at) {
  return ask_card(std::get<LibraryPoint>(at).contestant).library;
}

}  // namespace

void require_contestant(const std::string& name) { known_contestant(name); }

Study libraries_study() {
  return {.name = "libraries",
          .title = "What other libraries miss",
          .question =
              "Which pairs of a labelled suite do libraries, textbook tests and the methods "
              "of farcull miss, report wrongly, or refuse, and at which do they crash?",
          .grid = grid,
          .measure = measure,
          .library = library,
          .campaign = true};
}

}  // namespace farcull
