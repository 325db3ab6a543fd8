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

/// Makes the point's scene the current scene of `lab`, and returns it. Throws Error as load_scene()
/// and FrameSource do.
const Scene& open_scene(const PointScene& scene, MeasurementContext& lab);

/// Returns the options of a run at the point. The run has no accounting, since measure_run()
/// compares the run's answer with the exact answer.
RunOptions options_of(const RunPoint& point, const MeasurementContext& lab);

/// Returns a scene of cells, described in run_point.cpp. A cell has a few triangles. No two cells
/// share a pixel in the views x, y and z at kCellsResolution. Throws std::logic_error for an
/// unknown family.
constexpr int kCellsResolution = 512;  // px
Scene contact_cells(const ContactCells& scene);
/// True if a colliding pair of contact_cells(scene) is in a cell whose contact depends on
/// ContactCells::value.
bool varies(const TrianglePair& pair, const ContactCells& scene);

/// Returns RunCounts::left_by_boxes and RunCounts::views_used.
std::pair<std::uint64_t, std::uint64_t> mechanism_of(const Scene& scene, const Record& record);

/// Returns the device of the run, as in PointResult::device.
std::string answered(const Record& record);

/// Opens the scene and runs the point's method on it once. For a MotionFrame, I-COLLIDE starts with
/// the sorted lists of the previous frame. Other runs do not depend on earlier runs in `lab`. A
/// second run of a MotionFrame would start with the lists of the same frame, so `repeat` must be 1
/// for a MotionFrame. Throws std::logic_error otherwise, and Error as run() does. The counts are
/// RunCounts without `fragments`. record: receives the record of the run; may be null.
PointResult measure_run(const RunPoint& point, MeasurementContext& lab, Record* record = nullptr);
inline PointResult measure_run_point(const Point& point, MeasurementContext& lab) {
  return measure_run(std::get<RunPoint>(point), lab);
}

/// Runs FAR at the point twice: with 0.9 times the budget radius, and without a ball. Returns how
/// many pairs each run misses: RunCounts::at_risk and RunCounts::at_risk_bare.
std::pair<std::uint64_t, std::uint64_t> pairs_at_risk(const RunPoint& point,
                                                      MeasurementContext& lab);
/// Calls measure_run(). If FAR has a guarantee at this radius, adds the counts of pairs_at_risk().
PointResult measure_with_risk(const RunPoint& point, MeasurementContext& lab,
                              Record* record = nullptr);

/// Opens the scene and runs the library on it once on `threads` threads. Pairs of neighbours count
/// neither as missed nor as wrong, since libraries leave them out. The point is left out if this
/// build lacks the library or the library refuses the scene. Throws std::logic_error if there is no
/// such peer. pairs: receives the answer; may be null.
PointResult measure_peer(const PeerPoint& point, MeasurementContext& lab, unsigned threads,
                         std::vector<TrianglePair>* pairs = nullptr);

/// Returns the library of a PeerPoint with its version (Study::library). Returns "" if this build
/// lacks the library, or if the point is no PeerPoint.
std::string library_of_peer(const Point& point);

/// Throws Error if two runs of a point differ in more than times. The error names each difference
/// with both values.
void require_same(const PointKey& point, const PointResult& first, const PointResult& other);

/// Runs the lemma experiment of the point. The point is left out if the window is larger than the
/// device can draw. The counts are LemmaCounts. Throws Error for faults of the device.
PointResult measure_lemma(const LemmaPoint& point, MeasurementContext& lab);

// The next functions measure potential neighbours and distances for the study "proximity". The
// exact answers of a scene are those of `farcull distance`. They are used only after the accounting
// (verify/distance_accounting.h) decided every pair of triangles and found no nearer pair. The
// accounting shares no code with the search.

/// Runs the method once on one thread. The counts are SetCounts. The point is left out if the
/// diagram would keep too many pairs. Throws Error if the accounting refutes the exact answers.
PointResult measure_neighbours(const NeighbourPoint& point, MeasurementContext& lab);

