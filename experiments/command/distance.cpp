// Reads the options of `farcull distance`, then measures one scene or each frame of a motion.

#include <fmt/format.h>

#include <algorithm>
#include <cfloat>
#include <nlohmann/json.hpp>
#include <set>

#include "core/scene/scene.h"
#include "experiments/command/command.h"
#include "experiments/measure/frames.h"
#include "experiments/method/distances.h"
#include "experiments/record/output.h"
#include "experiments/scenes/mesh/load.h"
#include "experiments/system/output_file.h"
#include "verify/inside.h"

namespace farcull {
namespace {

using Json = nlohmann::ordered_json;

constexpr unsigned kMostThreads = 1024;
constexpr const char* kDistanceExamples =
    "Examples:\n"
    "  farcull distance far-apart\n"
    "  farcull distance a.obj b.obj --json - | jq '.pairs[0].distance'\n"
    "  farcull distance crowd --pairs nearest --k 3\n"
    "  farcull distance a.obj b.obj --pairs all --within 0.01 --csv near.csv\n"
    "  farcull distance cloth.obj --self --pairs all --within 0.001\n"
    "  farcull distance far-apart --verify\n"
    "  farcull distance 'cloth_%04d.obj' body.obj --frames 1:100 --csv frames.csv\n\n"
    "A distance is that of the surfaces; it is the root of an exact number, rounded once.\n"
    "The witness points are rounded too, coordinate by coordinate. 0: the objects meet.\n"
    "docs/proximity.md has the columns and the proof.\n\n"
    "Exit status 0: answered, also where objects meet. 1: --verify found a nearer pair than an\n"
    "answer, or a wrong answer. 2: the input or an option is wrong.";

// JSON keys of a record whose values differ between frames.
constexpr const char* kOfFrame[] = {"pairs",  "nearest",      "counts",
                                    "stages", "verification", "time_ms"};

std::string frame_row(long frame, const DistanceRecord& record) {
  const auto least = std::ranges::min_element(record.distances, {},
                                              [](const Distance& d) { return d.closest.distance; });
  std::string row = fmt::format("{:>8}  {:>10}  ", frame, record.distances.size());
  row += least == record.distances.end() ? fmt::format("{:>24}", "none")
                                         : fmt::format("{:>24}", least->closest.distance);
  row += fmt::format("  {:>9.1f}", record.ms);
  if (const auto& v = record.verification)
    row += fmt::format("  {:>6}  {:>6}", v->nearer, v->wrong + v->earlier);
  return row + "\n";
}

// Returns the objects whose surface is not closed. The record cannot say whether such an object
// contains another object.
std::vector<std::uint32_t> not_closed(const Scene& scene, const DistanceRecord& record) {
  std::set<std::uint32_t> found;
  for (const Distance& d : record.distances) {
    if (d.inside != WhichInside::not_closed) continue;
    for (const std::uint32_t o : {d.objects.a, d.objects.b}) {
      if (!is_closed(scene, o)) found.insert(o);
    }
  }
  return {found.begin(), found.end()};
}

class DistanceCommand {
 public:
  CLI::App* add_to(CLI::App& app) {
    return add_command(
        app, "distance", "how far objects are apart, and where they are nearest",
        scene_rows(scene_) +
            Rows{
                {"--pairs", &pairs_, "WHICH",
                 "objects: the nearest triangles of every two objects;\n"
                 "nearest: of each object and its K nearest others;\n"
                 "all: all pairs of triangles within D; default objects"},
                {"--k", &k_, "K", "with --pairs nearest: how many others; default 1"},
                {"--within", &within_, "D",
                 "nothing farther apart is answered, in world units;\n--pairs all needs it"},
                {"--self", &self_, "",
                 "the triangles of one object as well, those that share\n"
                 "a vertex position left out"},
                ignore_row(scene_.ignore),
                {"--inside", &inside_, "yes|no",
                 "whether an object lies inside another, by winding\nnumbers; default yes"},
                {"--threads", &threads_, "N", "of the CPU; default as many as there are cores"},
                {"--verify", &verify_, "",
                 "check each answer by other code, and of each pair that\nit is no nearer than the "
                 "answers"},
                {"--frames", &frames_, "N|A:B", "as for farcull run: of a scene that moves"},
                {"--json", &outputs_.json, "FILE", kJsonHelp},
                {"--csv", &outputs_.csv, "FILE",
                 "write the pairs as CSV to this file; - for standard\noutput, without the table"}},
        kDistanceExamples);
  }
  int run() const {
    const DistanceOptions options = parse();
    check_scene(scene_.names);
    std::optional<FrameRange> range;
    if (frames_) range = parse_frames(*frames_);
    const Outputs outputs = checked(outputs_, scene_files(scene_.names, range), range);
    return range ? run_frames(options, outputs, *range) : run_once(options, outputs);
  }

