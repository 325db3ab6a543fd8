// Which corners of a scene moved from one frame to the next.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "core/scene/scene.h"

namespace farcull {

/// Which corners moved between two frames of the same triangles and objects.
class MovedCorners {
 public:
  /// Compares the scene with that of the last call, and keeps a copy. False: there was none, or its
  /// triangles or objects were others; nothing else may be asked then.
  bool update(const Scene& scene);
  /// The next update() returns false.
  void forget() { known_ = false; }
  bool any() const { return any_; }
  bool triangle(const Scene& scene, std::uint32_t t) const {
    const auto& [p, q, r] = scene.triangles[t];
    return (moved_[p] | moved_[q] | moved_[r]) != 0;
  }

  /// Per triangle whether a corner of it did.
  std::vector<std::uint8_t> triangles(const Scene& scene) const;

 private:
  struct Part {
    std::uint32_t first, count;
    bool self;
    bool operator==(const Part&) const = default;
  };
  bool known_ = false, any_ = false;
  std::vector<Part> objects_;
  std::vector<std::array<std::uint32_t, 3>> triangles_;
  std::vector<Vec3> vertices_;
  std::vector<std::uint8_t> moved_;  // per vertex: bits changed
};

/// Whether it is worth while to compare frames: not for a while after frames in which most moved.
class BackoffCounter {
 public:
  /// To be asked once a frame.
  bool waits() { return frames_left_ > 0 && frames_left_-- > 0; }
  void notify(bool worth_while) {
    frames_left_ = worth_while ? 0 : next_;
    next_ = worth_while ? 1 : std::min(2 * next_, kMostFrames);
  }
  static constexpr int kMostFrames = 16;

 private:
  int frames_left_ = 0, next_ = 1;
};

/// Whether less than half of some of the pairs, evenly chosen, have a triangle that moved. Without
/// a pair: whether nothing moved.
bool mostly_unmoved(const Scene& scene, const MovedCorners& moved,
                    std::span<const TrianglePair> pairs);

}  // namespace farcull
