// Joins a tree of boxes with itself, to find the pairs of triangles whose boxes overlap. The upper
// levels of the tree divide the set of objects. The lower levels divide the triangles of one
// object. So two disjoint subtrees hold either different objects, or triangles of one object. Two
// subtrees of one object are joined iff the object is `self`. If the boxes of two nodes are far
// enough apart, all pairs of the two nodes are counted at once. The way of dividing affects the
// speed, not the result.
//
// The bounds of a box are minima and maxima of coordinates. A gap between boxes is a difference
// computed in double. Rounding is monotone: if the rounded gap exceeds the clearance, the exact gap
// does too.
//
// If the join lost one pair and counted another twice, the classes of Accounting would still add
// up. So BoxPairs enumerates the pairs with overlapping boxes again, and the sets are compared.
#include "verify/accounting.h"

#include <algorithm>
#include <array>
#include <limits>
#include <set>
#include <stdexcept>
#include <string>
#include <utility>

#include "core/base/floating_point.h"
#include "core/base/random.h"
#include "core/base/stopwatch.h"
#include "verify/certificate/box_pairs.h"
#include "verify/within.h"

namespace farcull {

void PairSet::add(const TrianglePair& pair) {
  ++count;
  sum += scrambled(std::uint64_t{pair.a} << 32 | pair.b);
}

PairSet pairs_with_overlapping_boxes(const Scene& scene, double clearance) {
  constexpr std::size_t kBlock = 1 << 16;
  PairSet out;
  BoxPairs enumeration(scene, clearance);
  std::vector<TrianglePair> pairs;
  while (enumeration.next(pairs, kBlock)) {
    for (const TrianglePair& pair : pairs) out.add(pair);
  }
  return out;
}

namespace {

// Maximum number of triangles in a leaf.
constexpr std::uint32_t kLeafSize = 4;
// Maximum number of pairs decided at a time, so that the list of all overlaps is never stored.
constexpr std::size_t kChunk = 1 << 18;
constexpr std::uint32_t kNone = 0xffffffff;

constexpr double kInf = std::numeric_limits<double>::infinity();

struct Bounds {
  std::array<double, 3> lo = {kInf, kInf, kInf};
  std::array<double, 3> hi = {-kInf, -kInf, -kInf};
};

void include(Bounds& bounds, const Bounds& other) {
  for (int axis = 0; axis < 3; ++axis) {
    bounds.lo[axis] = std::min(bounds.lo[axis], other.lo[axis]);
    bounds.hi[axis] = std::max(bounds.hi[axis], other.hi[axis]);
  }
}

/// False iff a gap between the boxes along an axis, computed in double, exceeds the clearance. For
/// clearance 0 the result is exact, since the difference of unequal doubles is never 0.
bool meet(const Bounds& a, const Bounds& b, double clearance) {
  for (int axis = 0; axis < 3; ++axis) {
    if (b.lo[axis] - a.hi[axis] > clearance || a.lo[axis] - b.hi[axis] > clearance) return false;
  }
  return true;
}

std::vector<Bounds> bounds_of_triangles(const Scene& scene) {
  std::vector<Bounds> bounds(scene.triangles.size());
  for (std::uint32_t t = 0; t < bounds.size(); ++t) {
    for (const Vec3& p : scene.corners(t)) {
      const std::array<double, 3> corner = {p.x(), p.y(), p.z()};
      include(bounds[t], {corner, corner});
    }
  }
  return bounds;
}

struct Node {
  Bounds bounds;
  std::uint32_t first = 0;  // index into Tree::order_
  std::uint32_t count = 0;
  std::uint32_t left = kNone;  // kNone for a leaf
  std::uint32_t right = kNone;
  bool within = false;  // true if the node can hold both triangles of a pair that counts
};

/// Chooses the axis along which the centres spread most. Moves the half of the items with the
/// smaller centre coordinates to the front. Returns the number of these items.
std::size_t divide(std::span<std::uint32_t> items, const std::vector<Bounds>& bounds) {
  const auto centre = [&](std::uint32_t item, int axis) {
    return bounds[item].lo[axis] / 2 +
           bounds[item].hi[axis] / 2;  // two divisions, since lo + hi may overflow
  };
  int widest = 0;
  double spread = -1;
  for (int axis = 0; axis < 3; ++axis) {
    const auto [lo, hi] =
        std::ranges::minmax(items, {}, [&](std::uint32_t item) { return centre(item, axis); });
    const double here = centre(hi, axis) / 2 - centre(lo, axis) / 2;
    if (here > spread) widest = axis, spread = here;
  }
  const std::size_t middle = items.size() / 2;
  std::ranges::nth_element(items, items.begin() + middle, {},
                           [&](std::uint32_t item) { return centre(item, widest); });
  return middle;
}

class Tree {
 public:
  Tree(const Scene& scene, std::vector<Bounds> triangle_bounds, double clearance)
      : scene_(scene), clearance_(clearance), bounds_(std::move(triangle_bounds)) {
    object_bounds_.resize(scene.objects.size());
    std::vector<std::uint32_t> objects;
    for (std::uint32_t o = 0; o < scene.objects.size(); ++o) {
      const Object& object = scene.objects[o];
      if (object.triangle_count == 0) continue;
      objects.push_back(o);
      for (std::uint32_t i = 0; i < object.triangle_count; ++i)
        include(object_bounds_[o], bounds_[object.first_triangle + i]);
    }
    order_.reserve(scene.triangles.size());
    if (!objects.empty()) root_ = build_objects(objects);
  }

