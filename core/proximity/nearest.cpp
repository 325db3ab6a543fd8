// Each object asks about the others in the order of the gaps of their boxes, and stops where the
// gap is above the k-th least upper bound so far. Hints give such a bound before.
#include "core/proximity/nearest.h"

#include <algorithm>
#include <limits>
#include <queue>

#include "core/proximity/bounds.h"
#include "core/proximity/search.h"
#include "core/proximity/split.h"

namespace farcull {
namespace {

// What an object found out about another one.
struct Found {
  double lower = 0;  // scaled, of the distance
  double upper = 0;
  double limit = 0;  // of the search
  NearPairs near;
};

double square_of_gap(const Box& a, const Box& b) {
  return (a.lo - b.hi).cwiseMax(b.lo - a.hi).cwiseMax(0).squaredNorm();
}

// Objects in the order of their boxes' gaps from a box.
class Approach {
 public:
  Approach(const SceneTrees& trees, const Box& box) : trees_(trees), box_(box) {
    const BoxTree& tree = trees.objects();
    if (tree.levels > 0) queue_.push({0, tree.levels, 0});
  }
  // False where none is left, or the squared gap is above the limit.
  bool next(double square_limit, std::uint32_t& object) {
    while (!queue_.empty() && queue_.top().square <= square_limit) {
      const Node at = queue_.top();
      queue_.pop();
      if (at.height == 0) {
        object = trees_.object(at.k);
        return true;
      }
      const auto below = static_cast<std::size_t>(at.height - 1);
      const WideBoxes& block = trees_.blocks()[trees_.objects().first[below] + at.k];
      for (std::uint32_t lane = 0; lane < kWide; ++lane) {
        const double square = square_of_gap(block.get(lane), box_);
        if (square <= square_limit) queue_.push({square, at.height - 1, kWide * at.k + lane});
      }
    }
    return false;
  }

 private:
  struct Node {
    double square;
    int height;
    std::uint32_t k;
    bool operator<(const Node& other) const {  // the nearest one is the top
      if (square != other.square) return square > other.square;
      return height != other.height ? height > other.height : k > other.k;
    }
  };
  const SceneTrees& trees_;
  Box box_;
  std::priority_queue<Node> queue_;
};

// The searches that hints begin, sorted by objects.
std::vector<Search> begun_by_hints(const SceneTrees& trees, std::span<const NearHint> hints,
                                   double limit, SearchMemory& memory) {
  std::vector<Search> out;
  out.reserve(hints.size());
  for (const NearHint& hint : hints)
    out.push_back(begin_search(trees, hint.objects, limit, &hint.triangles, memory));
  return out;
}

// The k-th least bound: k other objects are at most so far.
double kth_least_upper(std::span<const Search> searches, std::size_t k) {
  if (searches.size() < k) return std::numeric_limits<double>::infinity();
  std::vector<double> upper;
  for (const Search& search : searches) upper.push_back(search.upper);
  const auto kth = upper.begin() + static_cast<std::ptrdiff_t>(k - 1);
  std::ranges::nth_element(upper, kth);
  return *kth;
}

// The others that may be among the k nearest of an object. hints: those that name it,
// sorted.
std::vector<Found> found_by(const SceneTrees& trees, std::uint32_t object, std::size_t k,
                            double limit, std::span<const NearHint> hints, SearchMemory& memory,
                            ProximityCounts& counts) {
  std::vector<Found> out;
  std::vector<Search> begun = begun_by_hints(trees, hints, limit, memory);
  for (const Search& search : begun) counts.triangle_pairs += search.counts.triangle_pairs;
  limit = std::min(limit, kth_least_upper(begun, k));
  std::vector<double> least;  // the k least upper bounds, as a heap
  const auto bound = [&] { return least.size() < k ? limit : std::min(limit, least.front()); };
  Approach approach(trees, trees.box(object));
  std::uint32_t other = 0;
  while (approach.next(near::square_limit(bound()), other)) {
    if (other == object) continue;
    const ObjectPair objects = {std::min(object, other), std::max(object, other)};
    const double most = bound();
    const auto hinted = std::ranges::lower_bound(begun, objects, {}, &Search::objects);
    Search search;
    if (hinted != begun.end() && hinted->objects == objects) {
      search = std::move(*hinted);
      search.limit = most;
      search.counts = {};  // they were added
    } else {
      search = begin_search(trees, objects, most, nullptr, memory);
    }
    while (!search.open.empty()) {
      go_on(trees, kShort, search, memory);
      require_room(trees, search);
    }
    Found found = {.limit = most, .near = answer(trees, search)};
    counts.box_pairs += search.counts.box_pairs;
    counts.triangle_pairs += search.counts.triangle_pairs;
    if (search.kept.empty()) continue;
    found.lower = std::ranges::min_element(search.kept, {}, &KeptPair::lower)->lower;
    found.upper = std::ranges::min_element(search.kept, {}, &KeptPair::upper)->upper;
    least.push_back(found.upper);
    std::ranges::push_heap(least);
    if (least.size() > k) {
      std::ranges::pop_heap(least);
      least.pop_back();
    }
    out.push_back(std::move(found));
  }
  std::erase_if(out, [most = bound()](const Found& f) { return f.lower > most; });
  return out;
}

}  // namespace

std::vector<NearPairs> nearest_objects(const SceneTrees& trees, std::size_t k, double limit,
                                       std::span<const NearHint> hints, unsigned threads,
                                       ProximityCounts& counts) {
  if (k == 0) return {};
  const std::size_t objects = trees.scene().objects.size();
  std::vector<std::vector<NearHint>> hints_of(objects);
  for (const NearHint& hint : hints) {
    hints_of[hint.objects.a].push_back(hint);
    hints_of[hint.objects.b].push_back(hint);
  }
  std::vector<std::vector<Found>> found(objects);
  std::vector<ProximityCounts> parts(objects);
  for_each_with_memory(objects, threads, [&](std::size_t o, SearchMemory& memory) {
    const auto object = static_cast<std::uint32_t>(o);
    if (trees.tree(object).levels == 0) return;
    found[o] = found_by(trees, object, k, limit, hints_of[o], memory, parts[o]);
  });
  std::vector<Found> all;
  for (std::size_t o = 0; o < objects; ++o) {
    counts.box_pairs += parts[o].box_pairs;
    counts.triangle_pairs += parts[o].triangle_pairs;
    std::ranges::move(found[o], std::back_inserter(all));
  }
  // Two objects may both have found each other. An answer holds all nearest pairs only where they
  // are within its limit, which is so for one of them at least: so for that of the larger limit.
  std::ranges::stable_sort(all, [](const Found& x, const Found& y) {
    if (x.near.objects != y.near.objects) return x.near.objects < y.near.objects;
    return x.limit > y.limit;
  });
  std::vector<NearPairs> out;
  for (Found& f : all) {
    if (!out.empty() && out.back().objects == f.near.objects) continue;
    counts.kept += f.near.pairs.size();
    out.push_back(std::move(f.near));
  }
  return out;
}

}  // namespace farcull
