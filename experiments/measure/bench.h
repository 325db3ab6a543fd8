// `farcull bench` times peers and our methods from the same triangles to the same pairs; with
// --distances, to distances between objects, whose errors it counts; with --poses, frames in which
// an object moves as a whole. One process runs them all.
//
// Every contestant runs once cold, when its memory is measured, and then `repeat` times, in turn
// with the others, so that a slow moment of the machine falls on all. Its setup (contexts, shaders,
// thread pools) comes before and is timed apart. All contestants must find the same pairs.
#pragma once

#include <algorithm>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

#include "experiments/measure/harness.h"
#include "experiments/peers/peer.h"

namespace farcull {

/// A method or a library that takes part.
struct BenchContestant {
  std::string name;
  std::string device = "cpu";  // or the renderer
  bool peer = false;
  std::string library = {};   // of a peer, with its version
  std::string left_out = {};  // why it does not run; empty: it does
  double setup_ms = 0;
  BenchRun run = {};  // null if it is left out
};

struct BenchOptions {
  std::string peers = "all";    // all, none, or names with commas
  std::string methods = "all";  // as peers
  unsigned threads = 1;
  int repeat = 5;
  double limit_s = 60;                // a contestant whose cold run takes longer is not repeated
  std::string device;                 // "": GL if hardware answers; "cpu": no GL; or as farcull run
  bool self = false;                  // every object is tested against itself as well
  std::optional<std::uint64_t> seed;  // of the scene
};

/// Times and memory of a contestant.
struct TimedRow {
  std::string name, library;
  bool peer = false;
  Spread total_ms = {};                 // of the repeats, or of the cold run without repeats
  double cold_ms = 0, build_ms = 0;     // build_ms: a median
  std::optional<double> peak_mib = {};  // of the cold run, beyond what was there before it
  int repeats = 0;                      // 0: only the cold run, which was over the limit
};

struct BenchRow : TimedRow {
  std::string device;
  double setup_ms = 0, candidates_ms = 0, exact_ms = 0;  // the last two are medians
  std::uint64_t candidate_pairs = 0, pairs = 0;
};

/// A pair that one contestant has and another lacks.
struct Disagreement {
  std::string has, lacks;
  TrianglePair pair;     // the first such pair
  bool collides = true;  // by verify/exact.h, for that pair alone
};

struct BenchResult {
  std::vector<BenchRow> rows;
  std::vector<BenchContestant> left_out;
  std::optional<Disagreement> disagreement;  // the first; makes all ratios meaningless
  std::optional<std::size_t> fastest_peer;   // into rows
};

/// The names of `known` that the text asks for (`all`, `none`, or names with commas), in the order
/// of `known`. Throws Error naming the option.
std::vector<std::string> chosen_names(const std::string& option, const std::string& text,
                                      const std::vector<std::string>& known);
/// The peers that the text of --peers asks for.
template <class AnyPeer>
std::vector<AnyPeer> chosen_peers(const std::string& text, std::vector<AnyPeer> known) {
  std::vector<std::string> names;
  for (const AnyPeer& peer : known) names.push_back(peer.name);
  names = chosen_names("--peers", text, names);
  std::erase_if(known, [&](const AnyPeer& peer) {
    return std::find(names.begin(), names.end(), peer.name) == names.end();
  });
  return known;
}

/// Throws Error naming the option for unknown names, a repeat below 1 or a limit below 0.
void validate(const BenchOptions& options);

/// Our methods and the peers that the options name, set up. Our methods are boxes, far and exact on
/// the CPU, and far on GL if there is a device (without --device only on hardware). Throws Error
/// for a contestant that was asked for by name and cannot run at all in this build or on this
/// machine.
std::vector<BenchContestant> contestants(const Scene& scene, const BenchOptions& options,
                                         const Progress& progress = {});

BenchResult bench(const Scene& scene, const std::vector<BenchContestant>& contestants,
                  const BenchOptions& options, const Progress& progress = {});

/// The median of a row of the result over that of the fastest peer; empty without a peer.
template <class Result>
std::optional<double> ratio_to_fastest(const Result& result, const TimedRow& row) {
  if (!result.fastest_peer) return std::nullopt;
  return row.total_ms.median / result.rows[*result.fastest_peer].total_ms.median;
}

/// The disagreement in words, with the answer of the exact predicates for the pair.
std::string describe(const Scene& scene, const Disagreement& disagreement);

nlohmann::ordered_json to_json(const Scene& scene, const BenchOptions& options,
                               const BenchResult& result);
std::string bench_table(const Scene& scene, const BenchOptions& options, const BenchResult& result);

// Distances.

struct DistanceRecord;

struct DistanceBenchOptions {
  PeerQuestion question = {};
  std::string peers = "all";  // all, none, or names with commas
  unsigned threads = 1;
  int repeat = 5;
  double limit_s = 60;  // a contestant whose cold run takes longer is not repeated
};

/// The answers of a contestant compared with ours, which are exact.
struct DistanceErrors {
  std::uint64_t answers = 0;
  std::uint64_t lacking = 0;       // distances that only our answer has
  std::uint64_t beyond = 0;        // distances that our answer leaves out: larger than `within`
  std::uint64_t exact = 0;         // answers that are the same double as ours
  std::uint64_t other_zero = 0;    // answers 0 for objects apart, or not 0 for objects that meet
  std::uint64_t other_object = 0;  // with `nearest`: answers with a farther object
  double largest_relative = 0;     // of distances that neither answer calls 0
  FARCULL_FIELDS(answers, exact, lacking, beyond, other_zero, other_object, largest_relative)
};

struct DistanceBenchRow : TimedRow {
  double query_ms = 0;  // a median
  DistanceErrors errors = {};
};

using LeftOut = std::vector<std::pair<std::string, std::string>>;  // name, reason

struct DistanceBenchResult {
  std::vector<DistanceBenchRow> rows;  // ours is the first
  LeftOut left_out;
  std::optional<std::size_t> fastest_peer;  // into rows; comparable peers only
};

/// Measures distances between different objects only; objects that the scene tests against
/// themselves are not. Throws Error naming the option if a peer is unknown or the repeat is
/// below 1.
DistanceBenchResult bench_distances(const Scene& scene, const DistanceBenchOptions& options,
                                    const Progress& progress = {});

/// `farcull distance` as a peer: the first contestant of every bench_distances().
DistancePeer farcull_distances();
/// The distances of a record as a peer gives them. Precondition: the record is of `objects`, or of
/// `nearest` with k = 1.
std::vector<PeerDistance> as_peer(const DistanceRecord& record);

/// Compares `answer` with `exact`, the exact answer to the same question. Both are sorted.
DistanceErrors errors_of(DistanceTask task, const std::vector<PeerDistance>& answer,
                         const std::vector<PeerDistance>& exact);

nlohmann::ordered_json to_json(const Scene& scene, const DistanceBenchOptions& options,
                               const DistanceBenchResult& result);
std::string distance_bench_table(const Scene& scene, const DistanceBenchOptions& options,
                                 const DistanceBenchResult& result);

// Poses: frames in which an object moves as a whole, found by new calls of the library, by a
// Collider that is given poses alone, and by peers that keep models of the objects.

struct PoseBenchOptions {
  std::string peers = "all";  // all, none, or names with commas
  unsigned threads = 1;
  int repeat = 5;       // frames that count
  double limit_s = 60;  // a contestant whose cold frame takes longer is not repeated
};

struct PoseBenchRow : TimedRow {
  double cpu_ms = 0;  // processor time of the process, a median
  // Sums over all frames. lacking: pairs that only row 0 has; beyond: pairs that row 0 lacks.
  std::uint64_t pairs = 0, lacking = 0, beyond = 0;
};

struct PoseBenchResult {
  std::vector<PoseBenchRow> rows;  // a call with arrays; a Collider given poses alone; peers
  LeftOut left_out;
  std::optional<std::size_t> fastest_peer;  // into rows
};

/// Turns the first object a little in each frame, and finds the colliding pairs of different
/// objects. Throws Error that names the option if a peer is unknown or `repeat` is below 1. Also
/// throws as Collider::find() does.
PoseBenchResult bench_poses(const Scene& scene, const PoseBenchOptions& options,
                            const Progress& progress = {});

/// Which of our rows differs from row 0, in words; empty: none.
std::string disagreement_of(const PoseBenchResult& result);

nlohmann::ordered_json to_json(const Scene& scene, const PoseBenchOptions& options,
                               const PoseBenchResult& result);
std::string pose_bench_table(const Scene& scene, const PoseBenchOptions& options,
                             const PoseBenchResult& result);

// Shared by the three.

/// Reports "NAME, cold" or "NAME, 2 of 5" if there is a callback.
void show_round(const Progress& progress, const std::string& name, int round, int repeats);
/// Writes the times of row i. Makes the row the fastest peer if it is a peer, `counts` is true and
/// its median is the least so far.
template <class Result>
void set_times(const Timed& timed, const Rounds& rounds, std::size_t i, bool counts,
               Result& result) {
  TimedRow& row = result.rows[i];
  row.total_ms = spread_of(timed.over_limit(rounds) ? std::vector{timed.warm_up_ms} : timed.ms);
  row.cold_ms = timed.warm_up_ms;
  row.peak_mib = timed.peak_mib;
  row.repeats = static_cast<int>(timed.ms.size());
  if (!row.peer || !counts) return;
  const std::optional<std::size_t> fastest = result.fastest_peer;
  if (!fastest || row.total_ms.median < result.rows[*fastest].total_ms.median)
    result.fastest_peer = i;
}
/// Cells of a table: milliseconds; memory; the first cells of a row, from its name to its cold
/// run; a ratio, or nothing.
std::string ms_text(double ms);
std::string mib_text(const TimedRow& row);
std::vector<std::string> time_cells(const TimedRow& row);
std::string ratio_text(const std::optional<double>& ratio);
/// The end of a record of distances or of poses: what was left out and why, the scene's facts, the
/// options, the processor and the commit.
nlohmann::ordered_json bench_facts(const Scene& scene, const LeftOut& left_out,
                                   nlohmann::ordered_json options);
/// The first line of a table, and the lines below it that say what was left out.
std::string bench_title(const Scene& scene, unsigned threads);
std::string left_out_lines(const LeftOut& left_out);

}  // namespace farcull
