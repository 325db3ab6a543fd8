// What the points of a study share in one process: the device with its shaders, the scene that was
// read last, and what truly collides in it.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "core/cull.h"
#include "experiments/frames.h"
#include "experiments/run.h"
#include "experiments/studies/study.h"

namespace farcull {

/// What collides in a scene by exact predicates on every pair whose boxes meet (verify/exact.h).
struct Truth {
  std::vector<TrianglePair> pairs;  // colliding, neighbours among them; sorted
  std::uint64_t triangles = 0;      // that are in one of them
  double ms = 0;                    // that finding them took
};

/// The triangles that are in a pair, each once, ascending.
std::vector<std::uint32_t> members_of(const std::vector<TrianglePair>& pairs);

/// How an answer differs from the truth. All pairs count, neighbours among them.
struct Errors {
  std::uint64_t missed = 0;            // colliding pairs that it lacks
  std::uint64_t missed_triangles = 0;  // colliding triangles that are in none of its pairs
  std::uint64_t wrong = 0;             // its pairs that do not collide
};
/// pairs: sorted.
Errors errors_of(const Truth& truth, const std::vector<TrianglePair>& pairs);

/// What one of several runs of the same point gave, without times.
struct Outcome {
  std::vector<TrianglePair> pairs;
  nlohmann::ordered_json counts = nlohmann::ordered_json::object();
  std::string device;
};
/// Throws Error naming what differs, each count with both values (a miss among them), where two
/// runs of a point differ in anything: none of them then stands for the point.
void require_same(const Point& point, const Outcome& first, const Outcome& other);

class Lab {
 public:
  /// device: as --device, "" for what answers first.
  explicit Lab(std::string device, Progress progress = {});

  Session& session() { return session_; }
  const std::string& device() const { return device_; }
  const Progress& progress() const { return progress_; }

  /// The scene of that name, read once while no other is asked for. frame < 0: without frames; else
  /// the frame of a motion that has `frames` of them; the same name with another number of frames
  /// is another scene.
  const Scene& scene(const std::string& name, long frame = -1, long frames = 0);
  /// A scene that `make` gives, kept under the name as those above.
  const Scene& scene(const std::string& name, const std::function<Scene()>& make);
  /// The scene that was asked for last, and what collides in it. Precondition: one was.
  const Scene& current() const;
  const Truth& truth();

 private:
  std::string device_;
  Progress progress_;
  Session session_;
  std::string name_;
  long frame_ = -1;
  long frames_ = 0;  // 0: without frames
  std::optional<FrameSource> source_;
  Scene scene_;
  const Scene* current_ = nullptr;
  std::optional<Truth> truth_;
};

/// The options of a run at the point, without the accounting, which errors_of() does without.
/// Throws Error as the parsers of run_options.h do.
RunOptions options_of(const Point& point, const Lab& lab);

/// Runs the point's method on the scene that the lab holds, once, or `repeat` times with the median
/// time. What a run is given does not depend on what the lab ran before: far-pairs has its device
/// open, and i-collide starts without lists. Only at a point with a frame it keeps the lists of the
/// frame before, which is I-COLLIDE's point; a second run of the same frame would find them sorted,
/// so `repeat` is 1 there (std::logic_error otherwise). Throws Error as run_scene() and
/// require_same() do. counts: colliding, missed, of these missed_penetrating (verify/contact.h; the
/// rest touches), missed_triangles, colliding_triangles (of the truth), candidates, kept_triangles,
/// kept_objects, object_triangles (of i-collide), triangles, objects, queries, draws,
/// queries_saved, draws_saved, radius_px, pixel_size (both of the view with the widest budget; of
/// methods that draw), promises, scene_hash. times: cull, exact, total (their sum), setup; with
/// several runs total_min and total_max. record: where the run with the median time goes; may be
/// null.
Measurement measure_run(const Point& point, Lab& lab, int repeat = 1, RunRecord* record = nullptr);

}  // namespace farcull
