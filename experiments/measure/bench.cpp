// Sets up the contestants: methods, which run as in `farcull run`, and peers, which run the code of
// other libraries. Runs a cold round, then the rounds that count. Compares every contestant's pairs
// with the pairs of the first contestant. Makes the table and JSON.
#include "experiments/measure/bench.h"

#include <fmt/format.h>

#include <memory>
#include <nlohmann/json.hpp>

#include "commit.h"
#include "core/base/error.h"
#include "experiments/record/output.h"
#include "experiments/record/tables.h"
#include "experiments/system/machine.h"
#include "experiments/system/text_table.h"
#include "offsets/offsets.h"
#include "verify/exact.h"

namespace farcull {
namespace {

using Json = nlohmann::ordered_json;

const std::vector<std::string> kMethods = {"boxes", "far", "exact"};

BenchRun method_run(Method method, std::shared_ptr<Session> session, const std::string& device) {
  RunOptions options{.method = method, .verify = false, .neighbours = false};
  if (draws(method)) options.device = device;
  return [=](const Scene& scene) {
    const Stopwatch watch;
    Record record = run(scene, options, *session, {}, {.answer_only = true});
    double build_ms = 0;  // time of making boxes, before the search for candidates
    for (const Stage& stage : record.trace) {
      if (stage.kind == StageKind::boxes) build_ms += stage.ms;
    }
    return BenchAnswer{.build_ms = build_ms,
                       .candidates_ms = watch.ms() - record.ms.exact - build_ms,
                       .exact_ms = record.ms.exact,
                       .candidate_pairs = record.found.count,
                       .pairs = std::move(record.collisions.pairs)};
  };
}

/// Sets up contestants. If a contestant cannot run, leaves it out, or throws Error if the user
/// named it.
class ContestantList {
 public:
  explicit ContestantList(const Progress& progress) : progress_(progress) {}

  template <class SetUp>
  void add(BenchContestant contestant, bool by_name, const char* option, const SetUp& set_up) {
    if (progress_) progress_("setting up " + contestant.name);
    if (contestant.left_out.empty()) {
      const Stopwatch watch;
      try {
        set_up(contestant);
      } catch (const Error& error) {
        if (by_name) throw;
        contestant.left_out = error.where + ": " + error.reason;
      }
      contestant.setup_ms = watch.ms();
    } else if (by_name) {
      throw Error(option, contestant.name + ": " + contestant.left_out, "leave it out");
    }
    all.push_back(std::move(contestant));
  }

  std::vector<BenchContestant> all;

