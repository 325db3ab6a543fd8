// Implements the search (branch and bound) with SIMD. All instruction sets round alike, so they
// give the same results in the same order.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "core/proximity/search.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include <algorithm>
#include <bit>
#include <limits>

#include "core/boxes/lanes-inl.h"
#include "core/proximity/scene_trees.h"
#include "core/proximity/triangle_pairs-inl.h"

HWY_BEFORE_NAMESPACE();
namespace farcull::HWY_NAMESPACE {
namespace proximity {

using boxes::Gaps;
using boxes::near_boxes;
using boxes::next_bit;
using OneBox = boxes::OneBox<double>;

class Searcher {
 public:
  Searcher(const SceneTrees& trees, Search& search, SearchMemory& memory)
      : trees_(trees),
        search_(search),
        memory_(memory),
        others_(search.others),
        a_{trees, search.objects.a},
        b_{others_ ? *others_->all : trees, search.objects.b},
        self_(!others_ && search.objects.a == search.objects.b) {
    Box both = a_.tree().box;
    both.add(b_.tree().box);
    origin_ = 0.5 * both.lo + 0.5 * both.hi;
    // A computed difference has a relative error of at most u, which near::kGap covers.
    extent_ = (both.hi - origin_).cwiseMax(origin_ - both.lo);
    new_bound();
    new_direction();
  }

  void begin(const TrianglePair* hint) {
    search_.open.push_back({0, 0, 0, static_cast<std::uint8_t>(a_.tree().levels),
                            static_cast<std::uint8_t>(b_.tree().levels)});
    probing_ = true;  // pairs are not kept now, since go_on() examines them again
    if (hint != nullptr && counts(hint->a, hint->b)) {
      add_hint(*hint);
      flush();
    } else if (!self_ && !others_) {
      descend();
    }
    probing_ = false;
  }

  void go_on(std::size_t most) {
    std::size_t looked_at = 0;
    while (!search_.open.empty() && looked_at < most) {
      const NodePair at = search_.open.back();
      search_.open.pop_back();
      if (at.square > square_limit_ || is_behind(at) || is_no_nearer(at)) continue;
      if (at.a_height == 0 && at.b_height == 0) {
        compare_leaves(at);
        ++looked_at;
      } else {
        children_.clear();
        expand(at, square_limit_, children_);
        std::ranges::sort(children_, [this](const NodePair& x, const NodePair& y) {
          if (x.square != y.square) return x.square > y.square;
          return comes_first(y, x);
        });
        search_.open.insert(search_.open.end(), children_.begin(), children_.end());
      }
    }
    flush();
  }

 private:
  struct Side {
    const SceneTrees& trees;
    std::uint32_t object;

    const BoxTree<double>& tree() const { return trees.tree(object); }
    const WideBoxes<double>& children(std::size_t height, std::uint32_t k) const {
      return trees.blocks()[tree().first[height - 1] + k];
    }
    HWY_INLINE OneBox box_of(std::size_t height, std::uint32_t k) const {
      if (height == static_cast<std::size_t>(tree().levels)) return OneBox(tree().box);
      return OneBox(trees.blocks()[tree().first[height] + k / kWide], k % kWide);
    }
    std::uint32_t least(std::size_t height, std::uint32_t k) const {
      return trees.least(object, height, k);
    }
    BlockCorners& load(std::vector<BlockCorners>& memory, std::uint32_t k) const {
      const std::uint32_t leaf = trees.leaf(object, k);
      BlockCorners& out = memory[leaf % SearchMemory::kLeaves];
      if (out.leaf != leaf) load_leaf(trees, leaf, out);
      return out;
    }
  };

