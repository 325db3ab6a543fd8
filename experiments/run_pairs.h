// FAR pairs as a method of farcull run.
#pragma once

#include <chrono>
#include <vector>

#include "experiments/run.h"

namespace farcull {

/// Wall clock since it was made.
class Clock {
 public:
  double ms() const {
    return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start_)
        .count();
  }

 private:
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

/// How many objects own the triangles (ascending).
std::uint64_t count_objects(const Scene& scene, const std::vector<std::uint32_t>& triangles);

/// Fills the record from the candidates to the exact pairs. Throws Error for any fault of the
/// device.
void run_far_pairs(const Scene& scene, Session& session, const Progress& progress,
                   RunRecord& record);

}  // namespace farcull
