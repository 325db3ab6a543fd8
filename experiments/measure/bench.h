// `farcull bench` times farcull's methods and other libraries (peers) on one scene, in one process.
// Without an option, it times finding the colliding pairs. With --distances, it times distances
// between objects, and counts wrong distances. With --poses, it times frames in which an object
// moves.
//
// Every contestant is first set up (contexts, shaders, thread pools). Then it runs once cold, and
// its memory is measured. Then the contestants run in turn, `repeat` times each, so that a
// temporary slowdown of the machine affects all contestants. All must find the same pairs.
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
  std::string device = "cpu";  // "cpu", or the name of the renderer
  bool peer = false;
  std::string library = {};   // name and version of a peer's library
  std::string left_out = {};  // why the contestant does not run; empty: it runs
  double setup_ms = 0;
  BenchRun run = {};  // null if the contestant is left out
};

struct BenchOptions {
  std::string peers = "all";    // all, none, or names with commas
  std::string methods = "all";  // all, none, or names with commas
  unsigned threads = 1;
  int repeat = 5;
  double limit_s = 60;                // a contestant whose cold run takes longer is not repeated
  std::string device;                 // as --device of `farcull run`; "": GL only on hardware
  bool self = false;                  // tests every object against itself
  std::optional<std::uint64_t> seed;  // seed of the scene
};

/// Times and memory of a contestant.
struct TimedRow {
  std::string name, library;
  bool peer = false;
  Spread total_ms = {};                 // of the repeated runs; without repeats, of the cold run
  double cold_ms = 0, build_ms = 0;     // build_ms: a median
  std::optional<double> peak_mib = {};  // memory that the cold run added at its peak
  int repeats = 0;                      // 0: the cold run was over the limit
};

struct BenchRow : TimedRow {
  std::string device;
  double setup_ms = 0, candidates_ms = 0, exact_ms = 0;  // the last two are medians
  std::uint64_t candidate_pairs = 0, pairs = 0;
};

/// A pair that one contestant found and another did not find.
struct Disagreement {
  std::string has, lacks;
  TrianglePair pair;
  bool collides = true;  // whether the pair collides by verify/exact.h
};

struct BenchResult {
  std::vector<BenchRow> rows;
  std::vector<BenchContestant> left_out;
  std::optional<Disagreement> disagreement;  // if set, all ratios are meaningless
  std::optional<std::size_t> fastest_peer;   // index into rows
};

/// Returns the names of `known` that the text selects, in the order of `known`. text: `all`,
/// `none`, or names with commas between. Throws Error naming the option for an unknown name.
std::vector<std::string> chosen_names(const std::string& option, const std::string& text,
                                      const std::vector<std::string>& known);
/// Returns the peers that `text`, the value of --peers, selects.
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

/// Sets up the methods and peers that the options name, and returns them. Our methods are boxes,
/// far and exact on the CPU, and far on GL if there is a device. If --device is not given, only
/// hardware counts as a GL device. Throws Error if a contestant that an option names cannot run.
std::vector<BenchContestant> contestants(const Scene& scene, const BenchOptions& options,
                                         const Progress& progress = {});

BenchResult bench(const Scene& scene, const std::vector<BenchContestant>& contestants,
                  const BenchOptions& options, const Progress& progress = {});

/// Returns the row's median divided by the median of the fastest peer; empty without a peer.
template <class Result>
std::optional<double> ratio_to_fastest(const Result& result, const TimedRow& row) {
  if (!result.fastest_peer) return std::nullopt;
  return row.total_ms.median / result.rows[*result.fastest_peer].total_ms.median;
}

/// Returns the disagreement in words, with the answer of the exact predicates for the pair.
std::string describe(const Scene& scene, const Disagreement& disagreement);

nlohmann::ordered_json to_json(const Scene& scene, const BenchOptions& options,
                               const BenchResult& result);
std::string bench_table(const Scene& scene, const BenchOptions& options, const BenchResult& result);

// ---- the benchmark of distances ----

struct DistanceRecord;

struct DistanceBenchOptions {
  PeerQuestion question = {};
  std::string peers = "all";  // all, none, or names with commas
  unsigned threads = 1;
  int repeat = 5;
  double limit_s = 60;  // a contestant whose cold run takes longer is not repeated
};