  // Among equally near pairs of nodes, the pair with lower triangle numbers comes first. If the
  // objects meet, the answer is the first pair of triangles that meets.
  bool comes_first(const NodePair& x, const NodePair& y) const {
    TrianglePair p = least(x), q = least(y);
    if (others_) std::swap(p.a, p.b), std::swap(q.a, q.b);  // orders by the other object first
    if (p != q) return p < q;
    return x.a != y.a ? x.a > y.a : x.b > y.b;
  }
  TrianglePair least(const NodePair& at) const {
    return {a_.least(at.a_height, at.a), b_.least(at.b_height, at.b)};
  }
  // True if every pair of triangles below the nodes comes after a pair that certainly meets.
  bool is_behind(const NodePair& at) const {
    if (others_) return b_.least(at.b_height, at.b) >= others_->end;
    if (search_.first.a == UINT32_MAX) return false;
    return search_.is_behind(lower_bound(at));
  }
  // Returns a pair at or before every pair of triangles below the nodes.
  TrianglePair lower_bound(const NodePair& at) const {
    const TrianglePair lowest = least(at);
    // In a search within one object, either node may hold the lower triangle.
    return self_ ? TrianglePair{std::min(lowest.a, lowest.b), 0} : lowest;
  }
  // True if the planes prove that no pair of triangles below the nodes is the answer.
  bool is_no_nearer(const NodePair& at) const {
    if (!search_.planes) return false;
    const auto &a = search_.planes->a.nodes, &b = search_.planes->b.nodes;
    const auto is = [&](double reach, double start) {
      return reach < start || (reach == start && lower_bound(at) > search_.settled);
    };
    return is(a[at.a_height][at.a], -b[at.b_height][at.b]) ||
           (self_ && is(a[at.b_height][at.b], -b[at.a_height][at.a]));
  }
  // True if the planes prove that triangle i of leaf at.a and triangle j of leaf at.b are not the
  // answer.
  bool is_no_nearer(const NodePair& at, std::size_t i, std::size_t j,
                    const TrianglePair& pair) const {
    if (!search_.planes) return false;
    const auto &a = search_.planes->a.triangles, &b = search_.planes->b.triangles;
    const std::size_t s = kWide * at.a + i, t = kWide * at.b + j;
    const auto is = [&](double reach, double start) {
      return reach < start || (reach == start && pair > search_.settled);
    };
    return is(a[s], -b[t]) || (self_ && is(a[t], -b[s]));
  }

  // Descends to the pair of leaves that seems nearest. There, bounds the distance of the two
  // triangles whose first corners are nearest, to get a first bound.
  void descend() {
    NodePair at = search_.open.back();
    while (at.a_height > 0 || at.b_height > 0) {
      children_.clear();
      expand(at, near::kMostSquare, children_);
      at = *std::ranges::min_element(children_, {}, &NodePair::square);
    }
    const BlockCorners& a = a_.load(memory_.a, at.a);
    const BlockCorners& b = b_.load(memory_.b, at.b);
    double least = std::numeric_limits<double>::infinity();
    std::size_t best_i = 0, best_j = 0;
    for (std::size_t i = 0; i < a.count; ++i) {
      for (std::size_t j = 0; j < b.count; ++j) {
        double square = 0;
        for (std::size_t axis = 0; axis < 3; ++axis) {
          const double d = a.corner[axis][i] - b.corner[axis][j];
          square += d * d;
        }
        if (square < least) {
          least = square;
          best_i = i;
          best_j = j;
        }
      }
    }
    add(a, best_i, b, best_j);
    flush();
  }

