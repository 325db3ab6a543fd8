// Where the objects of a scene can meet, by boxes alone: of objects, and of runs of their
// triangles.
#pragma once

#include <cstdint>
#include <vector>

#include "core/pairs/run_pairs.h"
#include "core/pairs/runs.h"
#include "core/scene/scene.h"

namespace farcull {

/// Where the objects of a scene can meet.
struct PairRegions {
  std::vector<Box>
      objects;  // per object: contains all its points that can belong to a pair; empty: none
  Box reach = Box::empty();              // of all their triangles, grown by the clearance
  std::uint64_t pairs = 0;               // of objects whose boxes overlap (grown by the clearance)
  std::uint64_t self = 0;                // objects that collide with themselves
  std::vector<std::uint32_t> triangles;  // ascending: contains those that can meet anything
};
/// full: every object can meet anything, anywhere. threads: 0 for as many as there are cores.
PairRegions pair_regions(const Scene& scene, double clearance, bool full = false,
                         unsigned threads = 0);

/// Pairs of runs whose boxes overlap. Two triangles that are at most the clearance apart have grown
/// boxes with a common point, which lies in the boxes of their runs: so their runs are a pair here,
/// or their objects are left to views.
struct RunMeetings {
  std::vector<Run> runs;
  std::vector<std::uint32_t> order;  // as in Runs
  Vec3 origin = Vec3::Zero();
  std::vector<RunPair> between;  // of different objects
  std::vector<RunPair> inside;   // of one object that collides with itself; a <= b
  std::uint64_t meetings = 0;    // of two objects, or of one with itself, that these decide
  std::uint64_t triangles = 0;   // of all runs in a pair
  bool empty() const { return meetings == 0; }
};

/// What boxes say about a scene: pairs of runs for the meetings that are cheapest so, and the
/// regions of all others.
struct PairParts {
  RunMeetings runs;
  PairRegions rest;
  std::vector<TrianglePair> sample = {};  // of the others: some pairs whose boxes overlap
};
/// Objects of which boxes of runs overlap at most kPairsPerRun times for each run that overlaps any
/// are decided by runs: where boxes are compact, no view is as cheap. None is where a sample shows
/// more than kOverlapsPerTriangle pairs of boxes for each triangle, neighbours apart, since a view
/// then takes many away. all: nothing is left to views. threads: 0 for as many as there are cores.
PairParts split_meetings(const Scene& scene, double clearance, unsigned threads = 0,
                         bool all = false);
constexpr std::size_t kPairsPerRun = 32;
constexpr std::size_t kOverlapsPerTriangle = 16;

/// The pairs a < b of triangles of the runs whose boxes overlap, sorted, each once. neighbours:
/// false leaves out pairs of one object that share a vertex index.
std::vector<TrianglePair> pairs_of_runs(const Scene& scene, const RunMeetings& meetings,
                                        double clearance, bool neighbours, unsigned threads);

}  // namespace farcull
