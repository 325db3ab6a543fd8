// Rounds over the contestants, and the statistics of what they took.
#include "experiments/measure/harness.h"

#include <algorithm>
#include <nlohmann/json.hpp>
#include <numeric>

#include "experiments/measure/statistics.h"
#include "experiments/method/run.h"
#include "experiments/system/machine.h"

namespace farcull {

Spread spread_of(const std::vector<double>& values) {
  if (values.empty()) return {};
  const auto [min, max] = std::minmax_element(values.begin(), values.end());
  const Estimate median = median_estimate(values);
  return {median.value, *min, *max, median.low, median.high, median.n};
}

nlohmann::ordered_json to_json(const Spread& spread) {
  return {{"median", spread.median}, {"min", spread.min},   {"max", spread.max},
          {"low", spread.low},       {"high", spread.high}, {"n", spread.n}};
}

std::size_t median_run(const std::vector<double>& ms) {
  std::vector<std::size_t> order(ms.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  const std::size_t middle = (ms.size() - 1) / 2;
  std::nth_element(order.begin(), order.begin() + static_cast<std::ptrdiff_t>(middle), order.end(),
                   [&](std::size_t a, std::size_t b) { return ms[a] < ms[b]; });
  return order[middle];
}

double compared_ms(const Record& record) { return record.ms.cull + record.ms.exact; }

std::vector<Timed> measure_in_turns(std::size_t contestants, const Rounds& rounds,
                                    const TimedRun& run) {
  std::vector<Timed> out(contestants);
  for (int round = -rounds.warm_up; round < rounds.counted; ++round) {
    for (std::size_t i = 0; i < contestants; ++i) {
      Timed& timed = out[i];
      if (timed.over_limit(rounds)) continue;
      std::optional<PeakMemory> memory;
      if (rounds.memory && round == -rounds.warm_up) memory.emplace();
      const double ms = run(i, round);
      if (memory) timed.peak_mib = memory->grown_mib();
      if (round < 0) {
        timed.warm_up_ms = ms;
      } else {
        timed.ms.push_back(ms);
      }
    }
  }
  return out;
}

}  // namespace farcull