  // Adds pairs of children whose squared gap is at most `limit` to `out`. Divides the higher node,
  // or both nodes if they are equally high.
  HWY_INLINE void expand(const NodePair& at, double limit, std::vector<NodePair>& out) {
    alignas(64) Gaps squares;
    const auto a_height = static_cast<std::uint8_t>(at.a_height - (at.a_height >= at.b_height));
    const auto b_height = static_cast<std::uint8_t>(at.b_height - (at.b_height >= at.a_height));
    if (at.a_height != at.b_height) {
      const bool a = at.a_height > at.b_height;  // true: divides at.a
      const WideBoxes<double>& own =
          a ? a_.children(at.a_height, at.a) : b_.children(at.b_height, at.b);
      const OneBox box = a ? b_.box_of(at.b_height, at.b) : a_.box_of(at.a_height, at.a);
      std::uint32_t bits = near_boxes(own, box, limit, squares);
      while (bits != 0) {
        const std::uint32_t k = next_bit(bits);
        out.push_back(
            {squares[k], a ? child(at.a, k) : at.a, a ? at.b : child(at.b, k), a_height, b_height});
      }
      search_.counts.box_pairs += kWide;
      return;
    }
    const WideBoxes<double>& own = a_.children(at.a_height, at.a);
    const WideBoxes<double>& other = b_.children(at.b_height, at.b);
    std::uint32_t columns = near_boxes(other, a_.box_of(at.a_height, at.a), limit, squares);
    search_.counts.box_pairs += kWide * (1 + static_cast<std::size_t>(std::popcount(columns)));
    while (columns != 0) {
      const std::size_t j = next_bit(columns);
      std::uint32_t bits = near_boxes(own, OneBox(other, j), limit, squares);
      if (self_ && at.a == at.b) bits &= (2u << j) - 1;
      while (bits != 0) {
        const std::size_t i = next_bit(bits);
        out.push_back({squares[i], child(at.a, i), child(at.b, j), a_height, b_height});
      }
    }
  }
  static std::uint32_t child(std::uint32_t node, std::size_t k) {
    return kWide * node + static_cast<std::uint32_t>(k);
  }

  // Adds to the batch those pairs of triangles of two leaves that may be near.
  HWY_INLINE void compare_leaves(const NodePair& at) {
    BlockCorners& a = a_.load(memory_.a, at.a);
    BlockCorners& b = b_.load(memory_.b, at.b);
    const std::uint32_t asked = others_ ? asked_of(b) : 0xffff;
    if (asked == 0) return;
    // Copies both members, since add() below may change the direction.
    const bool directed = direction_ != 0;
    const double gap_limit = gap_limit_;
    if (directed) {
      if (a.direction != direction_) project(a, true);
      if (b.direction != direction_) project(b, false);
      if (b.most_extreme - a.most_extreme > gap_limit) return;
    }
    alignas(64) Gaps squares;
    std::uint32_t rows = near_boxes(a.boxes, b_.box_of(0, at.b), square_limit_, squares);
    const std::uint32_t columns =
        asked & near_boxes(b.boxes, a_.box_of(0, at.a), square_limit_, squares);
    search_.counts.box_pairs += kWide * (2 + static_cast<std::size_t>(std::popcount(rows)));
    const bool same = self_ && at.a == at.b;
    std::array<std::uint32_t, kWide> near{};  // near[i]: bit j is set if pair (i, j) may be near
    for (; rows != 0; rows &= rows - 1) {
      const auto i = static_cast<std::size_t>(std::countr_zero(rows));
      near[i] = columns & near_boxes(b.boxes, OneBox(a.boxes, i), square_limit_, squares);
      if (same) near[i] &= ~((2u << i) - 1);
      if (directed) near[i] &= before(b.extreme, a.extreme[i], gap_limit);
    }
    drop_apart_along_normals(a, b, near);
    for (std::size_t i = 0; i < kWide; ++i) {
      for (std::uint32_t bits = near[i]; bits != 0;) {
        const std::size_t j = next_bit(bits);
        const auto pair = std::minmax(a.triangle[i], b.triangle[j]);
        if (!is_no_nearer(at, i, j, {pair.first, pair.second})) add(a, i, b, j);
      }
    }
  }

  // Returns the bits of the triangles of a leaf that a search with Others compares.
  std::uint32_t asked_of(const BlockCorners& leaf) const {
    std::uint32_t out = 0;
    for (std::uint32_t k = 0; k < leaf.count; ++k) {
      const std::uint32_t t = leaf.triangle[k];
      out |= std::uint32_t{t < others_->end && !others_->is_own(t)} << k;
    }
    return out;
  }

