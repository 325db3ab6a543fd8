// `farcull bench --distances`: distance queries of peers and of ours, from the same triangles to
// distances between objects, in one process and one run, and how far each is from the exact ones.
//
// As in bench.h every contestant runs once cold, when its memory is measured, and then in turn with
// the others.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

#include "core/base/progress.h"
#include "experiments/measure/harness.h"
#include "experiments/peers/distance_peers.h"

namespace farcull {

struct DistanceRecord;

struct DistanceBenchOptions {
  PeerQuestion question = {};
  std::string peers = "all";  // all, none, or names with commas
  unsigned threads = 1;
  int repeat = 5;
  double limit_s = 60;  // a contestant whose cold run takes longer is not repeated
};

/// The answers of a contestant beside ours, which are exact.
struct DistanceErrors {
  std::uint64_t answers = 0;
  std::uint64_t lacking = 0;       // distances that ours has
  std::uint64_t beyond_it = 0;     // distances that ours has not: beyond `within`
  std::uint64_t exact = 0;         // the same double
  std::uint64_t other_zero = 0;    // 0 where the objects are apart, or not 0 where they meet
  std::uint64_t other_object = 0;  // with `nearest`: another object, which is not as near
  double largest_relative = 0;     // of distances that neither calls 0
};

struct DistanceBenchRow {
  std::string name, library;
  bool peer = false;
  Spread total_ms = {};  // of the repeats; of the cold run where there are none
  double cold_ms = 0, build_ms = 0, query_ms = 0;  // the last two: medians
  std::optional<double> peak_mib = {};
  int repeats = 0;  // 0: over the limit, the cold run is all there is
  DistanceErrors errors = {};
};

struct DistanceBenchResult {
  std::vector<DistanceBenchRow> rows;                         // ours is the first
  std::vector<std::pair<std::string, std::string>> left_out;  // name, reason
  std::optional<std::size_t> fastest_peer;                    // of the comparable ones; into rows
};

/// Of different objects alone, also where the scene says that one is tested against itself. Throws
/// Error naming the option for peers that there are not, and for a repeat below 1.
DistanceBenchResult bench_distances(const Scene& scene, const DistanceBenchOptions& options,
                                    const Progress& progress = {});

/// `farcull distance` in the form of the peers: the first one of every bench.
DistancePeer farcull_distances();
/// The answers of a record of `objects`, or of `nearest` with k = 1, as a peer gives them.
std::vector<PeerDistance> as_peer(const DistanceRecord& record);

/// `answer` beside exact ones of the same question; both sorted.
DistanceErrors errors_of(DistanceTask task, const std::vector<PeerDistance>& answer,
                         const std::vector<PeerDistance>& exact);

nlohmann::ordered_json to_json(const Scene& scene, const DistanceBenchOptions& options,
                               const DistanceBenchResult& result);
std::string distance_bench_table(const Scene& scene, const DistanceBenchOptions& options,
                                 const DistanceBenchResult& result);

}  // namespace farcull