  /// Calls visit(a, b) for each pair that counts and whose bounds meet, with a and b in any order.
  /// Returns the number of pairs that count and whose bounds do not meet.
  std::uint64_t join(auto& visit) const {
    return root_ == kNone ? 0 : join_within(nodes_[root_], visit);
  }

 private:
  std::uint32_t add(std::uint32_t left, std::uint32_t right, bool within) {
    const Node &a = nodes_[left], &b = nodes_[right];
    Node node{a.bounds, a.first, a.count + b.count, left, right, within};
    include(node.bounds, b.bounds);
    nodes_.push_back(node);
    return static_cast<std::uint32_t>(nodes_.size() - 1);
  }

  std::uint32_t build_objects(std::span<std::uint32_t> objects) {
    if (objects.size() > 1) {
      const std::size_t middle = divide(objects, object_bounds_);
      const std::uint32_t left = build_objects(objects.first(middle));
      const std::uint32_t right = build_objects(objects.subspan(middle));
      return add(left, right, true);
    }
    const Object& object = scene_.objects[objects.front()];
    const auto first = static_cast<std::uint32_t>(order_.size());
    for (std::uint32_t i = 0; i < object.triangle_count; ++i)
      order_.push_back(object.first_triangle + i);
    return build_triangles(first, object.triangle_count, object.self);
  }

  std::uint32_t build_triangles(std::uint32_t first, std::uint32_t count, bool self) {
    const std::span<std::uint32_t> items = std::span(order_).subspan(first, count);
    if (count > kLeafSize) {
      const auto middle = static_cast<std::uint32_t>(divide(items, bounds_));
      const std::uint32_t left = build_triangles(first, middle, self);
      const std::uint32_t right = build_triangles(first + middle, count - middle, self);
      return add(left, right, self);
    }
    Node leaf{.bounds = {}, .first = first, .count = count, .within = self};
    for (const std::uint32_t t : items) include(leaf.bounds, bounds_[t]);
    nodes_.push_back(leaf);
    return static_cast<std::uint32_t>(nodes_.size() - 1);
  }

  std::uint64_t join_within(const Node& node, auto& visit) const {
    if (!node.within) return 0;
    if (node.left != kNone) {
      const Node& left = nodes_[node.left];
      const Node& right = nodes_[node.right];
      return join_within(left, visit) + join_within(right, visit) + join_across(left, right, visit);
    }
    std::uint64_t disjoint = 0;
    for (std::uint32_t i = node.first; i < node.first + node.count; ++i) {
      for (std::uint32_t j = i + 1; j < node.first + node.count; ++j)
        disjoint += join_triangles(order_[i], order_[j], visit);
    }
    return disjoint;
  }