  // Drops pairs of triangles whose gap along a direction of one triangle is above the bound. The
  // directions are its normal, and the normals of its edges in its plane. Boxes along the axes
  // separate slivers and large triangles poorly. A direction is tried for all pairs of a triangle
  // at once, which takes less time than bounding two pairs.
  HWY_INLINE void drop_apart_along_normals(const BlockCorners& a, const BlockCorners& b,
                                           std::array<std::uint32_t, kWide>& near) const {
    std::uint32_t once = 0, twice = 0;  // columns with at least one and with at least two pairs
    for (std::size_t i = 0; i < kWide; ++i) {
      if (std::popcount(near[i]) > 1) near[i] = near_triangle(a, i, b, near[i]);
      twice |= once & near[i];
      once |= near[i];
    }
    while (twice != 0) {
      const std::size_t j = next_bit(twice);
      std::uint32_t rows = 0;
      for (std::size_t i = 0; i < kWide; ++i) rows |= (near[i] >> j & 1u) << i;
      rows = near_triangle(b, j, a, rows);
      for (std::size_t i = 0; i < kWide; ++i) near[i] &= ~((~rows >> i & 1u) << j);
    }
  }

  // Clears the bits of triangles of `leaf` whose gap to triangle i of `own`, along a direction of
  // triangle i, is above the bound. Any direction gives a valid bound, so errors of a computed
  // normal do no harm (core/proximity/scene_trees.h). Components are scaled to at most 16.
  HWY_INLINE std::uint32_t near_triangle(const BlockCorners& own, std::size_t i,
                                         const BlockCorners& leaf, std::uint32_t bits) const {
    std::array<Vec3, 3> corners;
    for (std::size_t k = 0; k < 3; ++k)
      corners[k] = {own.corner[3 * k][i], own.corner[3 * k + 1][i], own.corner[3 * k + 2][i]};
    const auto& [p, q, r] = corners;
    const Vec3 normal = 0.125 * (q - p).cross(r - p);
    bits &= near_along(normal, corners, leaf);
    for (std::size_t k = 0; k < 3 && std::popcount(bits) > 2; ++k) {
      const Vec3 edge = corners[(k + 1) % 3] - corners[k];
      bits &= near_along(0.0625 * edge.cross(normal), corners, leaf);
    }
    return bits;
  }

  // The least and the largest coordinate of the triangle on each lane, along a direction.
  struct Ends {
    Number least, most;
  };
  HWY_INLINE Ends ends_along(const Vec3& d, const BlockCorners& leaf, std::size_t from) const {
    const Point direction = {number(d[0]), number(d[1]), number(d[2])};
    const Point origin = {number(origin_[0]), number(origin_[1]), number(origin_[2])};
    const auto place = [&](std::size_t corner) {
      return dot(LaneTriangle::load(leaf.corner, corner, from) - origin, direction);
    };
    const Number p = place(0), q = place(1), r = place(2);
    return {hn::Min(hn::Min(p, q), r), hn::Max(hn::Max(p, q), r)};
  }

  // Returns the bits of the triangles of a leaf whose gap to the triangle `corners` along d is at
  // most the bound.
  HWY_INLINE std::uint32_t near_along(const Vec3& d, const std::array<Vec3, 3>& corners,
                                      const BlockCorners& leaf) const {
    const double squared = d.squaredNorm();
    if (!(squared >= near::kLeastSquare)) return 0xffff;
    const double limit =
        near::gap_limit(search_.bound(), squared, near::kGap * d.cwiseAbs().dot(extent_));
    const auto at = [&](std::size_t k) { return d.dot(corners[k] - origin_); };
    const double at_p = at(0), at_q = at(1), at_r = at(2);
    const Number least = number(std::min({at_p, at_q, at_r})),
                 most = number(std::max({at_p, at_q, at_r}));
    std::uint32_t out = 0;
    for (std::size_t from = 0; from < kWide; from += kLanes) {
      const Ends own = ends_along(d, leaf, from);
      const Number gap = hn::Max(hn::Sub(own.least, most), hn::Sub(least, own.most));
      out |= boxes::bits_of(Numbers(), hn::Le(gap, number(limit))) << from;
    }
    return out;
  }

