#include "experiments/bench.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "experiments/bench_machine.h"
#include "experiments/peer_parts.h"
#include "verify/exact.h"

namespace farcull {
namespace {

Spread spread_of(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  const std::size_t n = values.size();
  return {(values[(n - 1) / 2] + values[n / 2]) / 2, values.front(), values.back()};
}

/// What the runs of one contestant took.
struct Times {
  std::vector<double> total, build, candidates, exact;
};

BenchAnswer timed(const Scene& scene, const Contestant& contestant, Times& times) {
  const Stopwatch watch;
  BenchAnswer answer = contestant.run(scene);
  times.total.push_back(watch.ms());
  times.build.push_back(answer.build_ms);
  times.candidates.push_back(answer.candidates_ms);
  times.exact.push_back(answer.exact_ms);
  return answer;
}

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

}  // namespace

BenchResult bench(const Scene& scene, const std::vector<Contestant>& contestants,
                  const BenchOptions& options, const Progress& progress) {
  BenchResult result;
  std::vector<const Contestant*> running;
  for (const Contestant& c : contestants) {
    if (c.left_out.empty()) {
      running.push_back(&c);
    } else {
      result.left_out.push_back(c);
    }
  }

  std::vector<Times> times(running.size());
  std::vector<TrianglePair> agreed;  // what the first one says
  std::string first;
  const auto check = [&](const std::string& name, const std::vector<TrianglePair>& pairs) {
    if (!result.disagreement) result.disagreement = compare(scene, first, agreed, name, pairs);
  };

  for (std::size_t i = 0; i < running.size(); ++i) {
    const Contestant& c = *running[i];
    if (progress) progress(c.name + ", cold");
    const PeakMemory memory;
    Times cold;
    BenchAnswer answer = timed(scene, c, cold);
    BenchRow row{.name = c.name, .device = c.device, .peer = c.peer, .library = c.library};
    row.peak_mib = memory.grown_mib();
    row.cold_ms = cold.total[0];
    row.setup_ms = c.setup_ms;
    row.candidate_pairs = answer.candidate_pairs;
    row.pairs = answer.pairs.size();
    if (cold.total[0] > 1000 * options.limit_s) times[i] = cold;
    if (i == 0) {
      agreed = std::move(answer.pairs);
      first = c.name;
    } else {
      check(c.name, answer.pairs);
    }
    result.rows.push_back(std::move(row));
  }

  for (int repeat = 0; repeat < options.repeat; ++repeat) {
    for (std::size_t i = 0; i < running.size(); ++i) {
      BenchRow& row = result.rows[i];
      if (row.cold_ms > 1000 * options.limit_s) continue;
      if (progress) progress(fmt::format("{}, {} of {}", row.name, repeat + 1, options.repeat));
      check(row.name, timed(scene, *running[i], times[i]).pairs);
      ++row.repeats;
    }
  }

  for (std::size_t i = 0; i < running.size(); ++i) {
    BenchRow& row = result.rows[i];
    row.total_ms = spread_of(times[i].total);
    row.build_ms = spread_of(times[i].build).median;
    row.candidates_ms = spread_of(times[i].candidates).median;
    row.exact_ms = spread_of(times[i].exact).median;
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
