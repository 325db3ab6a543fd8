// Points of the study "proximity": what a method leaves as potential neighbours, and the distances
// of farcull and of libraries, both against exact answers.
//
// The exact answers of a scene are those of `farcull distance`, and count only where the accounting
// (verify/distance_accounting.h), which shares no code with the search, has decided every pair of
// triangles and found none that is nearer.
#pragma once

#include <string>

#include "experiments/measure/lab.h"
#include "experiments/studies/counts.h"
#include "experiments/studies/point.h"

namespace farcull {

/// Runs the method `repeat` times on one thread; the run with the median time counts. The counts
/// are SetCounts. Left out where the diagram would keep too many pairs. Throws Error where the
/// accounting refutes the exact answers, and where two runs differ.
PointResult measure_neighbours(const NeighbourPoint& point, Lab& lab);

/// The same for the contestant of the point. The counts are DistanceCounts. Left out where this
/// build is without the library or it refuses the scene. Throws std::logic_error where there is no
/// such contestant.
PointResult measure_distances(const DistancePoint& point, Lab& lab);
/// The same for this one, whatever its name is.
PointResult measure_distances(const DistancePoint& point, const DistancePeer& contestant, Lab& lab);

/// "farcull" and the peers, those among them that this build is without.
std::vector<DistancePeer> distance_contestants();
/// Study::library: that of a DistancePoint.
std::string library_of_distances(const Point& point);

}  // namespace farcull
