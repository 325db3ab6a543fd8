// FAR pairs as a method of farcull run.
#pragma once

#include <vector>

#include "core/stopwatch.h"
#include "experiments/run.h"

namespace farcull {

/// How many objects own the triangles (ascending).
std::uint64_t count_objects(const Scene& scene, const std::vector<std::uint32_t>& triangles);

/// Fills the record up to the candidates. Throws Error for any fault of the
/// device.
void run_far_pairs(const Scene& scene, Session& session, const Progress& progress,
                   RunRecord& record);

}  // namespace farcull