 private:
  DistanceOptions parse() const {
    DistanceOptions out;
    out.pairs = static_cast<DistancePairs>(word_of("--pairs", pairs_, {"objects", "nearest", "all"},
                                                   "no choice", "give objects, nearest or all"));
    if (k_) {
      if (out.pairs != DistancePairs::nearest)
        throw Error("--k", "has no meaning without --pairs nearest", "add that, or leave --k out");
      out.k = number_of<std::uint32_t>("--k", *k_, "no number of objects", 1, UINT32_MAX,
                                       "give 1 or more");
    }
    if (within_) {
      out.within = number_of<double>("--within", *within_, "no distance", 0, DBL_MAX,
                                     "give a finite distance in world units, 0 or more");
    }
    if (out.pairs == DistancePairs::all && !within_)
      throw Error("--within", "is missing, which --pairs all needs",
                  "give a distance in world units, as in --within 0.01");
    if (self_ && out.pairs == DistancePairs::nearest)
      throw Error("--self", "has no meaning with --pairs nearest: no object is its own neighbour",
                  "leave it out, or use --pairs objects or all");
    out.inside = word_of("--inside", inside_, {"yes", "no"}, "no choice", "give yes or no") == 0;
    if (inside_ && out.inside && out.pairs == DistancePairs::all)
      throw Error("--inside", *inside_ + " has no meaning with --pairs all",
                  "leave it out, or use --pairs objects or nearest");
    if (threads_) {
      out.threads = number_of<unsigned>("--threads", *threads_, "no number of threads", 1,
                                        kMostThreads, fmt::format("give 1 to {}", kMostThreads));
    }
    out.verify = verify_;
    return out;
  }
  void require_question(const Scene& scene, const DistanceOptions& options) const {
    require_asked(scene, {});
    const std::string reason = nothing_asked(scene, options);
    if (reason.empty()) return;
    std::string remedy = "name two objects or more";
    if (options.pairs != DistancePairs::nearest && scene.triangles.size() > 1) {
      remedy +=
          ", or ask for the distances inside one: " + command_with("farcull distance", scene_);
      if (pairs_) remedy += " --pairs " + *pairs_;
      if (within_) remedy += " --within " + *within_;
      remedy += " --self";
    }
    throw Error("SCENE", reason, remedy);
  }
  int run_once(const DistanceOptions& options, const Outputs& outputs) const {
    TerminalProgress terminal;
    const Progress progress = terminal.callback("reading the scene");
    const Scene scene = read_scene(scene_, self_);
    require_question(scene, options);
    const DistanceRecord record = distances(scene, options, progress);
    terminal.clear();
    if (outputs.csv) write_output(*outputs.csv, distances_header() + distances_rows(scene, record));
    if (outputs.json)
      write_json(distances_json(scene, record, seed_of(scene_.names)), *outputs.json);
    if (!outputs.to_stdout())
      print(distances_table(scene, record) + weld_lines(scene, not_closed(scene, record)));
    if (!record.verification || record.verification->holds()) return kExitDone;
    complain_broken(verdict_text(*record.verification));
    return kExitBroken;
  }
  int run_frames(const DistanceOptions& options, const Outputs& outputs, FrameRange range) const {
    TerminalProgress terminal;
    const Progress progress = terminal.callback("reading the scene");
    FrameSource source(scene_, range, self_);
    if (const std::optional<Error> missing = source.missing()) {
      terminal.clear();
      complain(missing->where + ": the file does not exist; the frames before it are run");
    }
    std::optional<FrameRecord> json;
    std::optional<GrowingOutput> csv;
    if (outputs.json) json.emplace(*outputs.json);
    if (outputs.csv) csv.emplace(*outputs.csv);
    const bool table = !outputs.to_stdout(), verified = options.verify;
    std::vector<double> ms;
    DistanceAccounting sum;
    DistanceMemory memory;
    for_each_frame(range, "what they gave is written", progress, "",
                   [&](long frame, const Progress&) {
                     const Scene& scene = source.at(frame);
                     require_question(scene, options);
                     const DistanceRecord record = distances(scene, options, progress, &memory);
                     terminal.clear();
                     say_notes();
                     const bool first = ms.empty();
                     ms.push_back(record.ms);
                     if (record.verification) add_fields(*record.verification, sum);
                     if (json) {
                       Json head = distances_json(scene, record, seed_of(scene_.names));
                       Json one = {{"frame", frame},
                                   {"hash", head["scene"]["hash"]},
                                   {"triangles", scene.triangles.size()},
                                   {"topology_changed", source.topology_changed()}};
                       for (const char* key : kOfFrame) {
                         one[key] = head[key];
                         head.erase(key);
                       }
                       json->add(head, one,
                                 {{"frames", ms.size()},
                                  {"wanted", range.count()},
                                  {"ms", json_of(summary_of(ms))},
                                  {"missed", json_if(verified, sum.nearer)},
                                  {"wrong", json_if(verified, sum.wrong + sum.earlier)}});
                     }
                     if (csv) {
                       csv->add((first ? "frame," + distances_header() : "") +
                                    distances_rows(scene, record, std::to_string(frame) + ","),
                                "");
                     }
                     if (!table) return;
                     const std::string names =
                         fmt::format("{:>8}  {:>10}  {:>24}  {:>9}{}\n", "frame", "pairs",
                                     "least distance", "ms", verified ? "  missed   wrong" : "");
                     print((first ? names : "") + frame_row(frame, record));
                   });
    if (json) json->finish();
    if (csv) csv->finish();
    if (table) {
      const FrameTimes times = summary_of(ms);
      std::string end =
          fmt::format("\nper frame  median {:.1f} ms, 95% within {:.1f} ms, at most {:.1f} ms\n",
                      times.median, times.p95, times.max);
      if (verified) end += verdict_text(sum) + "\n" + accounting_sum(sum);
      print(end);
    }
    if (sum.holds()) return kExitDone;
    complain_broken(verdict_text(sum));
    return kExitBroken;
  }

  SceneArguments scene_;
  Text pairs_, k_, within_, inside_, threads_, frames_;
  bool self_ = false, verify_ = false;
  Outputs outputs_;
};

}  // namespace

Command add_distance(CLI::App& app) { return declare<DistanceCommand>(app); }

}  // namespace farcull
