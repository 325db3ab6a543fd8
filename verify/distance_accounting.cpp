// Each object has a tree of boxes over its triangles. For every two objects that are asked about,
// the two trees are joined. All pairs of triangles below two nodes are settled at once in two
// cases: the boxes are farther apart than the threshold of the objects, or all these pairs come
// after an answer of distance 0 (only an earlier pair could refute this answer). The other pairs
// are decided one by one: first by two parallel planes in doubles, then in integers
// (verify/certificate/integer_distance.h).
#include "verify/distance_accounting.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <memory>
#include <stdexcept>
#include <tuple>
#include <utility>

#include "core/base/floating_point.h"
#include "core/base/parallel.h"
#include "core/base/stopwatch.h"
#include "verify/certificate/box_pairs.h"
#include "verify/exact.h"
#include "verify/separation.h"

namespace farcull {

// What answers claim depends on the kind of question. `objects`: an answer claims that no pair of
// triangles of its objects is nearer. If two objects have no answer, no pair of their triangles is
// within the distance asked for. `nearest`: if objects a and b have no answer, b is not among the k
// nearest of a. So no pair is nearer than the kth neighbour of a, nor equally near if b has a lower
// index than this neighbour. The same holds for b. `all`: the answers are all pairs within the
// distance.

namespace {

bool has(const Object& object, std::uint32_t triangle) {
  return triangle >= object.first_triangle &&
         triangle - object.first_triangle < object.triangle_count;
}

auto objects_of(const ClaimedDistance& answer) { return std::pair(answer.a, answer.b); }

constexpr std::size_t kExamples = 10;
// At most this many pairs are decided at a time, so that a list of all pairs is never stored.
constexpr std::size_t kChunk = 1 << 16;

/// Decides the pairs that boxes do not decide, a chunk at a time. Counts the pairs of each class.
class Undecided {
 public:
  Undecided(const Scene& scene, unsigned threads, DistanceAccounting& result)
      : scene_(scene), threads_(threads), result_(result) {}

  /// Sets the threshold of the pairs that are added next. self: the pairs are of one object.
  /// answer: the pair of the answer about these objects; empty without an answer, and for `all`.
  void begin(const Threshold& threshold, bool self, std::optional<TrianglePair> answer) {
    now_ = std::make_shared<const Asked>(Asked{threshold, self, answer});
  }
  void add(const TrianglePair& pair) {
    pairs_.push_back({pair, now_});
    if (pairs_.size() == kChunk) decide();
  }
  void decide() {
    std::vector<Class> classes(pairs_.size());
    const std::size_t chunks = chunks_for(pairs_.size(), 16, threads_);
    for_chunks(pairs_.size(), chunks, [&](std::size_t, std::size_t begin, std::size_t end) {
      for (std::size_t k = begin; k < end; ++k) classes[k] = class_of(pairs_[k]);
    });
    for (std::size_t k = 0; k < pairs_.size(); ++k) count(pairs_[k].pair, classes[k]);
    pairs_.clear();
  }

 private:
  /// A class of pairs, named by the member that counts the class.
  using Class = std::uint64_t DistanceAccounting::*;
  struct Asked {
    Threshold threshold;
    bool self = false;
    std::optional<TrianglePair> answer;
  };
  struct Pair {
    TrianglePair pair;
    std::shared_ptr<const Asked> asked;
  };

  Class class_of(const Pair& pair) const {
    const auto& [length, bound] = pair.asked->threshold;
    const std::array<Vec3, 3> s = scene_.corners(pair.pair.a), t = scene_.corners(pair.pair.b);
    if (length && std::isfinite(length->above) &&
        separation::farther_by_planes(s, t, length->above))
      return &DistanceAccounting::farther_by_planes;
    if (pair.asked->self && share_position(s, t)) return &DistanceAccounting::neighbours;
    if (!length) return &DistanceAccounting::nearer;
    // A pair before the answer must be farther apart than the answer. A later pair must be at least
    // as far apart.
    const bool before = pair.asked->answer && pair.pair < *pair.asked->answer;
    const bool or_as_far = bound == Bound::below && !before;
    if (is_beyond(s, t, *length, or_as_far)) return &DistanceAccounting::farther_by_exact;
    // is_beyond() found no direction that proves the triangles far enough apart. So their exact
    // distance must be too short; otherwise one of the two computations is wrong.
    const auto order = integer_distance(s, t).squared <=> length->squared;
    if (order > 0 || (order == 0 && or_as_far)) {
      throw std::logic_error(
          "account_distances: neither does a direction show that two triangles are far apart, nor "
          "are their nearest points near");
    }
    return order == 0 && before ? &DistanceAccounting::earlier : &DistanceAccounting::nearer;
  }

