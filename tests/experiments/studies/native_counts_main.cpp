// Measures the studies' quick grids on the native canvas, and compares the hashes of their counts
// with the file of the repository, makes that file anew, or prints the counts themselves.
//   farcull_native_counts check|renew|rows FILE [OPTION VALUE]..
//     --study NAME       that study alone
//     --part PART        first, eight, all or meshes (native_counts.h); default: all, then meshes
//     --lanes NAME|all   an instruction set of the CPU, or each that it has; default the best
//     --threads LIST     numbers of threads, by commas; 0: as many as there are cores; default 0
// Exit status: 0; 1 counts differ; 2 they could not be measured.
#include "core/base/text.h"
#include "tests/experiments/studies/native_counts.h"

namespace farcull::native_counts {
namespace {

constexpr const char* kHeader =
    "# Hashes of the counts of the studies' quick grids (seed 1) on the native canvas: a function "
    "of the\n"
    "# commit, the same on every machine. docs/experiments.md, \"The same counts on every "
    "machine\".\n"
    "# Made by `farcull_native_counts renew`; compared by `farcull_native_counts check`, and by\n"
    "# `ctest -R native-counts`. The format: tests/experiments/studies/native_counts.h.\n";

struct Arguments {
  std::string what, file, study = {};
  std::vector<Part> parts = {without_meshes, on_meshes};
  std::vector<std::string> lanes = {""};
  std::vector<unsigned> threads = {0};
};

[[noreturn]] void refuse(const std::string& word) {
  throw Error("farcull_native_counts", "'" + word + "' is none of its arguments",
              "see the top of tests/experiments/studies/native_counts_main.cpp");
}

Arguments arguments_of(const std::vector<std::string>& words) {
  if (words.size() < 2 || words.size() % 2 != 0) refuse(words.empty() ? "" : words.back());
  Arguments out{.what = words[0], .file = words[1]};
  if (out.what != "check" && out.what != "renew" && out.what != "rows") refuse(out.what);
  for (std::size_t i = 2; i < words.size(); i += 2) {
    const std::string &option = words[i], &value = words[i + 1];
    if (out.what == "renew") refuse(option);  // the file is made of all points, once
    const auto part = std::ranges::find(kParts, value);
    if (option == "--study") {
      out.study = study_named(value).name;
    } else if (option == "--part" && part != kParts.end()) {
      out.parts = {static_cast<Part>(part - kParts.begin())};
    } else if (option == "--lanes") {
      out.lanes = value == "all" ? lane_targets() : std::vector{value};
    } else if (option == "--threads") {
      out.threads.clear();
      std::istringstream in(value);
      for (std::string item; std::getline(in, item, ',');) {
        const std::optional<unsigned> number = parse_number<unsigned>(item);
        if (!number) refuse(option + " " + value);
        out.threads.push_back(*number);
      }
    } else {
      refuse(option + " " + value);
    }
  }
  return out;
}

// Measures the points of these parts. print: shows each row.
Table measure(const Arguments& arguments, const std::vector<Part>& parts, unsigned threads,
              bool print) {
  Table out;
  MeasurementContext lab("native", {}, threads);
  for (const Study& study : studies()) {
    if (!arguments.study.empty() && study.name != arguments.study) continue;
    for (const StudyGridPoint& point : quick_points(study)) {
      if (std::ranges::none_of(parts, [&](const Part part) { return point.is_in[part]; })) continue;
      const std::string row = measured_row(study, point.point, point.key, lab);
      add(out, point, row);
      if (print) std::printf("%s\n", row.c_str());
    }
  }
  return out;
}

int check(const Arguments& arguments) {
  const Lines file = read(arguments.file);
  std::size_t different = 0;
  for (const std::string& lanes : arguments.lanes) {
    use_lane_target(lanes);
    for (const unsigned threads : arguments.threads) {
      for (const Part part : arguments.parts) {
        const Table found = measure(arguments, {part}, threads, false);
        std::printf("%s, %u threads, %s: %zu methods of studies\n", lane_target().c_str(), threads,
                    kParts[part], found.size());
        std::fflush(stdout);
        for (const std::string& name : differences(file, found, part)) {
          ++different;
          const std::string study = name.substr(0, name.find(';'));
          std::printf(
              "%s: other counts than in %s. The rows: farcull_native_counts rows FILE "
              "--study %s --part %s >rows.txt, here and at a commit that agrees; diff shows which "
              "differ\n",
              name.c_str(), arguments.file.c_str(), study.c_str(), kParts[part]);
        }
      }
    }
  }
  use_lane_target("");
  return different > 0 ? 1 : 0;
}

int run(const Arguments& arguments) {
  if (arguments.what == "check") return check(arguments);
  const Table found =
      measure(arguments, arguments.parts, arguments.threads[0], arguments.what == "rows");
  if (arguments.what == "renew")
    std::ofstream(arguments.file, std::ios::binary) << kHeader << to_text(lines_of(found));
  return 0;
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