 private:
  const Progress& progress_;
};

void add_methods(const Scene& scene, const BenchOptions& options, ContestantList& list) {
  const bool by_name = options.methods != "all";
  const bool no_gl = is_cpu(options.device);
  // Without --device, methods that draw are measured on GL only if GL has a hardware device.
  const bool gl_by_name = by_name && !options.device.empty();
  const std::string gl_device = options.device.empty() ? "gl" : options.device;
  std::shared_ptr<Session> gl;  // shared by all methods on GL
  const auto on_gl = [&](BenchContestant& c, Method method) {
    if (!gl) gl = std::make_shared<Session>(gl_device, options.threads);
    c.device = gl->context().info().renderer;
    c.run = method_run(method, gl, gl_device);
  };
  for (const std::string& name : chosen_names("--methods", options.methods, kMethods)) {
    const Method method = parse_method(name);
    const std::string refused =
        has_self(scene) && !tests_self(method) ? "it tests no object against itself" : "";
    list.add({.name = name, .left_out = refused}, by_name, "--methods", [&](BenchContestant& c) {
      c.run = method_run(method, std::make_shared<Session>("native", options.threads), "native");
    });
    const bool slow = options.device.empty() && !GlContext::hardware_listed();
    if (!draws(method) || no_gl || slow) continue;
    list.add({.name = name, .device = "gl", .left_out = refused}, gl_by_name, "--methods",
             [&](BenchContestant& c) {
               on_gl(c, method);
               gl->canvas(obb_fattener(), {});
             });
  }
}

void add_peers(const Scene& scene, const BenchOptions& options, ContestantList& list) {
  const bool by_name = options.peers != "all";
  for (const Peer& peer : chosen_peers(options.peers, all_peers())) {
    const BenchContestant contestant{.name = peer.name,
                                     .peer = true,
                                     .library = peer.library,
                                     .left_out = why_left_out(peer, scene)};
    list.add(contestant, by_name, "--peers",
             [&](BenchContestant& c) { c.run = peer.set_up(options.threads); });
  }
}

// Times in ms of the parts of a contestant's runs, one value per run.
struct Parts {
  std::vector<double> build, candidates, exact;
};

// Returns the first pair that is in only one of two sorted lists.
std::optional<Disagreement> compare(const Scene& scene, const std::string& first_name,
                                    const std::vector<TrianglePair>& first,
                                    const std::string& second_name,
                                    const std::vector<TrianglePair>& second) {
  const auto [a, b] = std::mismatch(first.begin(), first.end(), second.begin(), second.end());
  if (a == first.end() && b == second.end()) return std::nullopt;
  const bool first_has = b == second.end() || (a != first.end() && *a < *b);
  Disagreement out{.has = first_has ? first_name : second_name,
                   .lacks = first_has ? second_name : first_name,
                   .pair = first_has ? *a : *b};
  const auto count = scene.triangles.size();
  out.collides = out.pair.a < out.pair.b && out.pair.b < count &&
                 !decide(scene, std::array{out.pair}, {.neighbours = false}).pairs.empty();
  return out;
}

const BenchRow* row_of_boxes(const BenchResult& result) {
  const auto row = std::ranges::find(result.rows, "boxes", &BenchRow::name);
  return row == result.rows.end() ? nullptr : &*row;
}

Json row_json(const BenchResult& result, const BenchRow& row) {
  Json json = FARCULL_JSON(row, name, device, total_ms, setup_ms, build_ms, candidates_ms, exact_ms,
                           candidate_pairs, pairs, peak_mib, cold_ms, repeats, peer);
  json["library"] = json_if(row.peer, row.library);
  json["ratio_to_fastest_peer"] = json_of(ratio_to_fastest(result, row));
  if (row.peer) return json;
  Json& ratios = json["ratio_to_peers"] = Json::object();
  for (const BenchRow& peer : result.rows) {
    if (peer.peer) ratios[peer.name] = row.total_ms.median / peer.total_ms.median;
  }
  return json;
}

Json disagreement_json(const std::optional<Disagreement>& disagreement) {
  if (!disagreement) return nullptr;
  return {{"has", disagreement->has},
          {"lacks", disagreement->lacks},
          {"pair", {disagreement->pair.a, disagreement->pair.b}},
          {"collides", disagreement->collides}};
}

}  // namespace

std::vector<std::string> chosen_names(const std::string& option, const std::string& text,
                                      const std::vector<std::string>& known) {
  if (text == "all") return known;
  if (text == "none") return {};
  const std::vector<std::string> asked = split_list(text);
  for (const std::string& name : asked) {
    if (std::find(known.begin(), known.end(), name) != known.end()) continue;
    throw Error(option, "'" + name + "' is none of them",
                fmt::format("give all, none, or some of {}", fmt::join(known, ",")));
  }
  std::vector<std::string> out;
  for (const std::string& name : known) {
    if (std::find(asked.begin(), asked.end(), name) != asked.end()) out.push_back(name);
  }
  return out;
}

void validate(const BenchOptions& options) {
  chosen_names("--methods", options.methods, kMethods);
  chosen_peers(options.peers, all_peers());
  if (options.repeat < 1) {
    throw Error("--repeat", fmt::format("{} is no number of runs", options.repeat),
                "give 1 or more");
  }
  if (!(options.limit_s >= 0)) {
    throw Error("--limit", fmt::format("{} is no time", options.limit_s),
                "give seconds, 0 or more");
  }
  if (options.methods == "none" && options.peers == "none") {
    throw Error("--peers", "nobody is left to be measured", "name a peer or a method");
  }
}

std::vector<BenchContestant> contestants(const Scene& scene, const BenchOptions& options,
                                         const Progress& progress) {
  ContestantList list(progress);
  add_methods(scene, options, list);
  add_peers(scene, options, list);
  return std::move(list.all);
}

BenchResult bench(const Scene& scene, const std::vector<BenchContestant>& contestants,
                  const BenchOptions& options, const Progress& progress) {
  BenchResult result;
  std::vector<const BenchContestant*> running;
  for (const BenchContestant& c : contestants) {
    if (c.left_out.empty())
      running.push_back(&c);
    else
      result.left_out.push_back(c);
  }

  const Rounds rounds{
      .warm_up = 1, .counted = options.repeat, .limit_ms = 1000 * options.limit_s, .memory = true};
  std::vector<Parts> parts(running.size());
  std::vector<TrianglePair> agreed;  // the pairs of the first contestant
  const std::vector<Timed> timed =
      measure_in_turns(running.size(), rounds, [&](std::size_t i, int round) {
        const BenchContestant& c = *running[i];
        show_round(progress, c.name, round, options.repeat);
        const Stopwatch watch;
        BenchAnswer answer = c.run(scene);
        const double ms = watch.ms();
        // Peers do not know which pairs of objects are ignored.
        remove_ignored(scene, scene.ignored, answer.pairs);
        if (round < 0) {
          BenchRow& row = result.rows.emplace_back();
          static_cast<TimedRow&>(row) = {.name = c.name, .library = c.library, .peer = c.peer};
          row.device = c.device;
          row.setup_ms = c.setup_ms;
          row.candidate_pairs = answer.candidate_pairs;
          row.pairs = answer.pairs.size();
        }
        // A cold run counts only if it exceeds the limit: the contestant is then not run again.
        if (round >= 0 || ms > rounds.limit_ms) {
          parts[i].build.push_back(answer.build_ms);
          parts[i].candidates.push_back(answer.candidates_ms);
          parts[i].exact.push_back(answer.exact_ms);
        }
        if (i == 0 && round < 0) {
          agreed = std::move(answer.pairs);
        } else if (!result.disagreement) {
          result.disagreement = compare(scene, running[0]->name, agreed, c.name, answer.pairs);
        }
        return ms;
      });

  for (std::size_t i = 0; i < running.size(); ++i) {
    set_times(timed[i], rounds, i, true, result);
    result.rows[i].build_ms = middle(parts[i].build);
    result.rows[i].candidates_ms = middle(parts[i].candidates);
    result.rows[i].exact_ms = middle(parts[i].exact);
  }
  return result;
}

std::string describe(const Scene& scene, const Disagreement& disagreement) {
  const auto place = [&](std::uint32_t triangle) {
    for (const Object& object : scene.objects) {
      if (triangle - object.first_triangle < object.triangle_count)
        return fmt::format("{} triangle {}", object.name, triangle - object.first_triangle);
    }
    return fmt::format("triangle {}, which the scene lacks,", triangle);
  };
  return fmt::format(
      "{} has the pair {} and {}, which {} lacks; the exact predicates say that it {}",
      disagreement.has, place(disagreement.pair.a), place(disagreement.pair.b), disagreement.lacks,
      disagreement.collides ? "collides" : "is none that collides");
}

nlohmann::ordered_json to_json(const Scene& scene, const BenchOptions& options,
                               const BenchResult& result) {
  const BenchRow* best = row_of_boxes(result);
  const std::optional<double> ratio = best ? ratio_to_fastest(result, *best) : std::nullopt;
  return {
      {"scene", scene.name},
      {"threads", options.threads},
      {"rows", json_list(result.rows, [&](const BenchRow& row) { return row_json(result, row); })},
      {"fastest_peer",
       result.fastest_peer ? Json(result.rows[*result.fastest_peer].name) : Json(nullptr)},
      {"ratio_to_fastest_peer", json_of(ratio)},
      {"left_out",
       json_list(result.left_out,
                 [](const BenchContestant& c) {
                   return Json{{"name", c.name}, {"device", c.device}, {"reason", c.left_out}};
                 })},
      {"disagreement", disagreement_json(result.disagreement)},
      {"objects", scene.objects.size()},
      {"triangles", scene.triangles.size()},
      {"self_not_asked", not_asked_json(scene)},
      {"hash", scene_hash(scene)},
      {"seed", json_of(options.seed)},
      {"options", FARCULL_JSON(options, methods, peers, repeat, limit_s, device, self)},
      {"cpu", cpu_model()},
      {"commit", FARCULL_COMMIT}};
}

std::string bench_table(const Scene& scene, const BenchOptions& options,
                        const BenchResult& result) {
  std::string out = bench_title(scene, options.threads);
  if (const std::string line = not_asked_line(scene); !line.empty())
    out.insert(out.size() - 1, line);
  const BenchRow* best = row_of_boxes(result);
  Table table("llrrrrrrrrrrrrrr");
  table.add({"", "device", "ms", "low", "high", "n", result.fastest_peer ? "x fastest" : "",
             best ? "x boxes" : "", "pairs", "candidates", "MiB", "cold", "setup", "build", "find",
             "exact"});
  for (const BenchRow& row : result.rows) {
    std::vector<std::string> cells = time_cells(row);
    cells.insert(cells.begin() + 1, row.device);
    cells.insert(cells.end() - 1,
                 {ratio_text(ratio_to_fastest(result, row)),
                  best ? fmt::format("{:.2f}", row.total_ms.median / best->total_ms.median) : "",
                  grouped(row.pairs), grouped(row.candidate_pairs), mib_text(row)});
    cells.insert(cells.end(), {ms_text(row.setup_ms), ms_text(row.build_ms),
                               ms_text(row.candidates_ms), ms_text(row.exact_ms)});
    table.add(cells);
  }
  out += table.text();
  for (const BenchContestant& c : result.left_out)
    out += fmt::format("left out: {}: {}\n", c.name, c.left_out);
  out +=
      "\nms: from the triangles to the sorted pairs, median of n runs; low, high: its interval by\n"
      "the bootstrap, which holds the true median with 95 % from 9 independent runs on, with 94 %\n"
      "for 5 and 75 % for 3; cold: the first run; setup: once, not counted; build, find, exact: "
      "its\n"
      "parts; MiB: resident at the peak of the cold run, beyond before.\n";
  if (has_self(scene)) {
    out +=
        "candidates, pairs: without neighbours (farcull help terms); farcull run --self counts "
        "those too.\n";
  }
  if (result.fastest_peer) {
    out += fmt::format(
        "x fastest: ms over that of the fastest peer, {}, in this run; lower is faster.\n",
        result.rows[*result.fastest_peer].name);
  }
  return out;
}

void show_round(const Progress& progress, const std::string& name, int round, int repeats) {
  if (!progress) return;
  progress(round < 0 ? name + ", cold" : fmt::format("{}, {} of {}", name, round + 1, repeats));
}

std::string ms_text(double ms) {
  return ms < 100 ? fmt::format("{:.2f}", ms) : fmt::format("{:.0f}", ms);
}
std::string mib_text(const TimedRow& row) {
  return row.peak_mib ? fmt::format("{:.1f}", *row.peak_mib) : "-";
}
std::vector<std::string> time_cells(const TimedRow& row) {
  return {row.name + (row.repeats == 0 ? " (once)" : ""),
          ms_text(row.total_ms.median),
          ms_text(row.total_ms.low),
          ms_text(row.total_ms.high),
          std::to_string(row.total_ms.n),
          ms_text(row.cold_ms)};
}

std::string ratio_text(const std::optional<double>& ratio) {
  return ratio ? fmt::format("{:.3f}", *ratio) : "";
}

nlohmann::ordered_json bench_facts(const Scene& scene, const LeftOut& left_out,
                                   nlohmann::ordered_json options) {
  return {{"left_out", json_list(left_out,
                                 [](const auto& one) {
                                   return Json{{"name", one.first}, {"reason", one.second}};
                                 })},
          {"objects", scene.objects.size()},
          {"triangles", scene.triangles.size()},
          {"hash", scene_hash(scene)},
          {"options", std::move(options)},
          {"cpu", cpu_model()},
          {"commit", FARCULL_COMMIT}};
}

std::string left_out_lines(const LeftOut& left_out) {
  std::string out;
  for (const auto& [name, reason] : left_out)
    out += fmt::format("left out: {}: {}\n", name, reason);
  return out;
}

std::string bench_title(const Scene& scene, unsigned threads) {
  return fmt::format("{}: {}, {}; {}, {}\n\n", scene.name,
                     counted(scene.objects.size(), "object", "objects"),
                     counted(scene.triangles.size(), "triangle", "triangles"),
                     counted(threads, "thread", "threads"), cpu_model());
}

}  // namespace farcull
