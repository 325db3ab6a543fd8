// The state that measurements of one process share: the device with its shaders, the scene that was
// read last, and the pairs that truly collide in it.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "core/cull/cull.h"
#include "experiments/method/run.h"
#include "experiments/scenes/frames.h"

namespace farcull {

/// The colliding pairs of a scene, by exact predicates on every pair whose boxes meet
/// (verify/exact.h).
struct Truth {
  std::vector<TrianglePair> pairs;  // colliding, neighbours among them; sorted
  std::uint64_t triangles = 0;      // that are in one of them
  double ms = 0;                    // that finding them took
};

/// The triangles that are in a pair, each once, ascending.
std::vector<std::uint32_t> members_of(const std::vector<TrianglePair>& pairs);

/// The truth without pairs of triangles of one object that share a vertex position, which other
/// libraries leave out.
Truth without_neighbours(const Scene& scene, const Truth& truth);

/// How an answer differs from the truth. All pairs count, neighbours among them.
struct Errors {
  std::uint64_t missed = 0;            // colliding pairs that it lacks
  std::uint64_t missed_triangles = 0;  // colliding triangles that are in none of its pairs
  std::uint64_t wrong = 0;             // its pairs that do not collide
};
/// pairs: sorted.
Errors errors_of(const Truth& truth, const std::vector<TrianglePair>& pairs);

/// How many of a are not in b; both sorted.
std::uint64_t lacking(const std::vector<TrianglePair>& a, const std::vector<TrianglePair>& b);

class Lab {
 public:
  /// device: as --device, "" for what Session chooses. threads: as in Session.
  explicit Lab(std::string device, Progress progress = {}, unsigned threads = 0);

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
  /// The notes of its motion on the frame; none of a scene without frames.
  FrameNotes notes() const { return source_ ? source_->notes() : FrameNotes{}; }

 private:
  /// Notes the name of the next scene and drops what is known of the one before.
  void begin_scene(const std::string& name, long frame, long frames);

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

}  // namespace farcull