  void count(const TrianglePair& pair, Class of) {
    ++(result_.*of);
    if (of != &DistanceAccounting::nearer) return;
    std::vector<TrianglePair>& examples = result_.examples;
    examples.insert(std::ranges::upper_bound(examples, pair), pair);
    if (examples.size() > kExamples) examples.pop_back();
  }

  const Scene& scene_;
  unsigned threads_;
  DistanceAccounting& result_;
  std::shared_ptr<const Asked> now_;
  std::vector<Pair> pairs_;
};

/// Joins the trees of two objects, or of one object with itself.
class Join {
 public:
  Join(const BoundsTree& trees, const Threshold& threshold,
       std::span<const ClaimedDistance> answers, Undecided& undecided, DistanceAccounting& result)
      : trees_(trees),
        threshold_(threshold),
        answers_(answers),
        met_(answers.size()),
        undecided_(undecided),
        result_(result) {
    if (nothing_is_nearer(threshold) && !answers.empty()) first_ = answers.front().pair;
  }

  /// True if the threshold is "below 0". No distance is below 0.
  static bool nothing_is_nearer(const Threshold& threshold) {
    return threshold.length && threshold.length->squared.over == 0 &&
           threshold.bound == Bound::below;
  }

  /// Settles all pairs of triangles of two objects (of one if a == b). a, b: roots of the trees.
  void objects(std::uint32_t a, std::uint32_t b) {
    a == b ? one(a) : two(a, b);
    // If an answer names a pair that boxes settled, the pair counts in `answers` instead.
    const auto passed = static_cast<std::uint64_t>(std::ranges::count(met_, false));
    result_.answers += answers_.size();
    result_.farther_by_boxes -= passed;
  }

 private:
  /// True if all pairs of triangles with indices >= `least` come after an answer of distance 0.
  bool settled(std::uint32_t least) const { return first_ && least > first_->a; }
  bool farther(const BoundsTree::Bounds& a, const BoundsTree::Bounds& b) const {
    return threshold_.length && std::isfinite(threshold_.length->above) &&
           separation::farther(a, b, threshold_.length->above);
  }

  void one(std::uint32_t n) {
    const BoundsTree::Node& node = trees_.nodes[n];
    if (settled(node.first_triangle)) {
      result_.objects_meet += std::uint64_t{node.count} * (node.count - 1) / 2;
      return;
    }
    if (!trees_.is_leaf(n)) {
      one(trees_.left(n));
      one(trees_.right(n));
      return two(trees_.left(n), trees_.right(n));
    }
    for (std::uint32_t i = node.first; i < node.first + node.count; ++i) {
      for (std::uint32_t j = i + 1; j < node.first + node.count; ++j)
        triangles(trees_.order[i], trees_.order[j]);
    }
  }

  void two(std::uint32_t m, std::uint32_t n) {
    const BoundsTree::Node &a = trees_.nodes[m], &b = trees_.nodes[n];
    if (settled(std::min(a.first_triangle, b.first_triangle))) {
      result_.objects_meet += std::uint64_t{a.count} * b.count;
      return;
    }
    if (farther(a.bounds, b.bounds)) {
      result_.farther_by_boxes += std::uint64_t{a.count} * b.count;
      return;
    }
    if (!trees_.is_leaf(m) && (trees_.is_leaf(n) || a.count >= b.count)) {
      two(trees_.left(m), n);
      two(trees_.right(m), n);
    } else if (!trees_.is_leaf(n)) {
      two(m, trees_.left(n));
      two(m, trees_.right(n));
    } else {
      for (std::uint32_t i = a.first; i < a.first + a.count; ++i) {
        for (std::uint32_t j = b.first; j < b.first + b.count; ++j)
          triangles(trees_.order[i], trees_.order[j]);
      }
    }
  }

  void triangles(std::uint32_t s, std::uint32_t t) {
    const TrianglePair pair = {std::min(s, t), std::max(s, t)};
    if (first_ && *first_ < pair) {
      ++result_.objects_meet;
      return;
    }
    if (farther(trees_.bounds[s], trees_.bounds[t])) {
      ++result_.farther_by_boxes;
      return;
    }
    const auto found = std::ranges::lower_bound(answers_, pair, {}, &ClaimedDistance::pair);
    if (found != answers_.end() && found->pair == pair) {
      met_[static_cast<std::size_t>(found - answers_.begin())] = true;
      return;
    }
    undecided_.add(pair);
  }

