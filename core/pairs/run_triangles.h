// The pairs of triangles that pairs of runs give.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "core/pairs/run_pairs.h"
#include "core/pairs/runs.h"
#include "core/scene/scene.h"

namespace farcull {

/// Pairs of runs whose boxes overlap. Two triangles that are at most the clearance apart have grown
/// boxes with a common point, which lies in the boxes of their runs: so their runs are a pair here,
/// or their objects are left to views.
struct RunMeetings {
  std::shared_ptr<const Runs> of;
  std::vector<RunPair> between;    // of different objects
  std::vector<RunPair> inside;     // of one object that collides with itself; a <= b
  std::vector<TrianglePair> kept;  // pairs of the frame before that are right in this one too
  std::uint64_t overlaps = 0;      // pairs of runs whose boxes overlap, also those of which nothing
                                   // moved, which stand in no list
  std::uint64_t meetings = 0;      // of two objects, or of one with itself, that these decide
  std::uint64_t triangles = 0;     // of all runs in a pair
  bool empty() const { return meetings == 0; }
};

/// The runs of some pairs, ascending. runs: of the scene.
std::vector<std::uint32_t> runs_of(std::span<const RunPair> between,
                                   std::span<const RunPair> inside, std::size_t runs);

/// The pairs of triangles whose boxes overlap, sorted, each once, of some pairs of runs of the
/// scene: between objects, and inside one. neighbours: as pairs_of_runs().
std::vector<TrianglePair> pairs_of_some(const Scene& scene, const RunMeetings& meetings,
                                        std::span<const RunPair> between,
                                        std::span<const RunPair> inside, double clearance,
                                        bool neighbours, unsigned threads);

/// The pairs a < b of triangles of the runs whose boxes overlap, sorted, each once, with those that
/// were kept. neighbours: false leaves out pairs of one object that share a vertex index.
std::vector<TrianglePair> pairs_of_runs(const Scene& scene, const RunMeetings& meetings,
                                        double clearance, bool neighbours, unsigned threads);

}  // namespace farcull
