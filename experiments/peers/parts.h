// Common parts of the peers: which triangles are tested with which, and the exact decision of
// candidates.
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <mutex>
#include <vector>

#include "core/base/parallel.h"
#include "core/base/stopwatch.h"
#include "core/scene/scene.h"
#include "experiments/peers/peer.h"

namespace farcull {

/// Neighbours by index. (Those by position alone are left to the exact decision.)
inline bool share_vertex(const Scene& scene, std::uint32_t a, std::uint32_t b) {
  for (const std::uint32_t v : scene.triangles[a]) {
    for (const std::uint32_t w : scene.triangles[b]) {
      if (v == w) return true;
    }
  }
  return false;
}

/// A scene as a peer prepares it, in its own time: the boxes of the triangles, and which of them
/// are tested with which.
struct PeerScene {
  /// Without boxes where the peer has others.
  explicit PeerScene(const Scene& scene, bool with_boxes = true);

  const Scene& scene;
  std::vector<Box> boxes;            // per triangle
  std::vector<std::uint32_t> owner;  // per triangle
  bool two_sides = false;            // exactly two objects have triangles, and neither is self
  std::uint32_t second = 0;          // the first triangle of the second of them; else 0

  /// Whether a pair of these triangles counts; neighbours by index do not.
  bool counts(std::uint32_t a, std::uint32_t b) const {
    return owner[a] != owner[b] || (scene.objects[owner[a]].self && !share_vertex(scene, a, b));
  }
  /// Whether there can be a pair at all.
  bool has_pairs() const;
};

/// Takes candidates from one thread or several and decides them, in parts while they come, the rest
/// on all threads at the end.
class PeerCandidates {
 public:
  /// `parallel`: candidates come from several threads, and each decides its own full parts. Else
  /// they come from one, and full parts are decided on all threads.
  PeerCandidates(const Scene& scene, unsigned threads, bool parallel);
  ~PeerCandidates();

  /// The part of the calling thread; valid until finish(). A call of add() on it is not locked.
  class Part {
   public:
    void add(std::uint32_t a, std::uint32_t b) {
      pending_.push_back(a < b ? TrianglePair{a, b} : TrianglePair{b, a});
      if (pending_.size() == kFull) decide(all_.parallel_ ? 1 : all_.threads_);
    }

   private:
    friend class PeerCandidates;
    explicit Part(const PeerCandidates& all) : all_(all) {}
    void decide(unsigned threads);

    const PeerCandidates& all_;
    std::vector<TrianglePair> pending_;
    std::vector<TrianglePair> pairs_;
    std::uint64_t decided_ = 0;
    double exact_ms_ = 0;
  };
  Part& part();

  /// The answer, without build_ms; candidates_ms is the time since construction less exact_ms.
  BenchAnswer finish();

 private:
  static constexpr std::size_t kFull = std::size_t{1} << 17;  // 1 MiB of candidates
  const Scene& scene_;
  const unsigned threads_;
  const bool parallel_;
  const std::uint64_t id_;  // no two collectors of a process have the same
  const Stopwatch since_;
  std::mutex mutex_;  // of parts_
  std::vector<std::unique_ptr<Part>> parts_;
};

/// Calls work(i) for 0 .. count - 1 on `threads` threads; a thread that is free takes the next
/// `block`.
template <class Work>
void for_each_taken(std::size_t count, std::size_t block, unsigned threads, const Work& work) {
  std::atomic<std::size_t> next = 0;
  for_chunks(threads, threads, [&](std::size_t, std::size_t, std::size_t) {
    for (std::size_t begin; (begin = next.fetch_add(block)) < count;) {
      for (std::size_t i = begin; i < std::min(begin + block, count); ++i) work(i);
    }
  });
}

}  // namespace farcull
