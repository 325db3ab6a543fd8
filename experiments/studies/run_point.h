// Measuring a method or a library at a point of a study.
#pragma once

#include <string>
#include <vector>

#include "experiments/measure/lab.h"
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

/// What answered: PointResult::device.
std::string answered(const Record& record);

/// Opens the scene and runs the point's method on it `repeat` times; the run with the median time
/// counts. A run does not depend on what the lab ran before: far-pairs has its device open, and
/// i-collide starts without lists. Only on a MotionFrame it keeps the lists of the frame before,
/// which is I-COLLIDE's point; a second run of the same frame would find them sorted, so `repeat`
/// is 1 there (std::logic_error otherwise). Throws Error as run() and require_same() do. The
/// counts are RunCounts without `fragments`. record: where the run with the median time goes; may
/// be null.
PointResult measure_run(const RunPoint& point, Lab& lab, Record* record = nullptr);

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

}  // namespace farcull