  const BoundsTree& trees_;
  const Threshold& threshold_;
  std::span<const ClaimedDistance> answers_;  // answers about these objects, sorted by their pairs
  std::vector<bool> met_;                     // per answer: true if the join has met its pair
  std::optional<TrianglePair> first_;  // the pair of an answer of distance 0, if there is one
  Undecided& undecided_;
  DistanceAccounting& result_;
};

}  // namespace

bool is_rounded_root(double distance, const Fraction& square) {
  if (!(distance >= 0)) return false;
  mpq_class squared(square.over, square.under);
  squared.canonicalize();
  // Compares the root with the middle between two doubles by comparing the squares.
  return integer::is_nearest_double(distance, [&](double next) {
    const mpq_class middle = (integer::rational(distance) + integer::rational(next)) / 2;
    return next < 0 ? 1 : cmp(squared, mpq_class(middle * middle));
  });
}

DistanceClaims::DistanceClaims(const Scene& scene, std::span<const ClaimedDistance> answers,
                               const DistanceQuestion& question)
    : scene_(scene),
      answers_(answers),
      question_(question),
      squares_(answers.size()),
      insides_(scene) {
  using Kind = DistanceQuestion::Kind;
  if (!(question.within >= 0) || (question.kind == Kind::all && !std::isfinite(question.within)))
    throw std::logic_error("account_distances: no such distance");
  const auto place = [](const ClaimedDistance& x) { return std::tuple(x.a, x.b, x.pair); };
  for (std::size_t k = 0; k < answers.size(); ++k) {
    const ClaimedDistance& x = answers[k];
    if (x.a > x.b || x.b >= scene.objects.size() || x.pair.a >= x.pair.b ||
        !has(scene.objects[x.a], x.pair.a) || !has(scene.objects[x.b], x.pair.b))
      throw std::logic_error("account_distances: an answer names no triangles of its objects");
    if (k == 0) continue;
    const bool before = question.kind == Kind::all ? place(answers[k - 1]) < place(x)
                                                   : objects_of(answers[k - 1]) < objects_of(x);
    if (!before) throw std::logic_error("account_distances: answers unsorted or repeated");
  }
  within_.bound = Bound::at_most;
  if (std::isfinite(question.within)) within_.length.emplace(square_of(question.within));
  for (std::size_t k = 0; k < answers.size(); ++k) squares_[k] = parse_fraction(answers[k].squared);
  if (question.kind == Kind::nearest) find_farthest();
}

void DistanceClaims::find_farthest() {
  // For each object: the other object of each answer about it, with the squared distance.
  std::vector<std::vector<std::pair<Fraction, std::uint32_t>>> neighbours(scene_.objects.size());
  for (std::size_t k = 0; k < answers_.size(); ++k) {
    if (!squares_[k]) continue;
    neighbours[answers_[k].a].emplace_back(*squares_[k], answers_[k].b);
    neighbours[answers_[k].b].emplace_back(*squares_[k], answers_[k].a);
  }
  farthest_.resize(scene_.objects.size());
  for (std::size_t o = 0; o < neighbours.size(); ++o) {
    auto& of = neighbours[o];
    std::sort(of.begin(), of.end());
    farthest_[o].answers = std::min(of.size(), question_.k);
    if (of.size() < question_.k) continue;
    std::tie(farthest_[o].squared, farthest_[o].other) = of[question_.k - 1];
  }
}

bool DistanceClaims::asked(std::uint32_t a, std::uint32_t b) const {
  if (a != b) return true;
  return question_.kind != DistanceQuestion::Kind::nearest && scene_.objects[a].self;
}

std::span<const ClaimedDistance> DistanceClaims::of(std::uint32_t a, std::uint32_t b) const {
  const auto found = std::ranges::equal_range(answers_, std::pair(a, b), {}, objects_of);
  return {found.begin(), found.end()};
}

Threshold DistanceClaims::threshold(std::uint32_t a, std::uint32_t b) const {
  using Kind = DistanceQuestion::Kind;
  if (question_.kind == Kind::all) return within_;
  const std::span<const ClaimedDistance> answers = of(a, b);
  if (!answers.empty()) {
    const auto k = static_cast<std::size_t>(answers.data() - answers_.data());
    return {Length(squares_[k].value_or(Fraction())), Bound::below};
  }
  if (question_.kind == Kind::objects || farthest_[a].answers < question_.k ||
      farthest_[b].answers < question_.k) {
    return within_;
  }
  const auto& [a_count, a_squared, a_other] = farthest_[a];
  const auto& [b_count, b_squared, b_other] = farthest_[b];
  const Fraction& most = std::max(a_squared, b_squared);
  const bool before = (a_squared == most && b < a_other) || (b_squared == most && a < b_other);
  return {Length(most), before ? Bound::at_most : Bound::below};
}

bool DistanceClaims::wrong(std::size_t answer) const {
  const ClaimedDistance& x = answers_[answer];
  const std::optional<Fraction>& squared = squares_[answer];
  if (!squared || !asked(x.a, x.b) || !is_rounded_root(x.distance, *squared)) return true;
  if (within_.length && *squared > within_.length->squared) return true;
  const std::array<Vec3, 3> s = scene_.corners(x.pair.a), t = scene_.corners(x.pair.b);
  if (x.a == x.b && share_position(s, t)) return true;
  const IntegerDistance exact = integer_distance(s, t);
  if (exact.squared != *squared || exact.features != x.features ||
      !is_rounded(x.points[0], exact.points[0]) || !is_rounded(x.points[1], exact.points[1]))
    return true;
  const bool has_inside = question_.inside && question_.kind != DistanceQuestion::Kind::all &&
                          x.a != x.b && squared->over != 0;
  if (x.inside != (has_inside ? insides_.which(x.a, x.b) : InsideClaim::unknown)) return true;
  if (question_.kind != DistanceQuestion::Kind::nearest) return false;
  // The answer is wrong if neither object has the other object among its k nearest.
  const auto beyond = [&](const Farthest& of, std::uint32_t other) {
    return of.answers == question_.k && std::tie(of.squared, of.other) < std::tie(*squared, other);
  };
  return beyond(farthest_[x.a], x.b) && beyond(farthest_[x.b], x.a);
}

std::uint64_t DistanceClaims::wrong(unsigned threads) const {
  std::atomic<std::uint64_t> count = 0;
  for_each_shared(answers_.size(), threads, [&](std::size_t k) { count += wrong(k); });
  return count;
}

bool DistanceAccounting::adds_up() const {
  return pairs_total == answers + objects_meet + farther_by_boxes + farther_by_planes + neighbours +
                            farther_by_exact + nearer + earlier;
}

DistanceAccounting account_distances(const Scene& scene, std::span<const ClaimedDistance> answers,
                                     const DistanceQuestion& question) {
  const FloatingPointGuard guard;
  const Stopwatch watch;
  const DistanceClaims claims(scene, answers, question);
  DistanceAccounting out;
  out.wrong = claims.wrong(question.threads);
  BoundsTree trees(scene);
  std::vector<std::uint32_t> roots;  // per object; not used for objects without triangles
  for (const Object& object : scene.objects) {
    roots.push_back(static_cast<std::uint32_t>(trees.nodes.size()));
    if (object.triangle_count > 0) trees.add(object.first_triangle, object.triangle_count);
  }
  Undecided undecided(scene, question.threads, out);
  for (std::uint32_t a = 0; a < scene.objects.size(); ++a) {
    for (std::uint32_t b = a; b < scene.objects.size(); ++b) {
      const std::uint64_t m = scene.objects[a].triangle_count, n = scene.objects[b].triangle_count;
      const std::uint64_t pairs = a == b ? (m > 0 ? m * (m - 1) / 2 : 0) : m * n;
      if (pairs == 0 || !claims.asked(a, b)) continue;
      out.pairs_total += pairs;
      const Threshold threshold = claims.threshold(a, b);
      const std::span<const ClaimedDistance> of = claims.of(a, b);
      if (Join::nothing_is_nearer(threshold) && of.empty()) {
        out.objects_meet += pairs;
        continue;
      }
      std::optional<TrianglePair> answer;
      if (question.kind != DistanceQuestion::Kind::all && !of.empty()) answer = of.front().pair;
      undecided.begin(threshold, a == b, answer);
      Join(trees, threshold, of, undecided, out).objects(roots[a], roots[b]);
    }
  }
  undecided.decide();
  if (!out.adds_up()) throw std::logic_error("account_distances: the classes do not add up");
  out.ms = watch.ms();
  return out;
}

}  // namespace farcull
