// Rounds over the contestants, and the statistics of what they took: resampling by a generator
// whose numbers the standard fixes, and Boost's quantiles.
#include "experiments/measure/harness.h"

#include <algorithm>
#include <boost/math/distributions/students_t.hpp>
#include <cstdint>
#include <numeric>
#include <random>

#include "experiments/method/run.h"
#include "experiments/record/fields.h"
#include "experiments/system/machine.h"

namespace farcull {
namespace {

constexpr std::size_t kResamples = 10000;
constexpr std::uint64_t kSeed = 1;

// Reorders the values.
double middle_of(std::vector<double>& values) {
  const std::size_t n = values.size();
  const auto at = values.begin() + static_cast<std::ptrdiff_t>(n / 2);
  std::nth_element(values.begin(), at, values.end());
  return n % 2 == 1 ? *at : (*std::max_element(values.begin(), at) + *at) / 2;
}

class Draws {
 public:
  // The median of as many values, drawn with replacement.
  double median(const std::vector<double>& values) {
    drawn_.clear();
    for (std::size_t i = 0; i < values.size(); ++i) {
      // std::uniform_int_distribution differs between libraries. The bias is below n / 2^32.
      drawn_.push_back(values[((generator_() >> 32) * values.size()) >> 32]);
    }
    return middle_of(drawn_);
  }

 private:
  std::mt19937_64 generator_{kSeed};
  std::vector<double> drawn_;
};

// With the interval of `resampled`, which is not empty.
Estimate with_interval(double value, std::size_t n, std::vector<double> resampled) {
  std::sort(resampled.begin(), resampled.end());
  const std::size_t cut = resampled.size() / 40;  // 2.5 %
  return {value, resampled[cut], resampled[resampled.size() - 1 - cut], n};
}

}  // namespace

double middle(std::vector<double> values) { return values.empty() ? 0 : middle_of(values); }

Estimate median_estimate(std::vector<double> values) {
  if (values.empty()) return {};
  std::sort(values.begin(), values.end());
  Draws draws;
  std::vector<double> medians(kResamples);
  for (double& median : medians) median = draws.median(values);
  const std::size_t n = values.size();
  return with_interval(middle_of(values), n, std::move(medians));
}

Estimate ratio_estimate(std::vector<double> over, std::vector<double> under) {
  std::sort(over.begin(), over.end());
  std::sort(under.begin(), under.end());
  Draws draws;
  std::vector<double> ratios(kResamples);
  for (double& ratio : ratios) {
    const double numerator = draws.median(over);
    ratio = numerator / draws.median(under);
  }
  const std::size_t n = std::min(over.size(), under.size());
  return with_interval(middle_of(over) / middle_of(under), n, std::move(ratios));
}

double student_t95(std::size_t degrees) {
  return boost::math::quantile(boost::math::students_t(static_cast<double>(degrees)), 0.975);
}

Spread spread_of(const std::vector<double>& values) {
  if (values.empty()) return {};
  const auto [min, max] = std::minmax_element(values.begin(), values.end());
  const Estimate median = median_estimate(values);
  return {median.value, *min, *max, median.low, median.high, median.n};
}

nlohmann::ordered_json to_json(const Spread& spread) { return json_of(spread); }

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