  std::uint64_t join_across(const Node& a, const Node& b, auto& visit) const {
    if (!meet(a.bounds, b.bounds, clearance_)) return std::uint64_t{a.count} * b.count;
    const bool a_is_leaf = a.left == kNone;
    const bool b_is_leaf = b.left == kNone;
    if (!a_is_leaf && (b_is_leaf || a.count >= b.count))
      return join_across(nodes_[a.left], b, visit) + join_across(nodes_[a.right], b, visit);
    if (!b_is_leaf)
      return join_across(a, nodes_[b.left], visit) + join_across(a, nodes_[b.right], visit);
    std::uint64_t disjoint = 0;
    for (std::uint32_t i = a.first; i < a.first + a.count; ++i) {
      for (std::uint32_t j = b.first; j < b.first + b.count; ++j)
        disjoint += join_triangles(order_[i], order_[j], visit);
    }
    return disjoint;
  }

  std::uint64_t join_triangles(std::uint32_t s, std::uint32_t t, auto& visit) const {
    if (!meet(bounds_[s], bounds_[t], clearance_)) return 1;
    visit(s, t);
    return 0;
  }

  const Scene& scene_;
  double clearance_;
  std::vector<Bounds> bounds_;
  std::vector<Bounds> object_bounds_;
  std::vector<std::uint32_t> order_;  // indices of triangles; each node owns a range
  std::vector<Node> nodes_;
  std::uint32_t root_ = kNone;
};

/// The ignored pairs of objects. Does not use IgnoredObjects of core/scene/scene, since culling
/// uses that class.
class Ignored {
 public:
  Ignored(const Scene& scene, std::span<const ObjectPair> pairs)
      : pairs_(pairs.begin(), pairs.end()) {
    for (const ObjectPair& pair : pairs) {
      if (pair.a >= pair.b || pair.b >= scene.objects.size())
        throw std::logic_error("account: an ignored pair is not two objects, a < b");
      const Object& a = scene.objects[pair.a];
      triangles_ += std::uint64_t{a.triangle_count} * scene.objects[pair.b].triangle_count;
    }
    if (pairs_.size() != pairs.size())
      throw std::logic_error("account: a pair of objects is ignored twice");
  }

  bool has(std::uint32_t object, std::uint32_t other) const {
    return !pairs_.empty() && pairs_.contains({std::min(object, other), std::max(object, other)});
  }
  std::uint64_t triangle_pairs() const { return triangles_; }

 private:
  std::set<ObjectPair> pairs_;
  std::uint64_t triangles_ = 0;
};

/// The sorted kept pairs, with an index: the kept pairs (a, b) of a triangle a are at positions
/// starts_[a] to starts_[a + 1] - 1.
class Kept {
 public:
  Kept(const Scene& scene, const std::vector<std::uint32_t>& owner, const Ignored& ignored,
       std::span<const TrianglePair> pairs)
      : pairs_(pairs), starts_(scene.triangles.size() + 1) {
    for (std::size_t i = 0; i < pairs.size(); ++i) {
      const TrianglePair& pair = pairs[i];
      if (pair.b >= scene.triangles.size())
        throw std::logic_error("account: kept pair out of range");
      if (pair.a >= pair.b) throw std::logic_error("account: kept pair without a < b");
      if (owner[pair.a] == owner[pair.b] && !scene.objects[owner[pair.a]].self)
        throw std::logic_error("account: kept pair of one object that is not self");
      if (ignored.has(owner[pair.a], owner[pair.b]))
        throw std::logic_error("account: kept pair of objects that are ignored");
      if (i > 0 && !(pairs[i - 1] < pair))
        throw std::logic_error("account: kept pairs unsorted or repeated");
      ++starts_[pair.a + 1];
    }
    for (std::size_t t = 1; t < starts_.size(); ++t) starts_[t] += starts_[t - 1];
  }

  bool contains(const TrianglePair& pair) const {
    const auto from = pairs_.begin();
    return std::binary_search(from + starts_[pair.a], from + starts_[pair.a + 1], pair);
  }

