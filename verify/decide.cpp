// decide(): the candidates in blocks, which the threads take in turn. A filter in doubles answers
// for most pairs, exact arithmetic for the rest.
#include <algorithm>
#include <atomic>
#include <bit>
#include <stdexcept>

#include "core/base/floating_point.h"
#include "core/base/parallel.h"
#include "verify/exact.h"
#include "verify/within.h"

namespace farcull {
namespace {

using Corners = std::array<Vec3, 3>;

/// Corners of two triangles at equal positions: bit 3 i + j for corner i of a and j of b. Equal
/// indices need no look at the positions.
unsigned equal_corners(const std::array<std::uint32_t, 3>& a_index, const Corners& a,
                       const std::array<std::uint32_t, 3>& b_index, const Corners& b) {
  unsigned equal = 0;
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) {
      if (a_index[i] == b_index[j] ||
          (a[i].x() == b[j].x() && a[i].y() == b[j].y() && a[i].z() == b[j].z())) {
        equal |= 1u << (3 * i + j);
      }
    }
  }
  return equal;
}

/// Neighbours decided without exact arithmetic, where that can be.
Triage filter_neighbours(unsigned equal, const Corners& a, const Corners& b) {
  const auto lowest = [](unsigned bits) { return std::countr_zero(bits); };
  const int i = lowest(equal) / 3;
  const int j = lowest(equal) % 3;
  const unsigned rest = equal & (equal - 1);
  if (rest == 0) {
    return filter_beyond_vertex(a[i], a[(i + 1) % 3], a[(i + 2) % 3], b[(j + 1) % 3],
                                b[(j + 2) % 3]);
  }
  const int k = lowest(rest) / 3;
  const int l = lowest(rest) % 3;
  // Else more than an edge is shared, or a corner stands twice in a triangle.
  if ((rest & (rest - 1)) != 0 || i == k || j == l) return Triage::unknown;
  return filter_beyond_edge(a[i], a[k], a[3 - i - k], b[3 - j - l]);
}

// Pairs whose second corners are fetched ahead; the first ones are mostly those of the pair before.
constexpr std::size_t kAhead = 8;

/// A triangle with its corners at hand.
struct Gathered {
  std::uint32_t triangle;
  Corners corners;

  Gathered(const Scene& scene, std::uint32_t t) { gather(scene, t); }
  void gather(const Scene& scene, std::uint32_t t) {
    triangle = t;
    const auto& [i, j, k] = scene.triangles[t];
    corners = {scene.vertices[i], scene.vertices[j], scene.vertices[k]};
  }
};

PairAnswer answer(const Scene& scene, const Gathered& a, const Gathered& b, bool one_object,
                  const ExactQuestion& question) {
  if (one_object) {
    const unsigned equal = equal_corners(scene.triangles[a.triangle], a.corners,
                                         scene.triangles[b.triangle], b.corners);
    if (equal != 0) {
      if (!question.neighbours) return PairAnswer::neighbours_unasked;
      const Triage triage = filter_neighbours(equal, a.corners, b.corners);
      const bool beyond = triage == Triage::unknown ? intersects_beyond_shared(a.corners, b.corners)
                                                    : triage == Triage::yes;
      return beyond ? PairAnswer::neighbours_colliding : PairAnswer::neighbours_apart;
    }
  }
  return is_within(a.corners, b.corners, question.clearance) ? PairAnswer::colliding
                                                             : PairAnswer::apart;
}

/// Says whether both triangles of a pair are of one object; fast where the first members mostly
/// ascend.
class SameObject {
 public:
  explicit SameObject(const Scene& scene) : objects_(scene.objects) {}

  bool operator()(const TrianglePair& pair) {
    if (pair.a < first_ || pair.a >= end_) {
      const auto after = std::upper_bound(
          objects_.begin(), objects_.end(), pair.a,
          [](std::uint32_t t, const Object& object) { return t < object.first_triangle; });
      // The last one that starts at or before a; empty ones that start there come earlier.
      first_ = std::prev(after)->first_triangle;
      end_ = std::uint64_t{first_} + std::prev(after)->triangle_count;
    }
    return pair.b >= first_ && pair.b < end_;
  }

 private:
  const std::vector<Object>& objects_;
  std::uint32_t first_ = 0;
  std::uint64_t end_ = 0;
};

void require_pairs(const Scene& scene, std::span<const TrianglePair> candidates) {
  for (const TrianglePair& pair : candidates) {
    if (std::max(pair.a, pair.b) >= scene.triangles.size()) {
      throw std::logic_error("decide: a candidate names a triangle that the scene lacks");
    }
    if (pair.a == pair.b) throw std::logic_error("decide: a candidate of one triangle");
  }
}

}  // namespace

Collisions decide(const Scene& scene, std::span<const TrianglePair> candidates,
                  const ExactQuestion& question) {
  const FloatingPointGuard guard;
  require_clearance("decide", question.clearance);
  require_pairs(scene, candidates);
  // Enough work for each turn to pay for the shared counter, little enough to balance.
  constexpr std::size_t kBlock = 1024;
  std::vector<PairAnswer> answers(candidates.size(), PairAnswer::undecided);
  std::atomic<std::size_t> next = 0;
  const auto work = [&](std::size_t, std::size_t, std::size_t) {
    SameObject same_object(scene);
    for (;;) {
      const std::size_t begin = next.fetch_add(kBlock);
      if (begin >= candidates.size()) return;
      const std::size_t end = std::min(begin + kBlock, candidates.size());
      Gathered a(scene, candidates[begin].a);
      Gathered b(scene, candidates[begin].b);
      for (std::size_t i = begin; i < end; ++i) {
        const TrianglePair& pair = candidates[i];
        prefetch(scene, candidates[std::min(i + kAhead, end - 1)].b);
        if (pair.a != a.triangle) a.gather(scene, pair.a);  // mostly as before, in sorted lists
        b.gather(scene, pair.b);
        answers[i] = answer(scene, a, b, same_object(pair), question);
      }
    }
  };
  const std::size_t blocks = (candidates.size() + kBlock - 1) / kBlock;
  const std::size_t threads =
      std::clamp<std::size_t>(question.threads, 1, std::max<std::size_t>(blocks, 1));
  for_chunks(threads, threads, work);

  return count_answers(candidates, answers);
}

}  // namespace farcull
