// Branch and bound on the lanes of this processor. Every instruction set rounds alike, so all find
// the same in the same order.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "core/proximity/search.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include <algorithm>
#include <bit>

#include "core/proximity/box_gaps-inl.h"
#include "core/proximity/search.h"
#include "core/proximity/triangle_pairs-inl.h"

HWY_BEFORE_NAMESPACE();
namespace farcull::HWY_NAMESPACE {
namespace proximity {

class Searcher {
 public:
  Searcher(const SceneTrees& trees, Search& search, SearchMemory& memory)
      : trees_(trees),
        search_(search),
        memory_(memory),
        a_(trees.tree(search.objects.a)),
        b_(trees.tree(search.objects.b)),
        self_(search.objects.a == search.objects.b) {
    Box both = a_.box;
    both.add(b_.box);
    origin_ = 0.5 * both.lo + 0.5 * both.hi;
    // A difference is off by u of itself; near::kGap has room for it.
    extent_ = (both.hi - origin_).cwiseMax(origin_ - both.lo);
    new_bound();
    new_direction();
  }

  void begin(const TrianglePair* hint) {
    search_.open.push_back(
        {0, 0, 0, static_cast<std::uint8_t>(a_.levels), static_cast<std::uint8_t>(b_.levels)});
    probing_ = true;  // these pairs are met again
    if (hint != nullptr && counts(hint->a, hint->b)) {
      add_hint(*hint);
      flush();
    } else if (!self_) {
      descend();
    }
    probing_ = false;
  }

