// `farcull bench --poses` times frames in which an object moves as a whole: new calls of the
// library, a Collider that is given poses alone, and peers that keep models of the objects.
#pragma once

#include <cstdint>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "experiments/measure/bench.h"

namespace farcull {

struct PoseBenchOptions {
  std::string peers = "all";  // all, none, or names with commas
  unsigned threads = 1;
  int repeat = 5;       // frames that count
  double limit_s = 60;  // a contestant whose cold frame takes longer is not repeated
};

struct PoseBenchRow : TimedRow {
  double cpu_ms = 0;  // of the process, a median
  // Sums over all frames. lacking: pairs that only row 0 has; beyond: pairs that row 0 lacks.
  std::uint64_t pairs = 0, lacking = 0, beyond = 0;
};

struct PoseBenchResult {
  std::vector<PoseBenchRow> rows;  // a call with arrays; a Collider given poses alone; peers
  std::vector<std::pair<std::string, std::string>> left_out;  // name, reason
  std::optional<std::size_t> fastest_peer;                    // into rows
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

}  // namespace farcull
