// Implements the command `farcull bench`: defines its options, and runs the measurement.
#include <limits>
#include <nlohmann/json.hpp>

#include "core/scene/scene.h"
#include "experiments/command/command.h"
#include "experiments/measure/bench.h"
#include "experiments/record/output.h"
#include "experiments/scenes/builtin/scenes.h"
#include "experiments/system/machine.h"
#include "experiments/system/output_file.h"

namespace farcull {
namespace {

std::string peers_text() {
  std::string with = "Peers here:";
  std::string without;
  std::size_t column = with.size();
  for (const Peer& peer : all_peers()) {
    if (!peer.missing.empty()) {
      without += "Left out: " + peer.name + ": " + peer.missing + ".\n";
      continue;
    }
    const bool wraps = column + peer.name.size() > 90;
    column = wraps ? 2 + peer.name.size() : column + 1 + peer.name.size();
    with += (wraps ? "\n  " : " ") + peer.name;
  }
  return with + "\n" + without;
}

class BenchCommand {
 public:
  CLI::App* add_to(CLI::App& app) {
    return add_command(
        app, "bench", "times beside other libraries, from triangles to pairs",
        scene_rows(scene_) +
            Rows{
                {"--self", &self_, "",
                 "every object is tested against itself as well, but\n"
                 "for triangles that share a vertex position"},
                ignore_row(scene_.ignore),
                {"--peers", &peers_, "LIST", "all, none, or names by commas; default all"},
                {"--methods", &methods_, "LIST", "of boxes,far,exact; all or none; default all"},
                {"--threads", &threads_, "N", "cores for each of them; default all there are"},
                {"--repeat", &repeat_, "N", "runs of each after a cold one; default 5"},
                {"--limit", &limit_, "SECONDS",
                 "who takes longer in the cold run is not repeated;\ndefault 60"},
                {"--device", &device_, "DEVICE",
                 "for methods on GL, as for farcull run, or cpu for\n"
                 "none of them; default where there is one"},
                {"--distances", &distances_, "PAIRS",
                 "times of distance queries instead: objects, every two\nobjects; or nearest, "
                 "each with the nearest other one.\nPeers are then fcl-double,fcl-float,cgal-aabb"},
                {"--within", &within_, "DISTANCE",
                 "with --distances: farther ones need not be found;\nin world units, default all"},
                {"--poses", &poses_, "",
                 "times of frames instead in which the first object turns\nas a whole: new calls, "
                 "and what keeps trees; the peer\nis fcl-double"},
                {"--json", &outputs_.json, "FILE", kJsonHelp}},
        [] {
          return "Examples:\n"
                 "  farcull bench two-bunnies\n"
                 "  farcull bench needles-layers --threads 1 --peers fcl-obb,embree-low\n"
                 "  farcull bench field:1000000 --peers none --methods boxes --json field.json\n"
                 "  farcull bench bunnies-far-apart --distances objects\n"
                 "  farcull bench two-bunnies --poses --threads 1 --repeat 30\n\n" +
                 peers_text() +
                 "farcull help terms explains the columns; docs/bench.md says what is\n"
                 "measured. Exit status 1: two of them disagree about a pair.";
        });
  }
  int run() {
    const BenchOptions options = parse();
    if (within_ && !distances_)
      throw Error("--within", "is a limit of distances",
                  "add --distances objects, or leave it out");
    if (poses_ && distances_)
      throw Error("--poses", "is another question than --distances", "give one of them");
    check_scene(scene_.names);
    const Outputs outputs = checked(outputs_, scene_files(scene_.names));
    confine_to_cores(options.threads);
    TerminalProgress terminal;
    const Progress progress = terminal.callback("reading the scene");
    Scene scene = read_scene(scene_);
    require_asked(scene, {});
    if (options.self) make_self(scene);
    const auto refuse_given_with = [&](const std::string& subject) {
      refuse_given({{"--self", self_},
                    {"--methods", methods_.has_value()},
                    {"--device", device_.has_value()}},
                   "says nothing about " + subject, "leave it or --" + subject + " out");
    };
    if (distances_) {
      require_nothing_ignored(scene, "farcull bench --distances");
      DistanceBenchOptions of_distances{.peers = options.peers,
                                        .threads = options.threads,
                                        .repeat = options.repeat,
                                        .limit_s = options.limit_s};
      of_distances.question.task = static_cast<DistanceTask>(word_of(
          "--distances", distances_, {"objects", "nearest"}, "none", "give objects or nearest"));
      if (within_) {
        of_distances.question.within =
            number_of<double>("--within", *within_, "none", 0, std::numeric_limits<double>::max(),
                              "give a distance in world units, 0 or more");
      }
      refuse_given_with("distances");
      const DistanceBenchResult result = bench_distances(scene, of_distances, progress);
      terminal.clear();
      if (outputs.json) write_json(to_json(scene, of_distances, result), *outputs.json);
      if (!outputs.to_stdout()) print(distance_bench_table(scene, of_distances, result));
      return 0;
    }
    if (poses_) {
      require_nothing_ignored(scene, "farcull bench --poses");
      const PoseBenchOptions of_poses{.peers = options.peers,
                                      .threads = options.threads,
                                      .repeat = options.repeat,
                                      .limit_s = options.limit_s};
      refuse_given_with("poses");
      const PoseBenchResult result = bench_poses(scene, of_poses, progress);
      terminal.clear();
      if (outputs.json) write_json(to_json(scene, of_poses, result), *outputs.json);
      if (!outputs.to_stdout()) print(pose_bench_table(scene, of_poses, result));
      const std::string disagreement = disagreement_of(result);
      if (!disagreement.empty()) complain(disagreement);
      return disagreement.empty() ? 0 : 1;
    }
    const BenchResult result =
        bench(scene, contestants(scene, options, progress), options, progress);
    terminal.clear();
    if (outputs.json) write_json(to_json(scene, options, result), *outputs.json);
    if (!outputs.to_stdout()) print(bench_table(scene, options, result));
    if (!result.disagreement) return 0;
    complain(describe(scene, *result.disagreement));
    return 1;
  }

 private:
  BenchOptions parse() const {
    BenchOptions options;
    options.peers = peers_.value_or(options.peers);
    options.methods = methods_.value_or(options.methods);
    options.threads = usable_cores();
    if (threads_)
      options.threads =
          number_of<unsigned>("--threads", *threads_, "none", 1, 1 << 16, "give a number from 1");
    if (repeat_)
      options.repeat = number_of<int>("--repeat", *repeat_, "none", 1, 1'000'000, "give 1 or more");
    if (limit_)
      options.limit_s =
          number_of<double>("--limit", *limit_, "none", 0, 1e9, "give seconds, 0 to 1e9");
    options.device = device_of(device_);
    options.self = self_;
    options.seed = seed_of(scene_.names);
    if (!distances_ && !poses_) validate(options);
    if (!is_cpu(options.device)) {
      RunOptions run;
      run.device = options.device;
      validate(run);
    }
    return options;
  }

  SceneArguments scene_;
  bool self_ = false, poses_ = false;
  Text peers_, methods_, threads_, repeat_, limit_, device_, distances_, within_;
  Outputs outputs_;
};

}  // namespace

Command add_bench(CLI::App& app) { return declare<BenchCommand>(app); }

}  // namespace farcull