/// Computes the distances once with the point's contestant, on one thread. The counts are
/// DistanceCounts. The point is left out if this build lacks the library or the library refuses the
/// scene. Throws std::logic_error if there is no such contestant.
PointResult measure_distances(const DistancePoint& point, MeasurementContext& lab);
/// Does the same with `contestant` in place of the contestant that the point names.
PointResult measure_distances(const DistancePoint& point, const DistancePeer& contestant,
                              MeasurementContext& lab);

/// Returns "farcull" and all peers, including those that this build lacks.
std::vector<DistancePeer> distance_contestants();
/// Returns the library of a DistancePoint with its version (Study::library).
std::string library_of_distances(const Point& point);

/// Fragments of FAR if each view draws every triangle that may collide exactly once.
struct Fragments {
  std::uint64_t covered = 0;  // pixel centres in the closed proxies; each runs the fragment program
  std::uint64_t solid = 0;    // covered pixel centres whose view ray meets the solid
  std::uint64_t elements = 0;  // proxies drawn
};

/// Counts fragments on the CPU, with the record's views and radii and the function that the shaders
/// run (SolidProgram::interval). So the counts depend on the device only through its error budget.
/// Snapping of corners is ignored; it matters only for pixel centres very near a proxy's edge.
/// offset: obb or exact, the offset to count. Precondition: `record` is of a run of `far` with
/// fragment depth on this scene.
Fragments count_fragments(const Scene& scene, const Record& record, const std::string& offset);

// The next functions measure how often FAR misses a pair at a radius. A placement is two small
// patches that meet at a random place. A patch is a few neighbouring triangles of a built-in scene,
// scaled, and turned at random. A scene holds thousands of placements. No two placements share a
// pixel in the views x, y and z, so one run of FAR decides all placements.

constexpr std::uint32_t kPatchTriangles = 8;

/// The placements of one scene. The scene's first object has the first patch of each placement, and
/// the second object has the second patch, in the order of the placements. A patch has
/// kPatchTriangles triangles, and a unit is about a pixel. If PlacementPoint::pairs is set, a patch
/// is one triangle, a unit is exactly a pixel, and points at two corners fix the window.
struct PlacedPatches {
  Scene scene;
  std::uint64_t placements = 0;
};

/// Returns a stratum of `widening` times the usual width. subpixel_bits: 0 if corners are rounded
/// to floats, but not snapped.
CornerStratum corner_stratum(int widening, int subpixel_bits, int resolution);

/// Cuts patches from the first two objects of a scene.
class PatchSource {
 public:
  explicit PatchSource(Scene from);

  /// Draws placements with `seed`: as many as the point's window holds, but at most `most`. Throws
  /// std::logic_error if no placement fits.
  PlacedPatches place(const PlacementPoint& point, const CornerStratum& stratum, std::uint64_t most,
                      std::uint64_t seed) const;

 private:
  Scene from_;
  std::array<std::vector<std::vector<std::uint32_t>>, 2> around_;
};

/// Returns the seed of a window of a point. Points that differ only in radius or subpixel bits have
/// the same seed, and so the same placements. Points that differ in the size of triangles, in
/// resolution or in the kind of contact have different seeds, so that their rows can be added up.
std::uint64_t placement_seed(const PlacementPoint& point, std::uint64_t window);

/// Returns the length, in double, of the segment in which two triangles meet; 0 without a segment.
double intersection_length(const std::array<Vec3, 3>& a, const std::array<Vec3, 3>& b);

/// Runs FAR on one scene after the other until all placements of the point are done. FAR uses
/// oriented boxes, fragment depth and the views x, y, z, on the native canvas. With subpixel bits,
/// corners of proxies are snapped to multiples of 2^-bits px before drawing, as devices do. Without
/// subpixel bits, pairs are drawn on the device of the run instead. Exact predicates decide which
/// pairs collide. The counts are PlacementCounts.
PointResult measure_placements(const PlacementPoint& point, MeasurementContext& lab);

}  // namespace farcull
