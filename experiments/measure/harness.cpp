// Runs the contestants in rounds and summarizes their times. The bootstrap uses std::mt19937_64,
// which gives the same random numbers with every standard library.
#include "experiments/measure/harness.h"

#include <numeric>
#include <random>

#include "experiments/record/output.h"
#include "experiments/system/machine.h"
#include "verify/exact.h"

namespace farcull {
namespace {

constexpr std::size_t kResamples = 10000;
constexpr std::uint64_t kSeed = 1;

// Returns the same as middle(values), but reorders the values. Precondition: there is a value.
double middle_of(std::vector<double>& values) {
  const std::size_t n = values.size();
  const auto at = values.begin() + static_cast<std::ptrdiff_t>(n / 2);
  std::nth_element(values.begin(), at, values.end());
  return n % 2 == 1 ? *at : (*std::max_element(values.begin(), at) + *at) / 2;
}

}  // namespace

double middle(std::vector<double> values) { return values.empty() ? 0 : middle_of(values); }

Spread spread_of(std::vector<double> values) {
  if (values.empty()) return {};
  std::ranges::sort(values);  // the result must not depend on the order
  const std::size_t n = values.size();
  std::mt19937_64 generator(kSeed);
  std::vector<double> medians(kResamples), drawn(n);
  for (double& median : medians) {
    for (double& value : drawn) {
      // std::uniform_int_distribution differs between standard libraries, so this computes the
      // index itself. The bias of the index is below n / 2^32.
      value = values[((generator() >> 32) * n) >> 32];
    }
    median = middle_of(drawn);
  }
  std::ranges::sort(medians);
  const std::size_t cut = kResamples / 40;  // 2.5 % of the medians
  return {.median = middle(values),
          .min = values.front(),
          .max = values.back(),
          .low = medians[cut],
          .high = medians[kResamples - 1 - cut],
          .n = n};
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
      if (round < 0)
        timed.warm_up_ms = ms;
      else
        timed.ms.push_back(ms);
    }
  }
  return out;
}

std::vector<std::uint32_t> members_of(const std::vector<TrianglePair>& pairs) {
  std::vector<std::uint32_t> out;
  out.reserve(2 * pairs.size());
  for (const TrianglePair& pair : pairs) out.insert(out.end(), {pair.a, pair.b});
  std::sort(out.begin(), out.end());
  out.erase(std::unique(out.begin(), out.end()), out.end());
  return out;
}

TruePairs without_neighbours(const Scene& scene, const TruePairs& truth) {
  if (!has_self(scene)) return truth;
  const std::vector<std::uint32_t> owner = owners(scene);
  TruePairs out{.pairs = {}, .triangles = 0, .ms = truth.ms};
  std::copy_if(truth.pairs.begin(), truth.pairs.end(), std::back_inserter(out.pairs),
               [&](const TrianglePair& pair) {
                 return owner[pair.a] != owner[pair.b] ||
                        !share_position(scene.corners(pair.a), scene.corners(pair.b));
               });
  out.triangles = members_of(out.pairs).size();
  return out;
}

Errors errors_of(const TruePairs& truth, const std::vector<TrianglePair>& pairs) {
  return {.missed = lacking(truth.pairs, pairs),
          .missed_triangles = lacking(members_of(truth.pairs), members_of(pairs)),
          .wrong = lacking(pairs, truth.pairs)};
}

MeasurementContext::MeasurementContext(std::string device, Progress progress, unsigned threads)
    : device_(std::move(device)), progress_(std::move(progress)), session_(device_, threads) {}

void MeasurementContext::begin_scene(const std::string& name, long frame, long frames) {
  current_ = nullptr;
  truth_.reset();
  // Frames of one motion share the source and the lists of the method i-collide.
  if (name != name_ || frames != frames_ || frames == 0) {
    source_.reset();
    session_.sweep().forget();
  }
  name_ = name;
  frame_ = frame;
  frames_ = frames;
}

const Scene& MeasurementContext::scene(const std::string& name, long frame, long frames) {
  if (frame < 0) {
    return scene(name, [&] {
      if (progress_) progress_("reading " + name);
      return load_scene({name});
    });
  }
  if (current_ != nullptr && name == name_ && frames == frames_ && frame == frame_)
    return *current_;
  if (progress_) progress_("reading " + name);
  begin_scene(name, frame, frames);
  if (!source_) source_.emplace(std::vector{name}, FrameRange{0, frames - 1}, false);
  current_ = &source_->at(frame);
  return *current_;
}

const Scene& MeasurementContext::scene(const std::string& name,
                                       const std::function<Scene()>& make) {
  if (current_ != nullptr && name == name_ && frame_ < 0) return *current_;
  begin_scene(name, -1, 0);
  scene_ = make();
  current_ = &scene_;
  return scene_;
}

const TruePairs& MeasurementContext::truth() {
  if (!truth_) {
    if (progress_) progress_("exact tests of every pair");
    ExactResult result = all_colliding_pairs(*current_, {}, current_->ignored);
    truth_.emplace();
    std::merge(result.pairs.begin(), result.pairs.end(), result.neighbour_pairs.begin(),
               result.neighbour_pairs.end(), std::back_inserter(truth_->pairs));
    truth_->triangles = members_of(truth_->pairs).size();
    truth_->ms = result.join_ms + result.predicates_ms;
  }
  return *truth_;
}

const Scene& MeasurementContext::current() const { return *current_; }

}  // namespace farcull
