// The measuring harness of bench, compare and the studies. It runs contestants in turn and
// summarizes their times. The bootstrap gives intervals of medians.
//
// MeasurementContext keeps the state that measurements of one process share: the device with its
// shaders, the last scene, and the colliding pairs of that scene.
#pragma once

#include <algorithm>
#include <functional>
#include <iterator>
#include <limits>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

#include "core/base/fields.h"
#include "experiments/method/run.h"
#include "experiments/scenes/frames.h"
#include "experiments/scenes/scene_file.h"

namespace farcull {

/// Returns the median; 0 if there are no values.
double middle(std::vector<double> values);

/// Statistics of n values. median: as middle(). low, high: the 95 % interval of the median, which
/// is the percentile interval of the bootstrap (Efron and Tibshirani 1993, section 13.3). For this
/// interval, n values are drawn with replacement 10,000 times. The interval goes from the 2.5th to
/// the 97.5th percentile of the medians of these draws. The order of the values does not matter.
/// docs/experiments.md, "Statistics", says how likely the interval contains the true median.
struct Spread {
  double median = 0, min = 0, max = 0;
  double low = 0, high = 0;
  std::size_t n = 0;
  FARCULL_FIELDS(median, min, max, low, high, n)
};
/// Returns the statistics of the values; all are 0 if there are no values.
Spread spread_of(std::vector<double> values);
nlohmann::ordered_json to_json(const Spread& spread);

/// Returns the index of the run with the median time. If the number of runs is even, there are two
/// middle runs, and the faster one is returned. Precondition: there is a run.
std::size_t median_run(const std::vector<double>& ms);

/// Returns the time of culling and exact tests in ms, by which runs are compared.
double compared_ms(const Record& record);

/// How often each contestant runs.
struct Rounds {
  int warm_up = 0;  // number of warm-up rounds
  int counted = 1;  // number of rounds after the warm-up
  /// A contestant whose warm-up run takes longer is not run again.
  double limit_ms = std::numeric_limits<double>::infinity();
  bool memory = false;  // measure the memory of the first warm-up run
};

/// Times and memory of the runs of a contestant.
struct Timed {
  std::vector<double> ms;          // times of the counted runs
  double warm_up_ms = 0;           // time of the last warm-up run; 0 without a warm-up
  std::optional<double> peak_mib;  // memory that the first warm-up run added at its peak
  bool over_limit(const Rounds& rounds) const { return warm_up_ms > rounds.limit_ms; }
};

/// Runs a contestant in a round and returns its time in ms. contestant: an index. round: from 0;
/// negative for a warm-up.
using TimedRun = std::function<double(std::size_t contestant, int round)>;

/// Runs all contestants in turn, round after round, so that a temporary slowdown of the machine
/// affects all contestants. An exception of `run` ends the measurement.
std::vector<Timed> measure_in_turns(std::size_t contestants, const Rounds& rounds,
                                    const TimedRun& run);

// ---- the state that measurements of one process share ----

/// The colliding pairs of a scene. Exact predicates (verify/exact.h) decide every pair of triangles
/// whose boxes meet.
struct TruePairs {
  std::vector<TrianglePair> pairs;  // sorted; includes neighbours
  std::uint64_t triangles = 0;      // number of triangles in the pairs
  double ms = 0;                    // time of finding the pairs
};

/// Returns the triangles that are in a pair, each once, ascending.
std::vector<std::uint32_t> members_of(const std::vector<TrianglePair>& pairs);

/// Returns the truth without pairs of neighbours, since other libraries leave them out. Neighbours
/// are two triangles of one object that share a vertex position.
TruePairs without_neighbours(const Scene& scene, const TruePairs& truth);

/// How an answer differs from the truth. Neighbours count as any other pair.
struct Errors {
  std::uint64_t missed = 0;            // colliding pairs that the answer lacks
  std::uint64_t missed_triangles = 0;  // colliding triangles in none of the answer's pairs
  std::uint64_t wrong = 0;             // pairs of the answer that do not collide
};
/// Compares an answer with the truth. pairs: the answer, sorted.
Errors errors_of(const TruePairs& truth, const std::vector<TrianglePair>& pairs);

/// Returns how many values of a are not in b. a and b are sorted.
template <class Value>
std::uint64_t lacking(const std::vector<Value>& a, const std::vector<Value>& b) {
  std::vector<Value> difference;
  std::ranges::set_difference(a, b, std::back_inserter(difference));
  return difference.size();
}

class MeasurementContext {
 public:
  /// device, threads: as in Session.
  explicit MeasurementContext(std::string device, Progress progress = {}, unsigned threads = 0);

  Session& session() { return session_; }
  const std::string& device() const { return device_; }
  const Progress& progress() const { return progress_; }

  /// Returns the scene of that name, which is valid until another scene is requested. frame: the
  /// frame of the scene's motion; negative: the scene has no motion. frames: the number of frames
  /// of the motion.
  const Scene& scene(const std::string& name, long frame = -1, long frames = 0);
  /// Returns the scene that `make` makes, and keeps the scene under that name.
  const Scene& scene(const std::string& name, const std::function<Scene()>& make);
  /// Returns the last scene. Precondition: scene() was called.
  const Scene& current() const;
  const TruePairs& truth();
  /// Returns the notes on the current frame; empty if the scene has no motion.
  FrameNotes notes() const { return source_ ? source_->notes() : FrameNotes{}; }

 private:
  /// Sets the name of the next scene and drops the data of the previous scene.
  void begin_scene(const std::string& name, long frame, long frames);

  std::string device_;
  Progress progress_;
  Session session_;
  std::string name_;
  long frame_ = -1;
  long frames_ = 0;  // 0: the scene has no motion
  std::optional<FrameSource> source_;
  Scene scene_;
  const Scene* current_ = nullptr;
  std::optional<TruePairs> truth_;
};

}  // namespace farcull
