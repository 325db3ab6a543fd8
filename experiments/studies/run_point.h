// Measures a point of a study: runs methods and libraries, the lemma experiment
// (experiments/lemma/lemma.h), potential neighbours and distances, fragments, and randomly placed
// patches.
#pragma once

#include <array>
#include <string>
#include <utility>
#include <vector>

#include "experiments/studies/study.h"

namespace farcull {

/// Makes the scene of the point the current one of `lab`. Throws Error as load_scene() and
/// FrameSource do.
const Scene& open_scene(const PointScene& scene, MeasurementContext& lab);

/// The options of a run at the point. No accounting, since the run is compared with the truth.
RunOptions options_of(const RunPoint& point, const MeasurementContext& lab);

/// Pairs of triangles in cells, each with pixels of its own in the views x, y and z at
/// kCellsResolution (run_point.cpp has the cells). Throws std::logic_error for an unknown family.
constexpr int kCellsResolution = 512;  // px
Scene contact_cells(const ContactCells& scene);
/// Whether a pair of this scene that collides is in a cell where the contact varies with the
/// number.
bool varies(const TrianglePair& pair, const ContactCells& scene);

/// How many triangles boxes left, and how many views were drawn: RunCounts::left_by_boxes and
/// views_used.
std::pair<std::uint64_t, std::uint64_t> mechanism_of(const Scene& scene, const Record& record);

/// The name of the device that answered: PointResult::device.
std::string answered(const Record& record);

/// Opens the scene and runs the point's method on it once. A run does not depend on earlier ones in
/// `lab`: i-collide starts without sorted lists. On a MotionFrame, however, i-collide keeps the
/// lists of the previous frame, as it is meant to. A second run of that frame would find them
/// sorted, so `repeat` must be 1 there (else std::logic_error). Throws Error as run() does. The
/// counts are RunCounts without `fragments`. record: receives the run; may be null.
PointResult measure_run(const RunPoint& point, MeasurementContext& lab, Record* record = nullptr);
/// The same for a Point that is a RunPoint, without the record.
inline PointResult measure_run_point(const Point& point, MeasurementContext& lab) {
  return measure_run(std::get<RunPoint>(point), lab);
}

/// The pairs that FAR misses at the point with 0.9 of its radius, and without a ball:
/// RunCounts::at_risk and at_risk_bare. Runs FAR twice.
std::pair<std::uint64_t, std::uint64_t> pairs_at_risk(const RunPoint& point,
                                                      MeasurementContext& lab);
/// measure_run(); for FAR at a radius with a guarantee, also the pairs at risk.
PointResult measure_with_risk(const RunPoint& point, MeasurementContext& lab,
                              Record* record = nullptr);

/// Opens the scene and runs the library on it once on `threads` threads. Pairs of neighbours count
/// neither as missed nor as wrong, since libraries leave them out. Left out if this build lacks the
/// library or the library refuses the scene. Throws std::logic_error if there is no such peer.
/// pairs: receives the answer; may be null.
PointResult measure_peer(const PeerPoint& point, MeasurementContext& lab, unsigned threads,
                         std::vector<TrianglePair>* pairs = nullptr);

/// The library of a PeerPoint with its version; empty if this build lacks it, and for all other
/// points (Study::library).
std::string library_of_peer(const Point& point);

/// Throws Error if two runs of a point differ in anything but times: neither of them can then stand
/// for the point. The error names each difference with both values.
void require_same(const PointKey& point, const PointResult& first, const PointResult& other);

/// Runs the generator of the point. Left out if the window is larger than the device can draw. The
/// counts are LemmaCounts. Throws Error for faults of the device.
PointResult measure_lemma(const LemmaPoint& point, MeasurementContext& lab);

// Potential neighbours and distances of the study "proximity". The exact answers of a scene are
// those of `farcull distance`. They count only if the accounting (verify/distance_accounting.h),
// which shares no code with the search, has decided every pair of triangles and found no nearer
// one.

/// Runs the method once on one thread. The counts are SetCounts. Left out if the diagram would keep
/// too many pairs. Throws Error if the accounting refutes the exact answers.
PointResult measure_neighbours(const NeighbourPoint& point, MeasurementContext& lab);

/// Asks the point's contestant once for the distances, on one thread. The counts are
/// DistanceCounts. Left out if this build lacks the library or the library refuses the scene.
/// Throws std::logic_error if there is no such contestant.
PointResult measure_distances(const DistancePoint& point, MeasurementContext& lab);
/// The same for the given contestant, whatever its name.
PointResult measure_distances(const DistancePoint& point, const DistancePeer& contestant,
                              MeasurementContext& lab);

/// "farcull" and all peers, including those that this build lacks.
std::vector<DistancePeer> distance_contestants();
/// The library of a DistancePoint with its version (Study::library).
std::string library_of_distances(const Point& point);

/// Counts for one drawing of every triangle that takes part, in each view of a run of FAR.
struct Fragments {
  std::uint64_t covered = 0;  // pixel centres in the closed proxies; each runs the fragment program
  std::uint64_t solid = 0;    // those pixel centres whose line along the depth meets the solid, so
                              // that it is stored or queried
  std::uint64_t elements = 0;  // proxies drawn
};

/// Counts on the CPU, from the record's views and radii and the function that the shaders run
/// (SolidProgram::interval), so that the count depends on the device only through its budget. It
/// ignores that a rasterizer snaps corners, which matters only for pixel centres very near a
/// proxy's edge. offset: obb or exact; only this one is counted, even if a run tries another one
/// first. Precondition: record is of `far` with fragment depth on this scene.
Fragments count_fragments(const Scene& scene, const Record& record, const std::string& offset);

// Measures how often FAR misses a pair at a radius, on many small patches of triangles that are
// placed into each other at random. A patch is a few neighbouring triangles of a built-in scene,
// scaled and turned at random. A scene holds thousands of placements. In each of the views x, y and
// z every placement has pixels of its own, so that one run of FAR decides them all.

constexpr std::uint32_t kPatchTriangles = 8;

/// The placements of one scene: two objects, the first and the second patch of each placement in
/// the order of the placements, kPatchTriangles triangles each. A unit is about a pixel. Of pairs
/// each patch is one triangle, a unit is a pixel, and two points at the ends make the window.
struct PlacedPatches {
  Scene scene;
  std::uint64_t placements = 0;
};

/// widening: as in PlacementPoint. subpixel_bits: 0 if only floats round the corners.
CornerStratum corner_stratum(int widening, int subpixel_bits, int resolution);

/// Cuts patches from the first two objects of a scene.
class PatchSource {
 public:
  explicit PatchSource(Scene from);

