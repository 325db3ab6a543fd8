// The study "libraries": wrong answers of other libraries, textbook tests and our own methods on a
// labelled suite. study.py asks each contestant (peers/contestants.h).
#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <map>
#include <nlohmann/json.hpp>
#include <variant>

#include "core/base/error.h"
#include "experiments/generators/pair_generators.h"
#include "experiments/measure/harness.h"
#include "experiments/peers/contestants.h"
#include "experiments/studies/study.h"
#include "experiments/suite/writer.h"

namespace farcull {
namespace {

using Json = nlohmann::json;

SuiteSize size_of(bool small) { return small ? SuiteSize::small : SuiteSize::full; }

/// The families of meshes with these names: `cogs` of cogs-1, cogs-2 and so on.
std::vector<std::string> mesh_families(const std::vector<std::string>& names) {
  std::vector<std::string> out;
  for (const std::string& name : names) {
    const std::size_t end = name.find_last_not_of("0123456789");
    const bool numbered = end != std::string::npos && end + 1 < name.size() && name[end] == '-';
    const std::string family = numbered ? name.substr(0, end) : name;
    if (std::find(out.begin(), out.end(), family) == out.end()) out.push_back(family);
  }
  return out;
}

std::vector<std::string> last_parts(const std::vector<std::string>& paths) {
  std::vector<std::string> out;
  for (const std::filesystem::path path : paths) out.push_back(path.stem().string());
  return out;
}

// Lists all contestants of one family together.
std::vector<Point> grid(const GridChoice& choice) {
  LibraryPoint point{.small = choice.quick, .seed = choice.seed, .suite = choice.suite};
  std::vector<std::string> families, meshes;
  if (choice.suite.empty()) {
    for (const PairFamily& family : pair_families()) families.push_back(family.name);
    meshes = mesh_names(size_of(choice.quick));
  } else {
    const SuiteIndex index = read_suite(choice.suite);
    point.suite_name = index.sum.substr(0, 8);
    families = last_parts(index.pair_files());
    meshes = last_parts(index.mesh_folders());
  }
  std::vector<Point> out;
  const auto add = [&](const std::string& question, const std::vector<std::string>& names) {
    const std::vector<std::string>& chosen = choice.contestants;
    point.question = question;
    for (const std::string& name : names) {
      point.family = name;
      for (const KnownContestant& contestant : known_contestants()) {
        point.contestant = contestant.name;
        if (answers(contestant, question) &&
            (chosen.empty() ||
             std::find(chosen.begin(), chosen.end(), contestant.name) != chosen.end()))
          out.emplace_back(point);
      }
    }
  };
  add("pair", families);
  add("mesh", mesh_families(meshes));
  for (const char* question : {"distance", "self", "inside", "clash"}) add(question, {"all"});
  return out;
}

/// The folder of the point's suite. A suite that was not given is made in the folder that the
/// variable FARCULL_MADE_SUITE names, unless it is there.
std::string folder_of(const LibraryPoint& point) {
  if (!point.suite.empty()) return point.suite;
  const char* const named = std::getenv("FARCULL_MADE_SUITE");
  if (named == nullptr || *named == '\0')
    throw Error("FARCULL_MADE_SUITE", "names no folder for the suite", "set it");
  const std::string folder = named;
  if (!std::filesystem::exists(folder + "/suite.txt"))
    write_suite(folder, {.size = size_of(point.small), .seed = point.seed});
  const SuiteIndex index = read_suite(folder);
  if (index.size != (point.small ? "small" : "full") || index.seed != point.seed)
    throw Error(folder, "is a suite of another size or seed", "remove it, or use another folder");
  return folder;
}

/// The card of a contestant, asked once; null if its program is not there or gives no card.
struct Asked {
  std::string command = {};
  Json card = {};
  std::string missing = {};
};

const Asked& ask_card(const KnownContestant& contestant) {
  static std::map<std::string, Asked> known;
  const std::string command = command_of(contestant);
  Asked& out = known[contestant.name + " " + command];
  if (!out.command.empty() || !out.missing.empty()) return out;
  out.command = command;
  try {
    if (command.empty())
      out.missing = contestant.name + ": its program was not built";
    else
      out.card = ask_program(command, {"--question", "card"});
  } catch (const Error& error) {
    out.missing = contestant.name + ": " + error.reason;
  }
  if (!out.missing.empty() && !contestant.package.empty())
    out.missing += " (Debian: " + contestant.package + ")";
  return out;
}

/// The line of a pair in a list of the suite, with the kind that the oracles find.
std::string line_of(const Json& example) {
  SuitePair pair;
  pair.parameter = example["parameter"];
  for (std::size_t i = 0; i < 18; ++i) {
    (i < 9 ? pair.a : pair.b)[i / 3 % 3][static_cast<Eigen::Index>(i % 3)] =
        example["numbers"][i].get<double>();
  }
  pair.kind = decide(pair, "an example");
  return pair_line(pair);
}

/// Sets a field to the value of that name, if there is one.
template <class T>
void take(const Json& from, const std::string& name, T& field) {
  if (from.contains(name)) field = from[name].template get<T>();
}
void take(const Json& from, const std::string& name, std::optional<std::uint64_t>& field) {
  if (from.contains(name)) field = from[name].get<std::uint64_t>();
}

LibraryCounts counts_of(const Json& found) {
  LibraryCounts out;
  const Json &counts = found["counts"], &card = found["card"], &examples = found["examples"];
  std::string_view names = LibraryCounts::kFieldNames;
  std::apply(
      [&](auto&... field) {
        const auto set = [&](const std::string& name, auto& to) {
          using Of = std::decay_t<decltype(to)>;
          if constexpr (std::is_same_v<Of, std::string>)
            take(card, name, to);
          else if constexpr (std::is_same_v<Of, std::uint64_t> ||
                             std::is_same_v<Of, std::optional<std::uint64_t>>)
            take(counts, name, to);
        };
        (set(std::string(take_field_name(names)), field), ...);
      },
      out.members());
  out.promises = card["promises"] == "yes";
  out.reason = found["reason"];
  out.scores = found["scores"];
  if (out.zero) out.worst = found["worst"].get<double>();
  const auto example = [&](const char* fault, std::optional<std::string>& to) {
    if (examples.contains(fault)) to = line_of(examples[fault]);
  };
  example("missed", out.example_missed);
  example("wrong", out.example_wrong);
  example("death", out.example_death);
  return out;
}

PointResult measure(const Point& at, Lab& lab) {
  const auto& point = std::get<LibraryPoint>(at);
  const Asked& asked = ask_card(known_contestant(point.contestant));
  if (!asked.missing.empty()) return {.device = "none", .left_out = asked.missing};
  const bool longer = !point.small && point.question != "pair" && point.question != "distance";
  // Our own methods read the variable.
  const std::string command = "env FARCULL_CONTEST_DEVICE=" + lab.device() + " " + asked.command;
  const Json found = ask_program(
      command, {"--suite", folder_of(point), "--question", point.question, "--family", point.family,
                "--limit", longer ? "30" : "5", "--deaths", point.small ? "20" : "100"});
  return {.counts = counts_of(found),
          .times = {.total = found["ns"].get<double>() / 1e6},
          .device = "process"};
}

std::string library(const Point& at) {
  const Asked& asked = ask_card(known_contestant(std::get<LibraryPoint>(at).contestant));
  return asked.missing.empty() ? asked.card["library"].get<std::string>() : "";
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
