// Measures the studies' quick grids on the native canvas, and compares their counts with the file
// of the repository or makes that file anew.
//   farcull_native_counts check|renew FILE [OPTION VALUE]..
//     --study NAME       that study alone
//     --meshes no|only|both  points on scenes of packaged meshes; default both
//     --first N          of the points of a study that have the same method, offset, radius rule
//     and
//                        kind of depth, the first N
//     --lanes NAME|all   an instruction set of the CPU, or each that it has; default the best
//     --threads LIST     numbers of threads, by commas; 0: as many as there are cores; default 0
//     --slow N           prints the N points that took longest
// Exit status: 0; 1 counts differ; 2 they could not be measured.
#include <algorithm>
#include <chrono>
#include <cstdio>
#include <set>
#include <string_view>

#include "core/base/text.h"
#include "core/native/lanes.h"
#include "tests/experiments/studies/native_counts.h"

namespace farcull::native_counts {
namespace {

constexpr const char* kHeader =
    "# Counts of the studies' quick grids (seed 1) on the native canvas: a function of the "
    "commit,\n"
    "# the same on every machine. docs/experiments.md, \"The same counts on every machine\".\n"
    "# Made by `bash experiments/native_counts.sh --renew`; compared by the same without --renew,\n"
    "# and by `ctest -R native-counts`. The format: tests/experiments/studies/native_counts.h.\n"
    "# Key: scene;method;offset;radius;depth_format;depth_mode;resolution;views;frame;seed\n";

struct Arguments {
  bool renew = false;
  std::string file;
  std::string study = {};
  std::string meshes = "both";
  std::size_t first = 0;  // 0: all
  std::vector<std::string> lanes = {""};
  std::vector<unsigned> threads = {0};
  std::size_t slow = 0;
};

[[noreturn]] void refuse(const std::string& word) {
  throw Error("farcull_native_counts", "'" + word + "' is none of its arguments",
              "see the top of tests/experiments/studies/native_counts_main.cpp");
}

unsigned number(std::string_view text) {
  const std::optional<unsigned> value = parse_number<unsigned>(text);
  if (!value) refuse(std::string(text));
  return *value;
}

Arguments arguments_of(const std::vector<std::string>& words) {
  if (words.size() < 2 || words.size() % 2 != 0) refuse(words.empty() ? "" : words.back());
  Arguments out{.renew = words[0] == "renew", .file = words[1]};
  if (!out.renew && words[0] != "check") refuse(words[0]);
  for (std::size_t i = 2; i < words.size(); i += 2) {
    const std::string &option = words[i], &value = words[i + 1];
    if (option == "--study") {
      out.study = study_named(value).name;
    } else if (option == "--meshes" && (value == "no" || value == "only" || value == "both")) {
      out.meshes = value;
    } else if (option == "--first") {
      out.first = number(value);
    } else if (option == "--slow") {
      out.slow = number(value);
    } else if (option == "--lanes") {
      out.lanes = value == "all" ? lane_targets() : std::vector{value};
    } else if (option == "--threads") {
      out.threads.clear();
      std::istringstream in(value);
      for (std::string item; std::getline(in, item, ',');) out.threads.push_back(number(item));
    } else {
      refuse(option + " " + value);
    }
  }
  // The file is made of all points, once.
  if (out.renew && (!out.study.empty() || out.first > 0 || out.meshes != "both" ||
                    out.lanes.size() * out.threads.size() > 1))
    refuse("renew");
  return out;
}

// What points share that --first counts as one kind.
std::string kind_of(const Point& point) {
  const PointKey key = key_of(point);
  const bool factor = !key.radius || (!key.radius->published && key.radius != kBudgetRadius);
  return key.method + ";" + key.offset + ";" + (factor ? "factor" : column_text(key.radius)) + ";" +
         column_text(key.depth_format) + ";" + column_text(key.depth_mode);
}

std::vector<StudyGridPoint> chosen_points(const Arguments& arguments) {
  std::vector<StudyGridPoint> out;
  for (const Study& study : studies()) {
    if (!arguments.study.empty() && study.name != arguments.study) continue;
    std::map<std::string, std::size_t> had;
    for (StudyGridPoint& point : quick_points(study)) {
      if (arguments.meshes != "both" && needs_meshes(point.point) != (arguments.meshes == "only"))
        continue;
      if (arguments.first > 0 && ++had[kind_of(point.point)] > arguments.first) continue;
      out.push_back(std::move(point));
    }
  }
  return out;
}

// Lines of the file, of the studies measured, that no point has.
std::string left_over(const Table& table, const Table& found, const Arguments& arguments) {
  std::string out;
  for (const auto& [section, lines] : table) {
    if (!arguments.study.empty() && study_of(section) != "[" + arguments.study + "]") continue;
    const auto at = found.find(section);
    for (const auto& [key, counts] : lines)
      if (at == found.end() || !at->second.contains(key))
        out += section + "\n  " + key + ": the file has it, and no point does\n";
  }
  return out;
}

int run(const Arguments& arguments) {
  const std::vector<StudyGridPoint> points = chosen_points(arguments);
  const Table table = arguments.renew ? Table() : read(arguments.file);
  std::size_t different = 0, lines = 0;
  const auto report = [&](const std::string& text, const std::string& where) {
    if (text.empty()) return;
    if (++different <= 10) std::printf("%s: %s", where.c_str(), text.c_str());
  };
  Table found;
  for (const std::string& lanes : arguments.lanes) {
    use_lane_target(lanes);
    for (const unsigned threads : arguments.threads) {
      const std::string where =
          lane_target() + ", " + (threads == 0 ? "all" : std::to_string(threads)) + " threads";
      std::vector<std::pair<double, std::string>> slow;
      Lab lab("native", {}, threads);
      const auto began = std::chrono::steady_clock::now();
      for (const StudyGridPoint& point : points) {
        const auto start = std::chrono::steady_clock::now();
        const Line line = measured(*point.study, point.point, key_of(point.point), lab);
        slow.emplace_back(
            std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count(),
            point.study->name + ": " + describe(point.point));
        ++lines;
        add(found, line);
        if (!arguments.renew) report(difference(table, line), where);
      }
      std::printf("%zu points on %s: %.1f s\n", points.size(), where.c_str(),
                  std::chrono::duration<double>(std::chrono::steady_clock::now() - began).count());
      std::sort(slow.rbegin(), slow.rend());
      for (std::size_t i = 0; i < std::min(arguments.slow, slow.size()); ++i)
        std::printf("  %7.2f s  %s\n", slow[i].first, slow[i].second.c_str());
      std::fflush(stdout);
    }
  }
  use_lane_target("");
  if (arguments.renew) {
    std::ofstream(arguments.file, std::ios::binary) << to_text(found, kHeader);
    std::printf("%s: %zu points\n", arguments.file.c_str(), points.size());
    return 0;
  }
  // Points of packaged meshes are among the lines of a study, so only a whole grid can tell.
  if (arguments.first == 0 && arguments.meshes == "both")
    report(left_over(table, found, arguments), "the file");
  std::printf("%zu of %zu counts differ from %s\n", different, lines, arguments.file.c_str());
  return different > 0 ? 1 : 0;
}

}  // namespace
}  // namespace farcull::native_counts

int main(int argc, char** argv) {
  try {
    using namespace farcull::native_counts;
    return run(arguments_of(std::vector<std::string>(argv + 1, argv + argc)));
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 2;
  }
}