  /// Returns as many placements as the point's window holds, at least one and at most `most`, drawn
  /// with `seed`. Throws std::logic_error if none fits.
  PlacedPatches place(const PlacementPoint& point, const CornerStratum& stratum, std::uint64_t most,
                      std::uint64_t seed) const;

 private:
  Scene from_;
  std::array<std::vector<std::vector<std::uint32_t>>, 2> around_;  // per object: its triangles by
                                                                   // vertex of the scene
};

/// The seed of a window of a point. All radii and numbers of subpixel bits share it, so they see
/// the same placements. Other sizes of triangles, resolutions, kinds of contact and windows have
/// other seeds, so that rows that differ in these can be added up.
std::uint64_t placement_seed(const PlacementPoint& point, std::uint64_t window);

/// The length of the longest segment in which two triangles meet, in double; 0 if there is none.
double intersection_length(const std::array<Vec3, 3>& a, const std::array<Vec3, 3>& b);

/// Runs FAR on scene after scene, with oriented boxes and fragment depth in the views x, y, z, on
/// the native canvas, until all placements of the point are done. With subpixel bits, corners of
/// proxies are snapped to multiples of 2^-bits px before drawing, as devices do; without, pairs are
/// drawn on the device of the run. Exact predicates decide which pairs collide. The counts are
/// PlacementCounts.
PointResult measure_placements(const PlacementPoint& point, MeasurementContext& lab);

}  // namespace farcull
