// Runs `farcull distance` and the peers in turn. Compares the peers' first answers with farcull's.
#include "experiments/measure/bench.h"

#include <fmt/format.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <tuple>

#include "core/base/error.h"
#include "experiments/method/distances.h"
#include "experiments/record/output.h"
#include "experiments/system/text_table.h"

namespace farcull {
namespace {

PeerDistances ask_ours(const Scene& scene, const PeerQuestion& question, unsigned threads) {
  const bool nearest = question.task == DistanceTask::nearest;
  const DistanceOptions options{.pairs = nearest ? DistancePairs::nearest : DistancePairs::objects,
                                .within = question.within,
                                .inside = false,
                                .threads = threads};
  const Stopwatch watch;
  PeerDistances answer{.distances = as_peer(distances(scene, options))};
  answer.query_ms = watch.ms();
  return answer;
}

bool by_objects(const PeerDistance& x, const PeerDistance& y) {
  return std::tie(x.a, x.b) < std::tie(y.a, y.b);
}

}  // namespace

std::vector<PeerDistance> as_peer(const DistanceRecord& record) {
  const bool nearest = record.options.pairs == DistancePairs::nearest;
  std::vector<PeerDistance> out;
  for (const Distance& distance : record.distances) {
    const auto [a, b] = distance.objects;
    out.push_back({a, b, distance.closest.distance});
    if (nearest) out.push_back({b, a, distance.closest.distance});
  }
  if (nearest) {  // each object keeps only its nearest object
    std::sort(out.begin(), out.end(), [](const PeerDistance& x, const PeerDistance& y) {
      return std::tie(x.a, x.distance, x.b) < std::tie(y.a, y.distance, y.b);
    });
    const auto same = [](const PeerDistance& x, const PeerDistance& y) { return x.a == y.a; };
    out.erase(std::unique(out.begin(), out.end(), same), out.end());
  } else {
    std::sort(out.begin(), out.end(), by_objects);
  }
  return out;
}

DistancePeer farcull_distances() {
  return {.name = "farcull", .library = "farcull", .run = ask_ours};
}

DistanceErrors errors_of(DistanceTask task, const std::vector<PeerDistance>& answer,
                         const std::vector<PeerDistance>& exact) {
  DistanceErrors out{.answers = answer.size()};
  // With `nearest`, each object has one answer. In a tie, the answers may name different objects.
  const bool one_each = task == DistanceTask::nearest;
  auto at = answer.begin();
  for (const PeerDistance& truth : exact) {
    const auto before = [&](const PeerDistance& x) {
      return one_each ? x.a < truth.a : by_objects(x, truth);
    };
    for (; at != answer.end() && before(*at); ++at) ++out.beyond;
    if (at == answer.end() || at->a != truth.a || (!one_each && at->b != truth.b)) {
      ++out.lacking;
      continue;
    }
    const double found = at->distance;
    if (one_each && at->b != truth.b && found != truth.distance) ++out.other_object;
    if (found == truth.distance) {
      ++out.exact;
    } else if (found == 0 || truth.distance == 0) {
      ++out.other_zero;
    } else {
      out.largest_relative =
          std::max(out.largest_relative, std::abs(found - truth.distance) / truth.distance);
    }
    ++at;
  }
  out.beyond += static_cast<std::uint64_t>(answer.end() - at);
  return out;
}

DistanceBenchResult bench_distances(const Scene& given, const DistanceBenchOptions& options,
                                    const Progress& progress) {
  // Peers do not measure an object against itself, so farcull does not do this either.
  Scene scene = given;
  for (Object& object : scene.objects) object.self = false;
  if (options.repeat < 1) throw Error("--repeat", "is below 1", "give 1 or more");
  DistanceBenchResult result;
  std::vector<DistancePeer> running = {farcull_distances()};
  for (DistancePeer& peer : chosen_peers(options.peers, distance_peers())) {
    const std::string reason = why_left_out(peer, scene);
    if (reason.empty())
      running.push_back(std::move(peer));
    else
      result.left_out.emplace_back(peer.name, reason);
  }

  const Rounds rounds{
      .warm_up = 1, .counted = options.repeat, .limit_ms = 1000 * options.limit_s, .memory = true};
  std::vector<std::vector<double>> build(running.size()), query(running.size());
  std::vector<PeerDistance> exact;
  const std::vector<Timed> timed =
      measure_in_turns(running.size(), rounds, [&](std::size_t i, int round) {
        const DistancePeer& one = running[i];
        show_round(progress, one.name, round, options.repeat);
        const Stopwatch watch;
        PeerDistances answer = one.run(scene, options.question, options.threads);
        const double took = watch.ms();
        if (round < 0) {
          if (i == 0) exact = answer.distances;
          result.rows.push_back({{.name = one.name, .library = one.library, .peer = i > 0},
                                 0,
                                 errors_of(options.question.task, answer.distances, exact)});
        }
        if (round >= 0 || took > rounds.limit_ms) {
          build[i].push_back(answer.build_ms);
          query[i].push_back(answer.query_ms);
        }
        return took;
      });

  for (std::size_t i = 0; i < running.size(); ++i) {
    set_times(timed[i], rounds, i, running[i].comparable, result);
    result.rows[i].build_ms = middle(build[i]);
    result.rows[i].query_ms = middle(query[i]);
  }
  return result;
}

nlohmann::ordered_json to_json(const Scene& scene, const DistanceBenchOptions& options,
                               const DistanceBenchResult& result) {
  using Json = nlohmann::ordered_json;
  Json rows = Json::array();
  for (const DistanceBenchRow& row : result.rows) {
    Json one = FARCULL_JSON(row, name, library, peer, total_ms, build_ms, query_ms, cold_ms,
                            repeats, peak_mib);
    one["ratio_to_fastest_peer"] = json_of(ratio_to_fastest(result, row));
    one.update(FARCULL_JSON(row.errors, answers, lacking, beyond, exact, other_zero, other_object));
    one["largest_relative_error"] = row.errors.largest_relative;
    rows.push_back(std::move(one));
  }
  const double within = options.question.within;
  const bool objects = options.question.task == DistanceTask::objects;
  Json json = {{"scene", scene.name},
               {"distances", objects ? "objects" : "nearest"},
               {"within", json_if(!std::isinf(within), within)},
               {"threads", options.threads},
               {"rows", rows},
               {"fastest_peer", result.fastest_peer ? Json(result.rows[*result.fastest_peer].name)
                                                    : Json(nullptr)}};
  json.update(bench_facts(scene, result.left_out, FARCULL_JSON(options, peers, repeat, limit_s)));
  return json;
}

std::string distance_bench_table(const Scene& scene, const DistanceBenchOptions& options,
                                 const DistanceBenchResult& result) {
  std::string out = bench_title(scene, options.threads);
  Table table("lrrrrrrrrrrrrrr");
  table.add({"", "ms", "low", "high", "n", "cold", "build", "query", "MiB", "distances", "exact",
             "lacking", "other 0", "rel. error", result.fastest_peer ? "x fastest" : ""});
  for (const DistanceBenchRow& row : result.rows) {
    std::vector<std::string> cells = time_cells(row);
    cells.insert(cells.end(), {ms_text(row.build_ms), ms_text(row.query_ms), mib_text(row),
                               grouped(row.errors.answers), grouped(row.errors.exact),
                               grouped(row.errors.lacking), grouped(row.errors.other_zero),
                               fmt::format("{:.1e}", row.errors.largest_relative),
                               ratio_text(ratio_to_fastest(result, row))});
    table.add(cells);
  }
  out += table.text() + left_out_lines(result.left_out);
  out +=
      "\nms: from the triangles to the distances, median of n runs; low, high: its interval\n"
      "by the bootstrap, which holds the true median with 95 % from 9 independent runs on, with\n"
      "94 % for 5 and 75 % for 3; cold: the first run; MiB: resident at the peak of the cold run,\n"
      "beyond before. exact: the correctly rounded distance; lacking: distances that were not\n"
      "found; other 0: objects that meet called apart, or the reverse; rel. error: the largest "
      "one\n"
      "of the others.\n";
  if (result.fastest_peer) {
    out +=
        fmt::format("x fastest: of the fastest peer that measures in doubles, {}, in this run.\n",
                    result.rows[*result.fastest_peer].name);
  }
  return out;
}

}  // namespace farcull