 private:
  std::span<const TrianglePair> pairs_;
  std::vector<std::size_t> starts_;
};

/// Returns the number of pairs that count: n m for any two objects with n and m triangles, and
/// n (n - 1) / 2 for each object that is `self`. The number is below 2^63, since triangle indices
/// have 32 bits.
std::uint64_t pairs_that_count(const Scene& scene) {
  std::uint64_t before = 0;
  std::uint64_t pairs = 0;
  for (const Object& object : scene.objects) {
    if (object.first_triangle != before)
      throw std::logic_error("account: objects with gaps or overlaps");
    const std::uint64_t count = object.triangle_count;
    pairs += before * count;
    if (object.self && count > 0) pairs += count * (count - 1) / 2;
    before += count;
  }
  if (before != scene.triangles.size())
    throw std::logic_error("account: triangles without an object");
  return pairs;
}

}  // namespace

bool Accounting::adds_up() const {
  return pairs_total == ignored + pairs_kept + certified_by_boxes + neighbours +
                            certified_by_predicates + false_negatives;
}

Accounting account(const Scene& scene, std::span<const TrianglePair> kept,
                   const AccountOptions& options, const AccountingSteps& steps) {
  const FloatingPointGuard guard;
  const Stopwatch start;
  const double clearance = options.clearance;
  require_clearance("account", clearance);
  Accounting result;
  result.pairs_total = pairs_that_count(scene);
  std::vector<std::uint32_t> owner;  // per triangle: its object
  for (std::uint32_t o = 0; o < scene.objects.size(); ++o)
    owner.insert(owner.end(), scene.objects[o].triangle_count, o);
  const Ignored ignored(scene, options.ignored);
  result.ignored = ignored.triangle_pairs();
  const Kept kept_pairs(scene, owner, ignored, kept);

  std::vector<TrianglePair> chunk;  // undecided pairs that are not in `kept`
  const auto decide_chunk = [&] {
    const Collisions missed = steps.decide(scene, chunk, {.clearance = clearance});
    result.neighbours += missed.neighbours_apart;
    result.false_negatives += missed.pairs.size() + missed.neighbour_pairs.size();
    result.certified_by_predicates += missed.apart;
    chunk.clear();
    std::vector<TrianglePair>& examples = result.examples;
    for (const auto* pairs : {&missed.pairs, &missed.neighbour_pairs})
      examples.insert(examples.end(), pairs->begin(), pairs->end());
    std::ranges::sort(examples);
    examples.resize(std::min(examples.size(), options.max_examples));
  };
  PairSet overlapping;
  std::uint64_t ignored_overlapping = 0;
  const auto visit = [&](std::uint32_t s, std::uint32_t t) {
    const TrianglePair pair = {std::min(s, t), std::max(s, t)};
    overlapping.add(pair);
    if (ignored.has(owner[s], owner[t])) {
      ++ignored_overlapping;
    } else if (kept_pairs.contains(pair)) {
      ++result.pairs_kept;
    } else {
      chunk.push_back(pair);
      if (chunk.size() == kChunk) decide_chunk();
    }
  };

  const std::vector<Bounds> bounds = bounds_of_triangles(scene);
  const std::uint64_t disjoint = Tree(scene, bounds, clearance).join(visit);
  decide_chunk();
  // Kept pairs with disjoint boxes are a mistake of the culling. They count as kept, so they are
  // subtracted from certified_by_boxes.
  const auto kept_disjoint = static_cast<std::uint64_t>(std::count_if(
      kept.begin(), kept.end(),
      [&](const TrianglePair& pair) { return !meet(bounds[pair.a], bounds[pair.b], clearance); }));
  result.pairs_kept += kept_disjoint;
  if (result.pairs_kept != kept.size())
    throw std::logic_error("account: the tree passed over a kept pair whose boxes overlap");
  // The tree also counts ignored pairs, so the ignored pairs with disjoint boxes are subtracted.
  const std::uint64_t ignored_disjoint = result.ignored - ignored_overlapping;
  result.certified_by_boxes = disjoint - kept_disjoint - ignored_disjoint;
  if (!result.adds_up()) throw std::logic_error("account: the classes do not add up");
  if (const PairSet again = steps.overlapping(scene, clearance); again != overlapping) {
    throw std::logic_error("account: " + std::to_string(overlapping.count) +
                           " pairs with overlapping boxes, and by another enumeration " +
                           std::to_string(again.count) +
                           (again.count == overlapping.count ? " others" : ""));
  }
  result.ms = start.ms();
  return result;
}

}  // namespace farcull
