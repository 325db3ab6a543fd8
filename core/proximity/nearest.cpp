// Each object asks about the others in the order of the gaps of their boxes, and stops where the
// gap is above the k-th least upper bound so far. Hints give such a bound before.
#include "core/proximity/nearest.h"

#include <algorithm>
#include <limits>

#include "core/proximity/approach.h"
#include "core/proximity/bounds.h"
#include "core/proximity/search.h"
#include "core/proximity/split.h"

namespace farcull {
namespace {

// Bounds of the distance of one other object.
struct Found {
  double lower = 0;  // scaled, of the distance
  double upper = 0;
  double limit = 0;  // of the search
  NearPairs near;
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
// sorted. all: also those that are as near and have higher numbers.
std::vector<Found> found_by(const SceneTrees& trees, std::uint32_t object, std::size_t k,
                            double limit, std::span<const NearHint> hints, bool all,
                            SearchMemory& memory, ProximityCounts& counts) {
  std::vector<Found> out;
  std::vector<Search> begun = begun_by_hints(trees, hints, limit, memory);
  for (const Search& search : begun) counts.triangle_pairs += search.counts.triangle_pairs;
  limit = std::min(limit, kth_least_upper(begun, k));
  std::vector<double> least;  // the k least upper bounds, as a heap
  const auto bound = [&] { return least.size() < k ? limit : std::min(limit, least.front()); };
  Approach approach(trees, trees.box(object));
  std::uint32_t other = 0;
  std::size_t meeting = 0;
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
      go_on(trees, kRunPairsAtOnce, search, memory);
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
    // Others that overlap come in the order of their numbers. Once k of them meet this object,
    // those that follow are not nearer, and have higher numbers.
    meeting += found.upper == 0;
    out.push_back(std::move(found));
    if (!all && meeting == k) break;
  }
  std::erase_if(out, [most = bound()](const Found& f) { return f.lower > most; });
  return out;
}

}  // namespace

std::vector<NearPairs> nearest_objects(const SceneTrees& trees, std::size_t k, double limit,
                                       std::span<const NearHint> hints, bool all, unsigned threads,
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
  for_each_with_memory<SearchMemory>(objects, threads, [&](std::size_t o, SearchMemory& memory) {
    const auto object = static_cast<std::uint32_t>(o);
    if (trees.tree(object).levels == 0) return;
    found[o] = found_by(trees, object, k, limit, hints_of[o], all, memory, parts[o]);
  });
  std::vector<Found> founds;
  for (std::size_t o = 0; o < objects; ++o) {
    counts.box_pairs += parts[o].box_pairs;
    counts.triangle_pairs += parts[o].triangle_pairs;
    std::ranges::move(found[o], std::back_inserter(founds));
  }
  // Two objects may both have found each other. An answer holds all nearest pairs only where they
  // are within its limit, which is so for one of them at least: so for that of the larger limit.
  std::ranges::stable_sort(founds, [](const Found& x, const Found& y) {
    if (x.near.objects != y.near.objects) return x.near.objects < y.near.objects;
    return x.limit > y.limit;
  });
  std::vector<NearPairs> out;
  for (Found& f : founds) {
    if (!out.empty() && out.back().objects == f.near.objects) continue;
    counts.kept += f.near.pairs.size();
    out.push_back(std::move(f.near));
  }
  return out;
}

}  // namespace farcull