  // Returns the bits of the triangles with extreme <= place + gap_limit.
  HWY_INLINE std::uint32_t before(const std::array<double, kWide>& extreme, double place,
                                  double gap_limit) const {
    const Numbers n;
    std::uint32_t out = 0;
    for (std::size_t from = 0; from < kWide; from += kLanes) {
      const Number gap = hn::Sub(hn::Load(n, &extreme[from]), number(place));
      out |= boxes::bits_of(n, hn::Le(gap, number(gap_limit))) << from;
    }
    return out;
  }

  // Sets the leaf's extremes to the triangles' largest (`most`) or smallest coordinates along the
  // direction.
  HWY_INLINE void project(BlockCorners& leaf, bool most) const {
    for (std::size_t from = 0; from < kWide; from += kLanes) {
      const Ends ends = ends_along(search_.direction, leaf, from);
      hn::Store(most ? ends.most : ends.least, Numbers(), &leaf.extreme[from]);
    }
    const auto end = leaf.extreme.begin() + leaf.count;
    leaf.most_extreme = most ? *std::max_element(leaf.extreme.begin(), end)
                             : *std::min_element(leaf.extreme.begin(), end);
    leaf.direction = direction_;
  }

  bool counts(std::uint32_t a, std::uint32_t b) const {
    return !self_ || !share_position(trees_.scene(), a, b);
  }
  void add(const BlockCorners& a, std::size_t i, const BlockCorners& b, std::size_t j) {
    const std::uint32_t first = a.triangle[i], second = b.triangle[j];
    // The lower triangle number comes first, since roundings of the bounds depend on the order.
    if (first > second) return add(b, j, a, i);
    if (search_.is_behind({first, second}) || !counts(first, second)) return;
    PairBatch& batch = memory_.batch;
    for (std::size_t k = 0; k < 9; ++k) {
      batch.a[k][batch.count] = a.corner[k][i];
      batch.b[k][batch.count] = b.corner[k][j];
    }
    batch.pairs[batch.count] = {first, second};
    if (++batch.count == kWide) flush();
  }
  void add_hint(const TrianglePair& hint) {
    PairBatch& batch = memory_.batch;
    for (std::size_t corner = 0; corner < 3; ++corner) {
      const Vec3 p = trees_.corner(hint.a, corner), q = trees_.corner(hint.b, corner);
      for (std::size_t axis = 0; axis < 3; ++axis) {
        batch.a[3 * corner + axis][0] = p[static_cast<Eigen::Index>(axis)];
        batch.b[3 * corner + axis][0] = q[static_cast<Eigen::Index>(axis)];
      }
    }
    batch.pairs[0] = hint;
    batch.count = 1;
  }

  HWY_INLINE void flush() {
    PairBatch& batch = memory_.batch;
    if (batch.count == 0) return;
    BatchBounds bounds;
    bound_batch(batch, bounds);
    // Two triangles with a common corner meet. The bounds may not show this if no edge pierces a
    // face, as in equal objects and in fans.
    for (std::size_t k = 0; k < batch.count && !self_; ++k) {
      const auto& [a, b] = batch.pairs[k];
      if (bounds.lower[k] == 0 && bounds.upper[k] != 0 && share_position(trees_.scene(), a, b))
        bounds.upper[k] = 0;
    }
    search_.counts.triangle_pairs += batch.count;
    const double before = search_.upper;
    std::size_t best = kWide;
    for (std::size_t k = 0; k < batch.count; ++k) {
      if (others_) {
        others_->add(batch.pairs[k], bounds.upper[k]);
        if (!(others_->upper() < search_.upper)) continue;
        search_.upper = others_->upper();
      } else {
        if (bounds.upper[k] == 0) search_.first = std::min(search_.first, batch.pairs[k]);
        if (!(bounds.upper[k] < search_.upper)) continue;
        search_.upper = bounds.upper[k];
      }
      best = k;
    }
    if (best < kWide) {
      new_bound();
      // If many pairs are at almost the same distance, the bound often decreases only a little.
      // Then the direction is kept.
      if (direction_ == 0 || search_.upper < before * (1 - 0x1p-20)) {
        search_.direction = {bounds.direction[0][best], bounds.direction[1][best],
                             bounds.direction[2][best]};
        // The direction must lead away from the object whose nearest others are searched for.
        if (others_ && !others_->is_own(batch.pairs[best].a)) search_.direction *= -1;
        new_direction();
      }
    }
    if (!probing_) keep(bounds);
    batch.count = 0;
  }
  void keep(const BatchBounds& bounds) {
    const double bound = search_.bound();
    for (std::size_t k = 0; k < memory_.batch.count; ++k) {
      if (bounds.lower[k] > bound || search_.is_behind(memory_.batch.pairs[k])) continue;
      search_.kept.push_back({memory_.batch.pairs[k], bounds.lower[k], bounds.upper[k]});
    }
    if (search_.kept.size() <= search_.kept_most) return;
    search_.filter();
    if (2 * search_.kept.size() > search_.kept_most && !search_.everything && !others_) {
      settle(trees_, search_);
      new_bound();
    }
    search_.kept_most = std::max<std::size_t>(search_.kept_most, 2 * search_.kept.size());
  }