  void go_on(std::size_t most) {
    std::size_t looked_at = 0;
    while (!search_.open.empty() && looked_at < most) {
      const NodePair at = search_.open.back();
      search_.open.pop_back();
      if (at.square > square_limit_ || is_behind(at)) continue;
      if (at.a_height == 0 && at.b_height == 0) {
        compare_runs(at);
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
  // Of nodes as near, those with the lower triangles come first: where the objects meet, the first
  // pair is the answer.
  bool comes_first(const NodePair& x, const NodePair& y) const {
    const TrianglePair p = least(x), q = least(y);
    if (p != q) return p < q;
    return x.a != y.a ? x.a > y.a : x.b > y.b;
  }
  TrianglePair least(const NodePair& at) const {
    return {trees_.least(search_.objects.a, at.a_height, at.a),
            trees_.least(search_.objects.b, at.b_height, at.b)};
  }
  // Whether all pairs of the nodes come behind one that meets for certain.
  bool is_behind(const NodePair& at) const {
    if (search_.first.a == UINT32_MAX) return false;
    const TrianglePair lowest = least(at);
    // Of one object either node may hold the lower triangle.
    return self_ ? search_.is_behind({std::min(lowest.a, lowest.b), 0}) : search_.is_behind(lowest);
  }

  // Down to the pair of runs that seems nearest, and from their nearest corners to a first bound.
  void descend() {
    NodePair at = search_.open.back();
    while (at.a_height > 0 || at.b_height > 0) {
      children_.clear();
      expand(at, near::kMostSquare, children_);
      at = *std::ranges::min_element(children_, {}, &NodePair::square);
    }
    const RunCorners& a = load(memory_.a, trees_.run(search_.objects.a, at.a));
    const RunCorners& b = load(memory_.b, trees_.run(search_.objects.b, at.b));
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

  // Pairs of children that are not too far apart. The higher node is divided, or both.
  HWY_INLINE void expand(const NodePair& at, double limit, std::vector<NodePair>& out) {
    alignas(64) Gaps squares;
    const auto a_height = static_cast<std::uint8_t>(at.a_height - (at.a_height >= at.b_height));
    const auto b_height = static_cast<std::uint8_t>(at.b_height - (at.b_height >= at.a_height));
    if (at.a_height < at.b_height) {
      const OneBox box = box_of(a_, at.a_height, at.a);
      std::uint32_t bits = near_boxes(children(b_, at.b_height, at.b), box, limit, squares);
      while (bits != 0) {
        const std::size_t j = next_bit(bits);
        out.push_back({squares[j], at.a, child(at.b, j), a_height, b_height});
      }
      count_boxes(1);
      return;
    }
    const WideBoxes& own = children(a_, at.a_height, at.a);
    if (at.a_height > at.b_height) {
      std::uint32_t bits = near_boxes(own, box_of(b_, at.b_height, at.b), limit, squares);
      while (bits != 0) {
        const std::size_t i = next_bit(bits);
        out.push_back({squares[i], child(at.a, i), at.b, a_height, b_height});
      }
      count_boxes(1);
      return;
    }
    const WideBoxes& other = children(b_, at.b_height, at.b);
    std::uint32_t columns = near_boxes(other, box_of(a_, at.a_height, at.a), limit, squares);
    count_boxes(1 + static_cast<std::size_t>(std::popcount(columns)));
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
  const WideBoxes& children(const BoxTree& tree, std::size_t height, std::uint32_t k) const {
    return trees_.blocks()[tree.first[height - 1] + k];
  }
  HWY_INLINE OneBox box_of(const BoxTree& tree, std::size_t height, std::uint32_t k) const {
    if (height == static_cast<std::size_t>(tree.levels)) return OneBox(tree.box);
    return OneBox(trees_.blocks()[tree.first[height] + k / kWide], k % kWide);
  }
  void count_boxes(std::size_t blocks) { search_.counts.box_pairs += kWide * blocks; }

  // The pairs of triangles of two runs that may be near go into the batch.
  HWY_INLINE void compare_runs(const NodePair& at) {
    RunCorners& a = load(memory_.a, trees_.run(search_.objects.a, at.a));
    RunCorners& b = load(memory_.b, trees_.run(search_.objects.b, at.b));
    // The batch may change the direction while the rows are compared.
    const bool directed = direction_ != 0;
    const double gap_limit = gap_limit_;
    if (directed) {
      if (a.direction != direction_) project(a, true);
      if (b.direction != direction_) project(b, false);
      if (b.most_extreme - a.most_extreme > gap_limit) return;
    }
    alignas(64) Gaps squares;
    std::uint32_t rows = near_boxes(a.boxes, box_of(b_, 0, at.b), square_limit_, squares);
    const std::uint32_t columns = near_boxes(b.boxes, box_of(a_, 0, at.a), square_limit_, squares);
    count_boxes(2 + static_cast<std::size_t>(std::popcount(rows)));
    const bool same = self_ && at.a == at.b;
    while (rows != 0) {
      const std::size_t i = next_bit(rows);
      std::uint32_t bits =
          columns & near_boxes(b.boxes, OneBox(a.boxes, i), square_limit_, squares);
      if (same) bits &= ~((2u << i) - 1);
      if (directed) bits &= before(b.extreme, a.extreme[i], gap_limit);
      while (bits != 0) add(a, i, b, next_bit(bits));
    }
  }

  // Bits of the triangles that begin at most gap_limit behind `place` along the direction.
  HWY_INLINE std::uint32_t before(const std::array<double, kBatch>& extreme, double place,
                                  double gap_limit) const {
    const Numbers n;
    std::uint32_t out = 0;
    for (std::size_t from = 0; from < kBatch; from += kLanes) {
      std::uint8_t bytes[8] = {};
      const Number gap = hn::Sub(hn::Load(n, &extreme[from]), number(place));
      hn::StoreMaskBits(n, hn::Le(gap, number(gap_limit)), bytes);
      out |= static_cast<std::uint32_t>(bytes[0]) << from;
    }
    return out;
  }

  // Where the triangles of a run end along the direction.
  HWY_INLINE void project(RunCorners& run, bool most) const {
    const Numbers n;
    const Vec3& d = search_.direction;
    const Point direction = {number(d[0]), number(d[1]), number(d[2])};
    const Point origin = {number(origin_[0]), number(origin_[1]), number(origin_[2])};
    for (std::size_t from = 0; from < kBatch; from += kLanes) {
      const auto place = [&](std::size_t corner) {
        return dot(LaneTriangle::load(run.corner, corner, from) - origin, direction);
      };
      const Number p = place(0), q = place(1), r = place(2);
      hn::Store(most ? hn::Max(hn::Max(p, q), r) : hn::Min(hn::Min(p, q), r), n,
                &run.extreme[from]);
    }
    const auto end = run.extreme.begin() + run.count;
    run.most_extreme = most ? *std::max_element(run.extreme.begin(), end)
                            : *std::min_element(run.extreme.begin(), end);
    run.direction = direction_;
  }

  // The run from the cache; it is loaded first where it is missing.
  RunCorners& load(std::vector<RunCorners>& memory, std::uint32_t run) const {
    RunCorners& out = memory[run % SearchMemory::kRuns];
    if (out.run != run) load_run(trees_, run, out);
    return out;
  }

  bool counts(std::uint32_t a, std::uint32_t b) const {
    return !self_ || !share_position(trees_.scene(), a, b);
  }
  void add(const RunCorners& a, std::size_t i, const RunCorners& b, std::size_t j) {
    const std::uint32_t first = a.triangle[i], second = b.triangle[j];
    // The bounds of two triangles depend on their order in the last digits.
    if (first > second) return add(b, j, a, i);
    if (search_.is_behind({first, second}) || !counts(first, second)) return;
    PairBatch& batch = memory_.batch;
    for (std::size_t k = 0; k < 9; ++k) {
      batch.a[k][batch.count] = a.corner[k][i];
      batch.b[k][batch.count] = b.corner[k][j];
    }
    batch.pairs[batch.count] = {first, second};
    if (++batch.count == kBatch) flush();
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

  // Bounds the pairs of the batch.
  HWY_INLINE void flush() {
    PairBatch& batch = memory_.batch;
    if (batch.count == 0) return;
    BatchBounds bounds;
    bound_batch(batch, bounds);
    find_common_corners(bounds);
    search_.counts.triangle_pairs += batch.count;
    const double before = search_.upper;
    std::size_t best = kBatch;
    for (std::size_t k = 0; k < batch.count; ++k) {
      if (bounds.upper[k] == 0) search_.first = std::min(search_.first, batch.pairs[k]);
      if (!(bounds.upper[k] < search_.upper)) continue;
      search_.upper = bounds.upper[k];
      best = k;
    }
    if (best < kBatch) {
      new_bound();
      // Where many pairs are as near, the bound sinks by roundings; then the direction stays.
      if (direction_ == 0 || search_.upper < before * (1 - 0x1p-20)) {
        search_.direction = {bounds.direction[0][best], bounds.direction[1][best],
                             bounds.direction[2][best]};
        new_direction();
      }
    }
    if (!probing_) keep(bounds);
    batch.count = 0;
  }
  // Triangles of two objects that have a corner in common meet. No edge need pierce a face then, as
  // of equal objects and of fans, so that bounds do not tell.
  void find_common_corners(BatchBounds& bounds) const {
    if (self_) return;
    const PairBatch& batch = memory_.batch;
    for (std::size_t k = 0; k < batch.count; ++k) {
      const auto& [a, b] = batch.pairs[k];
      if (bounds.lower[k] == 0 && bounds.upper[k] != 0 && share_position(trees_.scene(), a, b))
        bounds.upper[k] = 0;
    }
  }
  void keep(const BatchBounds& bounds) {
    const double bound = search_.bound();
    for (std::size_t k = 0; k < memory_.batch.count; ++k) {
      if (bounds.lower[k] > bound || search_.is_behind(memory_.batch.pairs[k])) continue;
      search_.kept.push_back({memory_.batch.pairs[k], bounds.lower[k], bounds.upper[k]});
    }
    if (search_.kept.size() <= search_.kept_most) return;
    search_.filter();
    search_.kept_most = std::max<std::size_t>(search_.kept_most, 2 * search_.kept.size());
  }

  void new_bound() {
    square_limit_ = near::square_limit(search_.bound());
    set_gap_limit();
  }
  void new_direction() {
    const Vec3& d = search_.direction;
    // The triangles of one object are near in all directions.
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
  const BoxTree& a_;
  const BoxTree& b_;
  bool self_;
  Vec3 origin_, extent_;
  double square_limit_ = 0, gap_limit_ = 0;
  std::uint64_t direction_ = 0;  // of search_.direction; 0: none
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
  HWY_DYNAMIC_DISPATCH(begin_search_here)(trees, hint, out, memory);
  return out;
}
void go_on(const SceneTrees& trees, std::size_t most, Search& search, SearchMemory& memory) {
  if (search.open.empty()) return;
  HWY_DYNAMIC_DISPATCH(go_on_here)(trees, most, search, memory);
}

void Search::filter() {
  std::erase_if(kept, [this, most = bound()](const KeptPair& k) {
    return k.lower > most || is_behind(k.pair);
  });
}

}  // namespace farcull
#endif
