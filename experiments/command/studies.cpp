// The subcommands of `farcull experiment`, and `farcull merge`. Reads their options, and prints the
// progress of a run.
#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "core/view/view.h"
#include "experiments/command/command.h"
#include "experiments/studies/run_studies.h"
#include "experiments/studies/store.h"
#include "experiments/studies/study.h"
#include "experiments/suite/writer.h"
#include "experiments/system/output_file.h"
#include "experiments/system/text_table.h"
#include "experiments/tiles/run_tile.h"

namespace farcull {
namespace {

std::string duration(double seconds) {
  const auto whole = static_cast<long>(seconds + 0.5);
  if (whole >= 3600) return fmt::format("{} h {} min", whole / 3600, whole / 60 % 60);
  if (whole >= 60) return fmt::format("{} min {} s", whole / 60, whole % 60);
  return fmt::format("{} s", whole);
}

std::string left_text(const StudiesProgress& p) {
  return p.remaining_s ? ", " + duration(*p.remaining_s) + " left" : "";
}

std::string bar_of(const StudiesProgress& p) {
  constexpr std::size_t kWidth = 20;
  const std::size_t full = p.points > 0 ? kWidth * p.done / p.points : kWidth;
  return fmt::format("[{}{}] {}/{}{}  {}: {}{}", std::string(full, '#'),
                     std::string(kWidth - full, '.'), p.done, p.points, left_text(p), p.study,
                     p.point, p.stage.empty() ? "" : ": " + p.stage);
}

constexpr std::uint64_t kMostSeed = 1'000'000'000'000;

class StudiesCommand {
 public:
  // Declares a command for each study, and the command `all`. Each command calls run() of this
  // object.
  std::vector<Command> add_to(CLI::App& experiment) {
    std::vector<Command> out;
    const auto declare = [&](const std::string& name, const std::string& title,
                             const std::vector<Study>& chosen) {
      Rows rows = {
          {"--out", &out_, "DIR",
           fmt::format("folder of the results, one SQLite file; default\n{}", kResultsFolder)},
          {"--quick", &quick_, "", "a smaller grid of the same shape: minutes, not hours"},
          {"--seed", &seed_, "N", "of what is random in the grid; default 1"},
          {"--resume", &resume_, "", "go on with what is in the folder"},
          {"--no-times", &no_times_, "",
           "counts alone: run timed points once and keep no time, as\nfor shards side by side "
           "on one machine"},
          {"--shard", &shard_, "K/N", "measure the Kth of N parts"},
          {"--device", &device_, "DEVICE", kDeviceHelp},
          {"--devices", &devices_, "LIST|all",
           "measure on each of these devices, as in\nnative,software, or on all that answer; "
           "the first one\ninto DIR, what may differ on the others into DIR/on-DEVICE"}};
      if (name == "libraries") {
        rows = rows + Rows{{"--suite", &suite_, "DIR",
                            "ask about this suite, which may be without labels,\n"
                            "instead of the one that farcull suite makes"},
                           {"--contestants", &contestants_, "NAMES",
                            "ask these alone, as in far,boxes,exact; default all.\n"
                            "Methods of farcull run on native unless --device is given"}};
      }
      CLI::App* const command =
          add_command(experiment, name, title, rows,
                      fmt::format("Examples:\n"
                                  "  farcull experiment {0} --quick\n"
                                  "  farcull experiment {0} --out results --resume\n"
                                  "  farcull experiment {0} --out results --shard 2/4\n\n"
                                  "Then: farcull report DIR; for shards farcull merge DIR first.\n"
                                  "Exit status 1: a method that promises missed a pair.",
                                  name));
      out.push_back({command, [this, name, chosen] { return run(name, chosen); }});
    };
    for (const Study& study : studies()) declare(study.name, study.title, {study});
    declare("all",
            "all of these studies but cloth, libraries, model\nand proximity, one after the other",
            studies_of_all());
    return out;
  }

