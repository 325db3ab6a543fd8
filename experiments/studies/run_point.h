// Measuring at a point of a study: runs of methods and libraries, the lemma experiment
// (experiments/lemma/lemma.h), potential neighbours and distances, fragments, and patches that are
// placed at random.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "core/scene/scene.h"
#include "experiments/measure/harness.h"
#include "experiments/method/run.h"
#include "experiments/peers/peer.h"
#include "experiments/studies/counts.h"
#include "experiments/studies/point.h"

namespace farcull {

/// Makes the scene of the point the lab's current one. Throws Error as load_scene() and FrameSource
/// do.
const Scene& open_scene(const PointScene& scene, Lab& lab);

/// The least resolution at which the triangles of the scene that can take part cover `pixels` on
/// average, over them and the views x, y, z: the area of their image in pixels. 0 where they have
/// no area.
SizeCounts size_for(const Scene& scene, double pixels);

/// Beyond this a resolution that the size of triangles asks for is left out.
constexpr int kMostSizedResolution = 8192;

/// The options of a run at the point, without the accounting: errors_of() compares with the truth.
RunOptions options_of(const RunPoint& point, const Lab& lab);

/// The name of the device that answered: PointResult::device.
std::string answered(const Record& record);

/// Opens the scene and runs the point's method on it `repeat` times; the run with the median time
/// counts. A run does not depend on what the lab ran before: far-pairs has its device open, and
/// i-collide starts without lists. Only on a MotionFrame it keeps the lists of the frame before,
/// which is I-COLLIDE's point; a second run of the same frame would find them sorted, so `repeat`
/// is 1 there (std::logic_error otherwise). Throws Error as run() and require_same() do. The
/// counts are RunCounts without `fragments`. record: where the run with the median time goes; may
/// be null.
PointResult measure_run(const RunPoint& point, Lab& lab, Record* record = nullptr);
/// The same without the record, of a point that is a RunPoint.
inline PointResult measure_run_point(const Point& point, Lab& lab) {
  return measure_run(std::get<RunPoint>(point), lab);
}

/// Opens the scene and runs the library on it, `repeat` times on so many threads; the run with the
/// median time counts. Pairs of neighbours count neither as missed nor as wrong, since libraries
/// leave them out. Left out where this build is without the library or it refuses the scene. Throws
/// std::logic_error where there is no such peer, and Error as require_same() does.
PointResult measure_peer(const PeerPoint& point, Lab& lab, unsigned threads);

/// The library of a PeerPoint with its version; empty where this build is without it, and for all
/// other points (Study::library).
std::string library_of_peer(const Point& point);

/// One of several runs of the same point, without times.
struct Outcome {
  std::vector<TrianglePair> pairs;  // sorted
  Counts counts = {};
  std::string device;
};
/// Throws Error naming what differs, each count with both values (a miss among them), where two
/// runs of a point differ in anything: none of them then stands for the point.
void require_same(const PointKey& point, const Outcome& first, const Outcome& other);
/// The outcome of the first of `repeat` runs, to which all others have to be equal, and the times
/// of all in ms. run: gives an outcome and its time.
std::pair<Outcome, std::vector<double>> repeat_point(
    const Point& point, int repeat, const std::function<std::pair<Outcome, double>()>& run);
/// The least and the largest of several times, and all of them.
void add_extremes(PointTimes& times, const std::vector<double>& ms);

/// Runs the generator of the point. Left out where the window is larger than the device can draw.
/// The counts are LemmaCounts. Throws Error for faults of the device.
PointResult measure_lemma(const LemmaPoint& point, Lab& lab);

// Potential neighbours and distances of the study "proximity". The exact answers of a scene are
// those of `farcull distance`, and count only where the accounting (verify/distance_accounting.h),
// which shares no code with the search, has decided every pair of triangles and found none that is
// nearer.

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

/// One drawing of every triangle that takes part, in each view of a run of FAR.
struct Fragments {
  std::uint64_t covered = 0;   // pixel centres in the closed proxies: what the fragment program is
                               // run for
  std::uint64_t solid = 0;     // of them, those whose line along the depth meets the solid: what is
                               // stored or asked
  std::uint64_t elements = 0;  // proxies drawn
};

/// Counts on the CPU, from the record's views and radii and the function that the shaders run
/// (SolidProgram::interval), so that the count depends on the device through its budget alone. The
/// rasterizer's snapping of corners is left out: a pixel centre within a snap of a proxy's edge may
/// be counted otherwise than it is drawn. offset: obb or exact, by itself, whatever a run tries
/// before it. Precondition: record is of `far` with fragment depth on this scene.
Fragments count_fragments(const Scene& scene, const Record& record, const std::string& offset);

// How often FAR misses a pair at a radius: many small patches of triangles, placed into each other
// at random. A patch is a few neighbouring triangles of a built-in scene, scaled and turned at
// random. A scene holds thousands of placements, far enough from each other that in each of the
// views x, y and z every placement has pixels of its own, so that one run of FAR decides them all.

constexpr std::uint32_t kPatchTriangles = 8;

/// Placements in one scene: two objects, the first and the second patch of each placement in the
/// order of the placements, kPatchTriangles triangles each. A unit is about a pixel.
struct PlacedPatches {
  Scene scene;
  std::uint64_t placements = 0;
};

/// Cuts patches from the first two objects of a scene, which has two or more.
class PatchSource {
 public:
  explicit PatchSource(Scene from);

  /// As many placements as a window of that many pixels holds, at least one and at most `most`,
  /// drawn with this seed. grazing, side: as in PlacementPoint. Throws std::logic_error where none
  /// fits.
  PlacedPatches place(bool grazing, double side, int resolution, std::uint64_t most,
                      std::uint64_t seed) const;

 private:
  Scene from_;
  std::array<std::vector<std::vector<std::uint32_t>>, 2> around_;  // of each object: triangles by
                                                                   // vertex of the scene
};

/// The seed of a window of a point: the same for every radius and number of subpixel bits, which so
/// look at the same placements; another one for another size of triangles, resolution, kind of
/// contact or window, so that rows which differ in these can be added up.
std::uint64_t placement_seed(const PlacementPoint& point, std::uint64_t window);

/// px; the longest segment in which two triangles meet, in double; 0 where it finds none.
double intersection_length(const std::array<Vec3, 3>& a, const std::array<Vec3, 3>& b);

/// Runs FAR with oriented boxes and fragment depth in the views x, y, z on scene after scene, until
/// all placements of the point are placed, on the native canvas. With subpixel bits the corners of
/// proxies are snapped to multiples of 2^-bits px before they are drawn, as devices do. Which pairs
/// collide, exact predicates say. The counts are PlacementCounts.
PointResult measure_placements(const PlacementPoint& point, Lab& lab);

}  // namespace farcull
