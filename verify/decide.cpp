// Implements decide(). Each thread repeatedly takes the next block of candidates. A filter in
// doubles decides most pairs, several at once on SIMD lanes. Exact arithmetic decides the others.
#include <algorithm>
#include <atomic>
#include <bit>
#include <iterator>
#include <stdexcept>
#include <utility>

#include "core/base/floating_point.h"
#include "core/base/parallel.h"
#include "verify/exact.h"
#include "verify/filter.h"
#include "verify/within.h"

namespace farcull {

std::vector<TrianglePair> Collisions::all() const {
  std::vector<TrianglePair> both;
  both.reserve(pairs.size() + neighbour_pairs.size());
  std::merge(pairs.begin(), pairs.end(), neighbour_pairs.begin(), neighbour_pairs.end(),
             std::back_inserter(both));
  return both;
}

void Collisions::append(const Collisions& next) {
  pairs.insert(pairs.end(), next.pairs.begin(), next.pairs.end());
  neighbour_pairs.insert(neighbour_pairs.end(), next.neighbour_pairs.begin(),
                         next.neighbour_pairs.end());
  neighbours += next.neighbours;
  apart += next.apart;
  neighbours_apart += next.neighbours_apart;
}

// Each class is counted by its own answers, never as the total minus the other classes. So an
// undecided candidate never counts as decided.
Collisions count_answers(std::span<const TrianglePair> candidates,
                         std::span<const PairAnswer> answers) {
  if (answers.size() != candidates.size())
    throw std::logic_error("decide: not one answer for each candidate");
  Collisions result;
  std::uint64_t unasked = 0;
  for (std::size_t i = 0; i < candidates.size(); ++i) {
    const PairAnswer answer = answers[i];
    result.apart += answer == PairAnswer::apart;
    result.neighbours_apart += answer == PairAnswer::neighbours_apart;
    unasked += answer == PairAnswer::neighbours_unasked;
    if (answer == PairAnswer::colliding) result.pairs.push_back(candidates[i]);
    if (answer == PairAnswer::neighbours_colliding) result.neighbour_pairs.push_back(candidates[i]);
  }
  result.neighbours = result.neighbour_pairs.size() + result.neighbours_apart + unasked;
  if (result.pairs.size() + result.apart + result.neighbours != candidates.size())
    throw std::logic_error("decide: a candidate was left undecided");
  return result;
}

namespace {

using Corners = std::array<Vec3, 3>;

/// Returns a bit set: bit 3 i + j is set if corner i of a and corner j of b have equal positions.
/// Positions are compared only if the vertex indices differ.
unsigned equal_corners(const Scene& scene, const TrianglePair& pair, const Corners& a,
                       const Corners& b) {
  const std::array<std::uint32_t, 3>&a_index = scene.triangles[pair.a],
                                  &b_index = scene.triangles[pair.b];
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

/// Returns whether neighbours collide, decided in doubles; `unknown` if rounding leaves a doubt.
/// equal: a result of equal_corners(), not 0.
Triage filter_neighbours(unsigned equal, const Corners& a, const Corners& b) {
  const int i = std::countr_zero(equal) / 3, j = std::countr_zero(equal) % 3;
  const unsigned rest = equal & (equal - 1);
  if (rest == 0) {
    return filter_beyond_vertex(a[i], a[(i + 1) % 3], a[(i + 2) % 3], b[(j + 1) % 3],
                                b[(j + 2) % 3]);
  }
  const int k = std::countr_zero(rest) / 3, l = std::countr_zero(rest) % 3;
  // More than an edge is shared, or a triangle has two equal corners.
  if ((rest & (rest - 1)) != 0 || i == k || j == l) return Triage::unknown;
  return filter_beyond_edge(a[i], a[k], a[3 - i - k], b[3 - j - l]);
}

PairAnswer answer_about_neighbours(unsigned equal, const Corners& a, const Corners& b) {
  const Triage triage = filter_neighbours(equal, a, b);
  const bool beyond =
      triage == Triage::unknown ? intersects_beyond_shared(a, b) : triage == Triage::yes;
  return beyond ? PairAnswer::neighbours_colliding : PairAnswer::neighbours_apart;
}

/// True if a pair is of one object. Fast if pair.a is mostly in the object of the previous call.
class SameObject {
 public:
  explicit SameObject(const Scene& scene) : objects_(scene.objects) {}

  bool operator()(const TrianglePair& pair) {
    if (pair.a < first_ || pair.a >= end_) {
      const auto after = std::upper_bound(
          objects_.begin(), objects_.end(), pair.a,
          [](std::uint32_t t, const Object& object) { return t < object.first_triangle; });
      // The object before `after` has pair.a: empty objects with the same start come earlier.
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

// Largest number of pairs in a block. With smaller blocks, threads would increment the shared
// counter more often; with larger blocks, the work of the threads would be less even.
constexpr std::size_t kBlock = 1024;

/// Decides up to kBlock pairs at a time. Each thread has its own BlockDecider with its own memory.
///
/// filter_planes() is `unknown` for all neighbours: any other answer proves that the corners of one
/// triangle are off the plane of the other, but a shared corner is in both planes. So all pairs may
/// go through the filter, and corners are compared only if the filter's answer is `unknown`. If
/// there are many neighbours, it is faster to find them before the filter.
class BlockDecider {
 public:
  BlockDecider(const Scene& scene, const ExactQuestion& question)
      : scene_(scene), question_(question), same_object_(scene) {}

  void operator()(std::span<const TrianglePair> pairs, std::span<PairAnswer> answers) {
    std::size_t neighbours = 0;
    if (many_neighbours_) {
      const std::size_t others =
          question_.neighbours ? answer_neighbours(pairs, answers) : set_aside(pairs, answers);
      neighbours = pairs.size() - others;
      filter({others_.data(), others});
      for (std::size_t k = 0; k < others; ++k) answers[where_[k]] = answer(others_[k], triage_[k]);
    } else {
      filter(pairs);
      for (std::size_t i = 0; i < pairs.size(); ++i) {
        answers[i] = answer(pairs[i], triage_[i]);
        neighbours += answers[i] != PairAnswer::apart && answers[i] != PairAnswer::colliding;
      }
    }
    many_neighbours_ = neighbours > pairs.size() / 8;
  }

 private:
  /// Marks pairs of one object that share a vertex as neighbours_unasked. Puts the others into
  /// others_, and returns their number. Avoids a branch, which would often be mispredicted.
  std::size_t set_aside(std::span<const TrianglePair> pairs, std::span<PairAnswer> answers) {
    std::size_t others = 0;
    for (std::size_t i = 0; i < pairs.size(); ++i) {
      const TrianglePair& pair = pairs[i];
      const bool shared = static_cast<bool>(
          same_object_(pair) & share_index(scene_.triangles[pair.a], scene_.triangles[pair.b]));
      answers[i] = shared ? PairAnswer::neighbours_unasked : PairAnswer::undecided;
      others_[others] = pair;
      where_[others] = static_cast<std::uint16_t>(i);
      others += !shared;
    }
    return others;
  }

  /// Answers about the neighbours. Puts all other pairs into others_, and returns their number.
  std::size_t answer_neighbours(std::span<const TrianglePair> pairs,
                                std::span<PairAnswer> answers) {
    std::size_t others = 0;
    for (std::size_t i = 0; i < pairs.size(); ++i) {
      const TrianglePair& pair = pairs[i];
      prefetch(scene_, pairs[std::min(i + kAhead, pairs.size() - 1)].b);
      if (same_object_(pair)) {
        const Corners a = scene_.corners(pair.a), b = scene_.corners(pair.b);
        if (const unsigned equal = equal_corners(scene_, pair, a, b); equal != 0) {
          answers[i] = answer_about_neighbours(equal, a, b);
          continue;
        }
      }
      others_[others] = pair;
      where_[others++] = static_cast<std::uint16_t>(i);
    }
    return others;
  }

  void filter(std::span<const TrianglePair> pairs) {
    filter_pairs(scene_, pairs, question_.clearance, {triage_.data(), pairs.size()});
  }

  PairAnswer answer(const TrianglePair& pair, Triage triage) {
    if (triage != Triage::unknown)
      return triage == Triage::no ? PairAnswer::apart : PairAnswer::colliding;
    const Corners a = scene_.corners(pair.a), b = scene_.corners(pair.b);
    const unsigned equal = same_object_(pair) ? equal_corners(scene_, pair, a, b) : 0;
    if (equal != 0 && !question_.neighbours) return PairAnswer::neighbours_unasked;
    if (equal != 0) return answer_about_neighbours(equal, a, b);
    return is_within_beyond_planes(a, b, question_.clearance) ? PairAnswer::colliding
                                                              : PairAnswer::apart;
  }

  const Scene& scene_;
  const ExactQuestion& question_;
  SameObject same_object_;
  bool many_neighbours_ = false;  // true if the previous block had many neighbours
  std::array<TrianglePair, kBlock> others_;
  std::array<std::uint16_t, kBlock> where_;  // indices in the block of the pairs in others_
  std::array<Triage, kBlock> triage_;
};

void require_pairs(const Scene& scene, std::span<const TrianglePair> candidates) {
  for (const TrianglePair& pair : candidates) {
    if (std::max(pair.a, pair.b) >= scene.triangles.size())
      throw std::logic_error("decide: a candidate names a triangle that the scene lacks");
    if (pair.a == pair.b) throw std::logic_error("decide: a candidate of one triangle");
  }
}

// Decides all candidates; returns the answers in the order of the candidates.
std::vector<PairAnswer> answers_about(const Scene& scene, std::span<const TrianglePair> candidates,
                                      const ExactQuestion& question) {
  std::vector<PairAnswer> answers(candidates.size(), PairAnswer::undecided);
  std::atomic<std::size_t> next = 0;
  const auto work = [&](std::size_t, std::size_t, std::size_t) {
    BlockDecider decide_block(scene, question);
    for (;;) {
      const std::size_t begin = next.fetch_add(kBlock);
      if (begin >= candidates.size()) return;
      const std::size_t count = std::min(kBlock, candidates.size() - begin);
      decide_block(candidates.subspan(begin, count), std::span(answers).subspan(begin, count));
    }
  };
  const std::size_t blocks = (candidates.size() + kBlock - 1) / kBlock;
  const std::size_t threads =
      std::clamp<std::size_t>(question.threads, 1, std::max<std::size_t>(blocks, 1));
  for_chunks(threads, threads, work);
  return answers;
}

}  // namespace

Collisions decide(const Scene& scene, std::span<const TrianglePair> candidates,
                  const ExactQuestion& question) {
  const FloatingPointGuard guard;
  require_clearance("decide", question.clearance);
  require_pairs(scene, candidates);
  return count_answers(candidates, answers_about(scene, candidates, question));
}

FirstCollisions decide_first(const Scene& scene, std::span<const TrianglePair> candidates,
                             std::uint64_t limit, const ExactQuestion& question) {
  const FloatingPointGuard guard;
  require_clearance("decide_first", question.clearance);
  require_pairs(scene, candidates);
  if (limit == 0) throw std::logic_error("decide_first: the limit is 0");
  // Each step takes twice as many candidates as the step before, so that threads have enough work
  // if few candidates collide. The steps do not depend on the number of threads. So `decided` and
  // `complete` do not depend on the number of threads, either.
  std::size_t step = 2 * kBlock;
  FirstCollisions out;
  Collisions& all = out.collisions;
  while (out.decided < candidates.size() && all.pairs.size() + all.neighbour_pairs.size() < limit) {
    const std::span<const TrianglePair> part =
        candidates.subspan(out.decided, std::min(step, candidates.size() - out.decided));
    all.append(count_answers(part, answers_about(scene, part, question)));
    out.decided += part.size();
    step *= 2;
  }
  const bool more = keep_first(limit, all);
  out.complete = !more && out.decided == candidates.size();
  return out;
}

bool keep_first(std::uint64_t limit, Collisions& collisions) {
  std::vector<TrianglePair>& pairs = collisions.pairs;
  std::vector<TrianglePair>& neighbours = collisions.neighbour_pairs;
  const bool more = pairs.size() + neighbours.size() > limit;
  while (pairs.size() + neighbours.size() > limit) {
    const bool last_is_neighbour =
        pairs.empty() || (!neighbours.empty() && pairs.back() < neighbours.back());
    (last_is_neighbour ? neighbours : pairs).pop_back();
  }
  return more;
}

Collisions FrameDecider::decide(const Scene& scene, std::span<const TrianglePair> candidates,
                                const MovedCorners& moved, const ExactQuestion& question) {
  const FloatingPointGuard guard;
  require_clearance("decide", question.clearance);
  require_pairs(scene, candidates);
  // If an exception is thrown below, frame_ stays empty.
  const std::optional<std::uint64_t> before = std::exchange(frame_, {});
  decided_ = candidates.size();
  const bool sorted =
      std::ranges::adjacent_find(candidates, std::ranges::greater_equal()) == candidates.end();
  const bool keeps = sorted && before && moved.follows(*before) &&
                     clearance_ == question.clearance && neighbours_ == question.neighbours &&
                     mostly_unmoved(moved, candidates);
  clearance_ = question.clearance;
  neighbours_ = question.neighbours;
  std::vector<PairAnswer> answers;
  if (!keeps) {
    answers = answers_about(scene, candidates, question);
  } else if (!moved.any() && std::ranges::equal(candidates, pairs_)) {
    answers = answers_;
    decided_ = 0;
  } else {
    answers.assign(candidates.size(), PairAnswer::undecided);
    std::vector<TrianglePair> left;
    std::vector<std::uint32_t> where;  // the indices in `candidates` of the pairs in `left`
    std::size_t last = 0;
    for (std::size_t k = 0; k < candidates.size(); ++k) {
      const TrianglePair& pair = candidates[k];
      if (!moved.triangle(pair.a) && !moved.triangle(pair.b)) {
        while (last < pairs_.size() && pairs_[last] < pair) ++last;
        if (last < pairs_.size() && pairs_[last] == pair) {
          answers[k] = answers_[last];
          continue;
        }
      }
      left.push_back(pair);
      where.push_back(static_cast<std::uint32_t>(k));
    }
    const std::vector<PairAnswer> anew = answers_about(scene, left, question);
    for (std::size_t k = 0; k < left.size(); ++k) answers[where[k]] = anew[k];
    decided_ = left.size();
  }
  const Collisions out = count_answers(candidates, answers);
  if (sorted) {
    pairs_.assign(candidates.begin(), candidates.end());
    answers_ = std::move(answers);
    frame_ = moved.frame();
  }
  return out;
}

}  // namespace farcull