/// A contestant's answers compared with farcull's answers, which are exact.
struct DistanceErrors {
  std::uint64_t answers = 0;
  std::uint64_t lacking = 0;       // distances that farcull gives, but not the contestant
  std::uint64_t beyond = 0;        // distances that the contestant gives, but not farcull
  std::uint64_t exact = 0;         // distances that are the same double as farcull's
  std::uint64_t other_zero = 0;    // distances where exactly one of the two answers is 0
  std::uint64_t other_object = 0;  // with `nearest`: answers with a farther object
  double largest_relative = 0;     // largest relative error where neither answer is 0
  FARCULL_FIELDS(answers, exact, lacking, beyond, other_zero, other_object, largest_relative)
};

struct DistanceBenchRow : TimedRow {
  double query_ms = 0;  // median of the runs
  DistanceErrors errors = {};
};

using LeftOut = std::vector<std::pair<std::string, std::string>>;  // name, reason

struct DistanceBenchResult {
  std::vector<DistanceBenchRow> rows;  // rows[0] is farcull
  LeftOut left_out;
  std::optional<std::size_t> fastest_peer;  // index into rows; only comparable peers count
};

/// Measures distances between different objects only. Throws Error naming the option if a peer is
/// unknown or `repeat` is below 1.
DistanceBenchResult bench_distances(const Scene& scene, const DistanceBenchOptions& options,
                                    const Progress& progress = {});

/// Returns `farcull distance` in the form of a peer: the first contestant of bench_distances().
DistancePeer farcull_distances();
/// Returns the distances of a record in the form that peers use. Precondition: the record answers
/// `objects`, or `nearest` with k = 1.
std::vector<PeerDistance> as_peer(const DistanceRecord& record);

/// Compares `answer` with `exact`, the exact answer to the same question. Both are sorted.
DistanceErrors errors_of(DistanceTask task, const std::vector<PeerDistance>& answer,
                         const std::vector<PeerDistance>& exact);

nlohmann::ordered_json to_json(const Scene& scene, const DistanceBenchOptions& options,
                               const DistanceBenchResult& result);
std::string distance_bench_table(const Scene& scene, const DistanceBenchOptions& options,
                                 const DistanceBenchResult& result);

// The benchmark of poses. In each frame, an object moves as a rigid body. The contestants are a new
// call of the library per frame, a Collider that gets only poses, and peers that keep the objects.

struct PoseBenchOptions {
  std::string peers = "all";  // all, none, or names with commas
  unsigned threads = 1;
  int repeat = 5;       // number of frames whose times count
  double limit_s = 60;  // a contestant whose cold frame takes longer is not repeated
};

struct PoseBenchRow : TimedRow {
  double cpu_ms = 0;  // median processor time of a frame
  // Sums over all frames. lacking: pairs that only row 0 found. beyond: pairs that row 0 did not
  // find.
  std::uint64_t pairs = 0, lacking = 0, beyond = 0;
};

struct PoseBenchResult {
  std::vector<PoseBenchRow> rows;  // in order: a new call for each frame, the Collider, the peers
  LeftOut left_out;
  std::optional<std::size_t> fastest_peer;  // index into rows
};

/// Times frames, in each of which the first object turns a little. Each contestant finds the
/// colliding pairs of different objects. Throws Error naming the option if a peer is unknown or
/// `repeat` is below 1. Throws as Collider::find() does.
PoseBenchResult bench_poses(const Scene& scene, const PoseBenchOptions& options,
                            const Progress& progress = {});

/// Returns a text about the first of farcull's rows that differs from row 0; empty if none differs.
std::string disagreement_of(const PoseBenchResult& result);

nlohmann::ordered_json to_json(const Scene& scene, const PoseBenchOptions& options,
                               const PoseBenchResult& result);
std::string pose_bench_table(const Scene& scene, const PoseBenchOptions& options,
                             const PoseBenchResult& result);

// ---- functions that all three benchmarks use ----

/// Reports "NAME, cold" or "NAME, 2 of 5" to `progress`.
void show_round(const Progress& progress, const std::string& name, int round, int repeats);
/// Writes the times of row i. Makes the row the fastest peer if the row is a peer, `counts` is
/// true, and the row's median is the least so far.
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
// Texts for the cells of a table. time_cells() gives the first cells of a row.
std::string ms_text(double ms);
std::string mib_text(const TimedRow& row);
std::vector<std::string> time_cells(const TimedRow& row);
std::string ratio_text(const std::optional<double>& ratio);
/// Returns the end of a record of distances or of poses: the contestants that were left out, facts
/// of the scene, the options, the processor and the commit.
nlohmann::ordered_json bench_facts(const Scene& scene, const LeftOut& left_out,
                                   nlohmann::ordered_json options);
/// Returns the line above a table.
std::string bench_title(const Scene& scene, unsigned threads);
std::string left_out_lines(const LeftOut& left_out);

}  // namespace farcull