  void new_bound() {
    square_limit_ = near::square_limit(search_.bound());
    set_gap_limit();
  }
  void new_direction() {
    const Vec3& d = search_.direction;
    // No direction separates the triangles of one object.
    const bool any = !self_ && d.squaredNorm() >= near::kLeastSquare;
    direction_ = any ? ++memory_.directions : 0;
    set_gap_limit();
  }
  void set_gap_limit() {
    const Vec3& d = search_.direction;
    gap_limit_ =
        near::gap_limit(search_.bound(), d.squaredNorm(), near::kGap * d.cwiseAbs().dot(extent_));
  }

  const SceneTrees& trees_;
  Search& search_;
  SearchMemory& memory_;
  Others* others_;
  Side a_, b_;
  bool self_;
  Vec3 origin_, extent_;
  double square_limit_ = 0, gap_limit_ = 0;
  std::uint64_t direction_ = 0;  // the number of search_.direction; 0: none
  bool probing_ = false;
  std::vector<NodePair> children_;
};

}  // namespace proximity

void begin_search_here(const SceneTrees& trees, const TrianglePair* hint, Search& search,
                       SearchMemory& memory) {
  proximity::Searcher(trees, search, memory).begin(hint);
}
void go_on_here(const SceneTrees& trees, std::size_t most, Search& search, SearchMemory& memory) {
  proximity::Searcher(trees, search, memory).go_on(most);
}

}  // namespace farcull::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace farcull {

HWY_EXPORT(begin_search_here);
HWY_EXPORT(go_on_here);

Search begin_search(const SceneTrees& trees, const ObjectPair& objects, double limit,
                    const TrianglePair* hint, SearchMemory& memory) {
  Search out;
  out.objects = objects;
  out.limit = limit;
  if (trees.tree(objects.a).levels == 0 || trees.tree(objects.b).levels == 0) return out;
  // Making planes takes time for each triangle, so a search with few kept pairs makes no planes.
  const auto count = [&](std::uint32_t object) {
    return trees.scene().objects[object].triangle_count;
  };
  out.kept_most = std::max<std::size_t>(out.kept_most, (count(objects.a) + count(objects.b)) / 4);
  HWY_DYNAMIC_DISPATCH(begin_search_here)(trees, hint, out, memory);
  return out;
}
Search begin_search(const SceneTrees& trees, std::uint32_t object, double limit, Others& others,
                    SearchMemory& memory) {
  Search out;
  out.objects = {object, 0};
  out.limit = limit;
  out.others = &others;
  HWY_DYNAMIC_DISPATCH(begin_search_here)(trees, nullptr, out, memory);
  return out;
}
void go_on(const SceneTrees& trees, std::size_t most, Search& search, SearchMemory& memory) {
  if (search.open.empty()) return;
  HWY_DYNAMIC_DISPATCH(go_on_here)(trees, most, search, memory);
}

}  // namespace farcull
#endif
