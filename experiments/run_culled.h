// The methods that cull sets of triangles: FAR and the CULLIDE family on a canvas, and I-COLLIDE's
// sweep and prune.
#pragma once

#include "experiments/run.h"

namespace farcull {

/// far, cullide, quick-cullide and s-cullide. Fills the record up to the candidates. Throws Error
/// for any fault of the device.
void run_culled(const Scene& scene, Session& session, const Progress& progress, RunRecord& record);

/// What the triangles are fattened to, in the order in which the offsets are tried.
std::vector<Fattener> fatteners_of(const RunOptions& options);

/// The level of clusters, by the options and the number of triangles that can take part.
Clusters clusters_of(const RunOptions& options, std::size_t triangles);

/// i-collide. Fills the record up to the candidates.
void run_swept(const Scene& scene, Session& session, const Progress& progress, RunRecord& record);

}  // namespace farcull
