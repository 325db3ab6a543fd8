// The part of a study that a process measures, where several processes share it.
#pragma once

#include <functional>
#include <string>

namespace farcull {

struct Shard {
  int index = 1, of = 1;  // 1 <= index <= of
  std::string from;       // where it was read, for people; empty: nothing was divided

  /// Every of-th point, so that each shard has its share of the cheap and the costly ones.
  bool holds(std::size_t position) const {
    return position % static_cast<std::size_t>(of) == static_cast<std::size_t>(index - 1);
  }
};

/// "K/N" with 1 <= K <= N <= 100000. Throws Error naming --shard.
Shard parse_shard(const std::string& text);

/// The shard of this process of an array job of Slurm (SLURM_ARRAY_TASK_ID, _MIN, _MAX, _COUNT;
/// steps of one from 0 or 1) or of Open MPI (OMPI_COMM_WORLD_RANK, _SIZE); the whole study where
/// neither is set. `variable` gives an environment variable or null. Throws Error naming the
/// variable where it is no number, the array has gaps, or both are set.
Shard shard_from_environment(const std::function<const char*(const char*)>& variable);

}  // namespace farcull
