// The study "libraries": wrong answers of other libraries, textbook tests and our own methods on a
// labelled suite. A point is a contestant (peers/contestants.h) and a kind of question. ask.py asks
// and counts; here its counts become a row.
#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <map>
#include <nlohmann/json.hpp>
#include <variant>

#include "core/base/error.h"
#include "core/view/view.h"
#include "experiments/measure/harness.h"
#include "experiments/peers/contestants.h"
#include "experiments/studies/study.h"
#include "experiments/suite/writer.h"

namespace farcull {
namespace {

using Json = nlohmann::json;

// Lists all contestants of one question together.
std::vector<Point> grid(const GridChoice& choice) {
  LibraryPoint point{.small = choice.quick, .seed = choice.seed, .suite = choice.suite};
  if (!choice.suite.empty()) point.suite_name = read_suite(choice.suite).sum.substr(0, 8);
  const std::vector<std::string>& chosen = choice.contestants;
  std::vector<Point> out;
  for (const char* question : {"pair", "mesh", "distance", "self", "inside", "clash"}) {
    point.question = question;
    for (const KnownContestant& contestant : known_contestants()) {
      const std::vector<std::string> answers = split_list(contestant.answers, ' ');
      point.contestant = contestant.name;
      if (std::find(answers.begin(), answers.end(), question) != answers.end() &&
          (chosen.empty() ||
           std::find(chosen.begin(), chosen.end(), contestant.name) != chosen.end()))
        out.emplace_back(point);
    }
  }
  return out;
}

/// The folder of the point's suite. If none was given, the suite is made in the folder that the
/// variable FARCULL_MADE_SUITE names, unless that has it already.
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

/// A contestant's library with its version, or why it cannot be asked. Each is asked once.
struct Asked {
  std::string command = {}, library = {}, missing = {};
};

const Asked& ask_card(const KnownContestant& contestant) {
  static std::map<std::string, Asked> known;
  const std::string command = command_of(contestant);
  const auto [at, fresh] = known.try_emplace(contestant.name + " " + command);
  Asked& out = at->second;
  if (!fresh) return out;
  out.command = command;
  try {
    if (command.empty())
      out.missing = contestant.name + ": its program was not built";
    else
      out.library = ask_program(command, {"--only", "card"})["counts"]["library"];
  } catch (const Error& error) {
    out.missing = contestant.name + ": " + error.reason;
  }
  if (!out.missing.empty() && !contestant.package.empty())
    out.missing += " (Debian: " + contestant.package + ")";
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
  const Asked& asked = ask_card(known_contestant(point.contestant));
  if (!asked.missing.empty()) return {.device = "none", .left_out = asked.missing};
  const bool longer = !point.small && point.question != "pair" && point.question != "distance";
  // Our own methods read the variable.
  const std::string command = "env FARCULL_CONTEST_DEVICE=" + lab.device() + " " + asked.command;
  const Json found =
      ask_program(command, {"--suite", folder_of(point), "--only", point.question, "--limit",
                            longer ? "30" : "5", "--deaths", point.small ? "20" : "100"});
  return {.counts = counts_of(found),
          .times = {.total = found["ns"].get<double>() / 1e6},
          .device = "process"};
}

std::string library(const Point& at) {
  return ask_card(known_contestant(std::get<LibraryPoint>(at).contestant)).library;
}

}  // namespace

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
