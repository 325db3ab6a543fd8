// A cold round, then rounds that count; every answer is compared with that of the first contestant.
#include "experiments/measure/bench.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "experiments/measure/harness.h"
#include "experiments/measure/peers/parts.h"
#include "verify/exact.h"

namespace farcull {
namespace {

// Medians of the parts of a contestant's runs.
struct Parts {
  std::vector<double> build, candidates, exact;

  void add(const BenchAnswer& answer) {
    build.push_back(answer.build_ms);
    candidates.push_back(answer.candidates_ms);
    exact.push_back(answer.exact_ms);
  }
  void write_to(BenchRow& row) const {
    row.build_ms = middle(build);
    row.candidates_ms = middle(candidates);
    row.exact_ms = middle(exact);
  }
};

// The first pair, in order, that only one of two sorted lists has.
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

BenchRow cold_row(const BenchContestant& c, const BenchAnswer& answer) {
  BenchRow row{.name = c.name, .device = c.device, .peer = c.peer, .library = c.library};
  row.setup_ms = c.setup_ms;
  row.candidate_pairs = answer.candidate_pairs;
  row.pairs = answer.pairs.size();
  return row;
}

}  // namespace

BenchResult bench(const Scene& scene, const std::vector<BenchContestant>& contestants,
                  const BenchOptions& options, const Progress& progress) {
  BenchResult result;
  std::vector<const BenchContestant*> running;
  for (const BenchContestant& c : contestants) {
    if (c.left_out.empty()) {
      running.push_back(&c);
    } else {
      result.left_out.push_back(c);
    }
  }

  const Rounds rounds{
      .warm_up = 1, .counted = options.repeat, .limit_ms = 1000 * options.limit_s, .memory = true};
  std::vector<Parts> parts(running.size());
  std::vector<TrianglePair> agreed;  // the pairs of the first contestant
  const std::vector<Timed> timed =
      measure_in_turns(running.size(), rounds, [&](std::size_t i, int round) {
        const BenchContestant& c = *running[i];
        if (progress) {
          progress(round < 0 ? c.name + ", cold"
                             : fmt::format("{}, {} of {}", c.name, round + 1, options.repeat));
        }
        const Stopwatch watch;
        BenchAnswer answer = c.run(scene);
        const double ms = watch.ms();
        if (round < 0) result.rows.push_back(cold_row(c, answer));
        // Only a cold run over the limit counts.
        if (round >= 0 || ms > rounds.limit_ms) parts[i].add(answer);
        if (i == 0 && round < 0) {
          agreed = std::move(answer.pairs);
        } else if (!result.disagreement) {
          result.disagreement = compare(scene, running[0]->name, agreed, c.name, answer.pairs);
        }
        return ms;
      });

  for (std::size_t i = 0; i < running.size(); ++i) {
    BenchRow& row = result.rows[i];
    const bool once = timed[i].over_limit(rounds);
    row.total_ms = spread_of(once ? std::vector{timed[i].warm_up_ms} : timed[i].ms);
    row.cold_ms = timed[i].warm_up_ms;
    row.peak_mib = timed[i].peak_mib;
    row.repeats = static_cast<int>(timed[i].ms.size());
    parts[i].write_to(row);
    if (row.peer && (!result.fastest_peer ||
                     row.total_ms.median < result.rows[*result.fastest_peer].total_ms.median)) {
      result.fastest_peer = i;
    }
  }
  return result;
}

std::optional<double> ratio_to_fastest(const BenchResult& result, const BenchRow& row) {
  if (!result.fastest_peer) return std::nullopt;
  return row.total_ms.median / result.rows[*result.fastest_peer].total_ms.median;
}

}  // namespace farcull