 private:
  // Returns the exit status: 1 a method with a guarantee missed a pair; 2 a point of a study could
  // not be measured; 0 otherwise.
  int run(const std::string& name, const std::vector<Study>& chosen) const {
    StudiesRequest request;
    request.studies = chosen;
    if (out_.empty()) throw Error("--out", "the folder is empty", "name one");
    if (seed_ < 1 || seed_ > kMostSeed) {
      throw Error("--seed", fmt::format("{} is out of range", seed_),
                  fmt::format("give 1 to {}", kMostSeed));
    }
    request.folder = out_;
    // The study "libraries" makes its suite in this folder.
    ::setenv("FARCULL_MADE_SUITE", (out_ + "/suite").c_str(), 1);
    if (suite_) (void)read_suite(*suite_);
    request.choice = {.quick = quick_, .seed = seed_, .suite = suite_.value_or("")};
    if (contestants_) {
      request.choice.contestants = split_list(*contestants_);
      for (const std::string& contestant : request.choice.contestants)
        require_contestant(contestant);
    }
    request.resume = resume_;
    request.times = !no_times_;
    if (shard_) request.shard = parse_shard(*shard_);
    int status = 0;
    bool first = true;
    for (const std::string& device : devices()) {
      StudiesRequest of = request;
      of.device = device;
      if (!std::exchange(first, false)) {
        of.folder = device_folder(out_, device);
        for (Study& study : of.studies) study = on_devices(study);
        std::erase_if(of.studies,
                      [&](const Study& study) { return study.grid(of.choice).empty(); });
      }
      if (devices_) print("on " + device + "\n");
      const int one = run_on(std::move(of), name);
      status = status == 1 || one == 1 ? 1 : std::max(status, one);
    }
    return status;
  }
  std::vector<std::string> devices() const {
    if (!devices_) return {device_of(device_)};
    if (device_)
      throw Error("--devices", "says what --device says as well", "leave one of the two out");
    if (*devices_ != "all") {
      std::vector<std::string> out = split_list(*devices_);
      for (const std::string& device : out) (void)device_folder(out_, device);
      return out;
    }
    std::vector<std::string> out;
    for (const char* device : {"native", "hardware", "software"}) {
      try {
        (void)provenance_now(device, "");
        out.emplace_back(device);
      } catch (const Error& error) {
        print(fmt::format("{} is left out: {}\n", device, error.what()));
      }
    }
    return out;
  }
  int run_on(StudiesRequest request, const std::string& name) const {
    const Shard& shard = request.shard;
    const std::string options = nlohmann::ordered_json{
        {"experiment", name},
        {"quick", quick_},
        {"seed", seed_},
        {"no_times", no_times_},
        {"shard", fmt::format("{}/{}", shard.index, shard.of)},
        {"suite", suite_.value_or("")},
        {"contestants", contestants_.value_or("")},
        {"device",
         request.device}}.dump(-1, ' ', false, nlohmann::ordered_json::error_handler_t::replace);
    // Throws Error if the device does not exist, before any file is created.
    request.provenance = provenance_now(request.device, options);

    TerminalProgress terminal;
    const Progress line = terminal.callback();
    std::string shown;
    std::chrono::steady_clock::time_point last;
    const StudiesSummary summary = run_studies(request, [&](const StudiesProgress& p) {
      if (line) return line(bar_of(p));
      // Without a terminal, prints a line when a study begins, then at most one line in 30 seconds.
      const auto now = std::chrono::steady_clock::now();
      if (p.study == shown && now - last < std::chrono::seconds(30)) return;
      shown = p.study;
      last = now;
      try {
        print(fmt::format("{}: {} of {}{}\n", p.study, p.done, counted(p.points, "point", "points"),
                          left_text(p)));
      } catch (const Error&) {
        // The measurement continues even if progress cannot be printed.
      }
    });
    terminal.clear();
    print(summary_table(summary));
    std::size_t void_rounds = 0;
    for (const StudySummary& study : summary.studies) void_rounds += study.void_rounds;
    if (void_rounds > 0) {
      complain(
          fmt::format("{} of timed points {} void: other programs took more than {:.0f} % of the "
                      "processors; --resume measures them again",
                      counted(void_rounds, "round", "rounds"), void_rounds == 1 ? "is" : "are",
                      100 * kMostLoad));
    }
    for (const std::string& point : summary.failed) complain(point);
    if (!summary.failed.empty()) {
      complain(counted(summary.failed.size(), "point", "points") +
               " could not be measured; --resume tries again");
    }
    for (const std::string& point : summary.broken)
      complain_broken("a promise is broken: " + point);
    if (!summary.broken.empty()) return 1;
    return summary.failed.empty() ? 0 : 2;
  }

