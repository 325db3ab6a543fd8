// Each object is searched with those that follow it and are near enough, by searches whose bound
// stays the limit. They stop often, to count what all of them have found.
#include "core/proximity/pairs_within.h"

#include <algorithm>
#include <atomic>
#include <string>

#include "core/base/error.h"
#include "core/proximity/approach.h"
#include "core/proximity/bounds.h"
#include "core/proximity/split.h"

namespace farcull {
namespace {

/// Pairs of runs between two counts: at most 16,384 pairs of triangles.
constexpr std::size_t kBetweenCounts = 64;

/// What all threads have found. Throws where it is too much.
class Count {
 public:
  explicit Count(std::size_t most) : most_(most) {}
  void add(std::size_t pairs) {
    if (found_.fetch_add(pairs) + pairs <= most_) return;
    throw Error(
        "within",
        "has more than " + std::to_string(most_) +
            " pairs of triangles, which are too many to list",
        "give a smaller distance, or ask for the pairs without their distances: farcull run "
        "{clearance}");
  }

 private:
  std::size_t most_;
  std::atomic<std::size_t> found_ = 0;
};

void add_pairs(const SceneTrees& trees, const ObjectPair& objects, double limit, Count& count,
               SearchMemory& memory, ProximityCounts& counts, std::vector<TrianglePair>& out) {
  Search search = begin_search(trees, objects, limit, nullptr, memory);
  search.everything = true;
  while (!search.open.empty()) {
    go_on(trees, kBetweenCounts, search, memory);
    count.add(search.kept.size());
    for (const KeptPair& kept : search.kept) out.push_back(kept.pair);
    counts.kept += search.kept.size();
    search.kept.clear();
  }
  counts.box_pairs += search.counts.box_pairs;
  counts.triangle_pairs += search.counts.triangle_pairs;
}

}  // namespace

std::vector<TrianglePair> pairs_within(const SceneTrees& trees, double limit, std::size_t most,
                                       unsigned threads, ProximityCounts& counts) {
  const Scene& scene = trees.scene();
  const std::size_t objects = scene.objects.size();
  Count count(most);
  std::vector<std::vector<TrianglePair>> found(objects);
  std::vector<ProximityCounts> parts(objects);
  for_each_with_memory<SearchMemory>(objects, threads, [&](std::size_t o, SearchMemory& memory) {
    const auto object = static_cast<std::uint32_t>(o);
    if (trees.tree(object).levels == 0) return;
    Approach approach(trees, trees.box(object));
    std::uint32_t other = 0;
    while (approach.next(near::square_limit(limit), other)) {
      if (other < object || (other == object && !scene.objects[o].self)) continue;
      add_pairs(trees, {object, other}, limit, count, memory, parts[o], found[o]);
    }
    std::ranges::sort(found[o]);
  });
  std::vector<TrianglePair> out;
  for (std::size_t o = 0; o < objects; ++o) {
    out.insert(out.end(), found[o].begin(), found[o].end());
    found[o] = {};
    counts.box_pairs += parts[o].box_pairs;
    counts.triangle_pairs += parts[o].triangle_pairs;
    counts.kept += parts[o].kept;
  }
  return out;
}

}  // namespace farcull
