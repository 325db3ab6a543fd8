// `farcull bench`: peers and our methods from the same triangles to the same pairs, in one process
// and one run.
//
// Every contestant runs once cold, when its memory is measured, and then `repeat` times, in turn
// with the others, so that a slow moment of the machine falls on all. Its setup (contexts, shaders,
// thread pools) comes before and is timed apart. All answers have to be equal.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

#include "core/cull/cull.h"
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
  BenchRun run = {};  // null where it is left out
};

struct BenchOptions {
  std::string peers = "all";    // all, none, or names with commas
  std::string methods = "all";  // the same
  unsigned threads = 1;
  int repeat = 5;
  double limit_s = 60;  // a contestant whose cold run takes longer is not repeated
  std::string device;   // "": GL where there is one; "cpu": no GL; or as for farcull run
  bool self = false;    // every object is tested against itself as well
  std::optional<std::uint64_t> seed;  // of the scene
};

struct BenchRow {
  std::string name, device;
  bool peer = false;
  std::string library;
  Spread total_ms = {};  // of the repeats; of the cold run where there are none
  double cold_ms = 0;
  double setup_ms = 0, build_ms = 0, candidates_ms = 0, exact_ms = 0;  // the last three: medians
  std::uint64_t candidate_pairs = 0, pairs = 0;
  std::optional<double> peak_mib = {};  // of the cold run, beyond what was there before it
  int repeats = 0;                      // 0: over the limit, the cold run is all there is
};

/// A pair that one contestant has and another lacks.
struct Disagreement {
  std::string has, lacks;
  TrianglePair pair;     // the first such
  bool collides = true;  // by verify/exact.h, for that pair alone
};

struct BenchResult {
  std::vector<BenchRow> rows;
  std::vector<BenchContestant> left_out;
  std::optional<Disagreement> disagreement;  // the first; no ratio means anything with it
  std::optional<std::size_t> fastest_peer;   // into rows
};

/// Throws Error naming the option for names that are none, a repeat below 1 or a limit below 0.
void validate(const BenchOptions& options);

/// Our methods and the peers that the options name, set up. Ours: far-pairs on the CPU and, as far
/// as there is a device, on GL; far; exact. Throws Error for one that was asked for by name and
/// cannot run at all in this build or on this machine.
std::vector<BenchContestant> contestants(const Scene& scene, const BenchOptions& options,
                                         const Progress& progress = {});

BenchResult bench(const Scene& scene, const std::vector<BenchContestant>& contestants,
                  const BenchOptions& options, const Progress& progress = {});

/// The median of a row over that of the fastest peer; empty without a peer.
std::optional<double> ratio_to_fastest(const BenchResult& result, const BenchRow& row);

/// In words, with the answer of the exact predicates for the pair.
std::string describe(const Scene& scene, const Disagreement& disagreement);

nlohmann::ordered_json to_json(const Scene& scene, const BenchOptions& options,
                               const BenchResult& result);
std::string bench_table(const Scene& scene, const BenchOptions& options, const BenchResult& result);

}  // namespace farcull