  std::string out_ = kResultsFolder;
  bool quick_ = false, resume_ = false, no_times_ = false;
  std::uint64_t seed_ = 1;
  Text shard_, device_, devices_, suite_, contestants_;
};

class MergeCommand {
 public:
  CLI::App* add_to(CLI::App& app) {
    return add_command(
        app, "merge", "join what shards of an experiment, or tiles of a scene, gave",
        {{"SHARDS", &sources_, "",
          fmt::format("the folder of the shards, or their files; default\n{}. Or the records "
                      "(--json) of\nall tiles of a scene, with their lists beside them",
                      kResultsFolder)},
         {"-o,--out", &out_, "FILE",
          "the file to write; default results.sqlite, or of tiles\npairs.csv, in the folder of "
          "the first file"}},
        "Examples:\n"
        "  farcull merge results\n"
        "  farcull merge node1/results-1-of-2.sqlite node2/results-2-of-2.sqlite -o "
        "results.sqlite\n"
        "  farcull merge tile-*.json -o pairs.csv\n\n"
        "Refuses shards that are there twice, points without a row, and shards of different\n"
        "commits, grids, seeds or versions of a library. Of tiles: refuses a tile that is\n"
        "missing or there twice, other scenes, cuts, options or commits, and a list that was\n"
        "cut short or changed. Exit status 1: an accounting of a tile found a missed pair.");
  }
  int run() {
    if (std::ranges::any_of(sources_, is_tile_record)) return run_tiles();
    std::vector<std::string> files = sources_;
    if (files.empty()) files = {kResultsFolder};
    std::string folder = std::filesystem::path(files.front()).parent_path().string();
    if (files.size() == 1 && std::filesystem::is_directory(files.front())) {
      folder = files.front();
      files = shard_files(folder);
    }
    const std::string out = out_ ? *out_ : store_path(folder.empty() ? "." : folder);
    const MergeSummary summary = merge_stores(files, out);
    print(fmt::format("{} of {} from {}: {}\n", counted(summary.rows, "row", "rows"),
                      counted(summary.studies, "study", "studies"),
                      counted(summary.files, "shard", "shards"), out));
    if (summary.machines > 1) {
      print(
          fmt::format("note: the shards are of {} machines that differ: their counts "
                      "need not be those of one\n",
                      summary.machines));
    }
    return 0;
  }

 private:
  int run_tiles() const {
    for (const std::string& file : sources_) {
      if (!is_tile_record(file))
        throw Error(file, "is no record of a tile, as the others are", "merge shards on their own");
    }
    const std::string folder = std::filesystem::path(sources_.front()).parent_path().string();
    const std::string out = out_ ? *out_ : (folder.empty() ? "." : folder) + "/pairs.csv";
    std::vector<NamedFile> inputs;
    for (const std::string& file : sources_) inputs.push_back({"SHARDS", file});
    require_apart(inputs, {{"-o", out}});
    const MergedTiles merged = merge_tiles(sources_, out);
    print(fmt::format("{} of {}: {}\n", counted(merged.rows, "pair", "pairs"),
                      counted(merged.tiles, "tile", "tiles"), out));
    if (!merged.verified) print("not verified: a tile was run with --no-verify\n");
    if (!merged.guaranteed) {
      print(
          "no promise: a tile was run on a device that may miss pairs; its record has the "
          "reason\n");
    }
    if (merged.false_negatives == 0) return kExitDone;
    complain_broken(fmt::format("culled pairs that collide: {}", grouped(merged.false_negatives)));
    return kExitBroken;
  }

  std::vector<std::string> sources_;
  Text out_;
};

class ExperimentCommand {
 public:
  CLI::App* add_to(CLI::App& app) {
    CLI::App* command = add_command(
        app, "experiment", "studies for publication, and their premises", {},
        "Examples:\n  farcull experiment all --quick\n  farcull experiment accuracy --out results\n"
        "  farcull experiment lemma --points 1000000");
    allow_one_command(*command);
    commands_ = studies_.add_to(*command);
    commands_.push_back(add_lemma(*command));
    return command;
  }
  int run() const {
    for (const Command& command : commands_) {
      if (given(*command.app)) return command.run();
    }
    std::string known = "all";
    for (const Study& study : studies()) known += ", " + study.name;
    throw Error("experiment", "no study is named", "name one: " + known + ", lemma");
  }

 private:
  StudiesCommand studies_;
  std::vector<Command> commands_;
};

}  // namespace

Command add_merge(CLI::App& app) { return declare<MergeCommand>(app); }

Command add_experiment(CLI::App& app) { return declare<ExperimentCommand>(app); }

}  // namespace farcull
