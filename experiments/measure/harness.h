// The measuring harness of bench, compare and the studies: in which order contestants run, and how
// their times are summarized. The bootstrap gives intervals of medians.
//
// MeasurementContext keeps the state that measurements of one process share: the device with its
// shaders, the scene that was read last, and the pairs that truly collide in that scene.
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

/// The middle value, or the mean of the two in the middle if the number of values is even; 0 if
/// there are no values.
double middle(std::vector<double> values);

/// Statistics of n values. median: as middle(). low, high: its 95 % interval, the percentile
/// interval of the bootstrap (Efron and Tibshirani 1993, section 13.3): 10,000 times, n of the n
/// values are drawn with replacement, and the interval goes from the 2.5th to the 97.5th percentile
/// of the medians of these draws. The same values in any order give the same interval.
/// docs/experiments.md, "Statistics", has the probability with which it contains the true median.
struct Spread {
  double median = 0, min = 0, max = 0;
  double low = 0, high = 0;
  std::size_t n = 0;
  FARCULL_FIELDS(median, min, max, low, high, n)
};
/// All 0 if there are no values.
Spread spread_of(std::vector<double> values);
nlohmann::ordered_json to_json(const Spread& spread);

/// The index of the run with the median time; if the number of runs is even, the faster of the two
/// in the middle. Precondition: not empty.
std::size_t median_run(const std::vector<double>& ms);

/// The time by which runs are compared, in ms: culling and exact tests, without setup and
/// verification.
double compared_ms(const Record& record);

/// How often each contestant runs.
struct Rounds {
  int warm_up = 0;  // rounds before those that count
  int counted = 1;
  /// A contestant whose warm-up run takes longer is not run again.
  double limit_ms = std::numeric_limits<double>::infinity();
  bool memory = false;  // measure the memory of the first warm-up run
};

/// Times and memory of the runs of a contestant.
struct Timed {
  std::vector<double> ms;          // of the counted runs, in their order
  double warm_up_ms = 0;           // of the last warm-up run; 0 without one
  std::optional<double> peak_mib;  // of the first warm-up run, above the memory before it
  bool over_limit(const Rounds& rounds) const { return warm_up_ms > rounds.limit_ms; }
};

/// Runs a contestant (0 .. count - 1) in a round (0 .. counted - 1; negative: warm-up) and returns
/// its time in ms.
using TimedRun = std::function<double(std::size_t contestant, int round)>;

/// Runs all contestants in turn, round after round, so that a slow moment of the machine falls on
/// all of them. An exception of `run` ends the measurement.
std::vector<Timed> measure_in_turns(std::size_t contestants, const Rounds& rounds,
                                    const TimedRun& run);

// ---- the state that measurements of one process share ----

/// The colliding pairs of a scene, by exact predicates on every pair whose boxes meet
/// (verify/exact.h).
struct TruePairs {
  std::vector<TrianglePair> pairs;  // colliding, neighbours included; sorted
  std::uint64_t triangles = 0;      // in at least one of the pairs
  double ms = 0;                    // time of finding the pairs
};

/// The triangles that are in a pair, each once, ascending.
std::vector<std::uint32_t> members_of(const std::vector<TrianglePair>& pairs);

/// The truth without pairs of triangles of one object that share a vertex position. Other libraries
/// leave these pairs out.
TruePairs without_neighbours(const Scene& scene, const TruePairs& truth);

/// How an answer differs from the truth. All pairs count, neighbours among them.
struct Errors {
  std::uint64_t missed = 0;            // colliding pairs that the answer lacks
  std::uint64_t missed_triangles = 0;  // colliding triangles in none of the answer's pairs
  std::uint64_t wrong = 0;             // pairs of the answer that do not collide
};
/// pairs: sorted.
Errors errors_of(const TruePairs& truth, const std::vector<TrianglePair>& pairs);

/// How many values of a are not in b. Both are sorted.
template <class Value>
std::uint64_t lacking(const std::vector<Value>& a, const std::vector<Value>& b) {
  std::vector<Value> difference;
  std::ranges::set_difference(a, b, std::back_inserter(difference));
  return difference.size();
}

class MeasurementContext {
 public:
  /// device: as --device, "" for what Session chooses. threads: as in Session.
  explicit MeasurementContext(std::string device, Progress progress = {}, unsigned threads = 0);

  Session& session() { return session_; }
  const std::string& device() const { return device_; }
  const Progress& progress() const { return progress_; }

  /// The scene of that name; it is kept until another scene is requested. frame < 0: the scene
  /// without frames; else this frame of its motion, which has `frames` frames. The same name with
  /// another number of frames is another scene.
  const Scene& scene(const std::string& name, long frame = -1, long frames = 0);
  /// The scene that `make` returns, kept under the name like a scene that was read.
  const Scene& scene(const std::string& name, const std::function<Scene()>& make);
  /// The scene asked for last, and its colliding pairs. Precondition: a scene was asked for.
  const Scene& current() const;
  const TruePairs& truth();
  /// The notes of the scene's motion on its current frame (FrameNotes); empty if the scene was read
  /// without frames.
  FrameNotes notes() const { return source_ ? source_->notes() : FrameNotes{}; }

 private:
  /// Notes the name of the next scene and drops the data of the previous one.
  void begin_scene(const std::string& name, long frame, long frames);

  std::string device_;
  Progress progress_;
  Session session_;
  std::string name_;
  long frame_ = -1;
  long frames_ = 0;  // 0: without frames
  std::optional<FrameSource> source_;
  Scene scene_;
  const Scene* current_ = nullptr;
  std::optional<TruePairs> truth_;
};

}  // namespace farcull
