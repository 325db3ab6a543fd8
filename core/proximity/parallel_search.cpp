// Divides long searches into a fixed number of parts. The parts begin with the same bound and share
// no results. After a while they are joined, and the rest is divided again.
#include <algorithm>
#include <limits>
#include <memory>
#include <string>

#include "core/base/error.h"
#include "core/base/parallel.h"
#include "core/proximity/scene_trees.h"

namespace farcull {

void Others::add(const TrianglePair& pair, double bound) {
  if (bound > upper()) return;
  const std::uint32_t other = other_of(pair);
  const auto same = std::ranges::find(nearest, other, &std::pair<double, std::uint32_t>::second);
  if (same != nearest.end()) {
    if (same->first <= bound) return;
    nearest.erase(same);
  }
  const std::pair entry(bound, other);
  nearest.insert(std::ranges::lower_bound(nearest, entry), entry);
  if (nearest.size() > k) nearest.pop_back();
  if (!ties && upper() == 0) {
    const Object& last = scene.objects[nearest.back().second];
    end = last.first_triangle + last.triangle_count;
  }
}

void settle(const SceneTrees& trees, Search& search) {
  if (!trees.settle()) return;
  std::vector<TrianglePair> pairs;
  pairs.reserve(search.kept.size());
  for (const KeptPair& kept : search.kept) pairs.push_back(kept.pair);
  std::ranges::sort(pairs);
  const SettledPair settled = trees.settle()(pairs);
  KeptPair kept = *std::ranges::find(search.kept, settled.pair, &KeptPair::pair);
  kept.upper =
      std::min(kept.upper, settled.distance == 0 ? 0 : scaled_limit(trees, settled.distance));
  search.upper = std::min(search.upper, kept.upper);
  search.kept.assign(1, kept);
  search.settled = settled.pair;
  if (settled.distance == 0) {
    search.first = std::min(search.first, settled.pair);
  } else if (!search.is_part && (!search.planes || search.planes->pair != settled.pair)) {
    const auto back = [&](std::uint32_t triangle) { return -settled.start(triangle); };
    search.planes = std::make_shared<const Planes>(
        Planes{settled.pair, Reaches(trees, search.objects.a, settled.reach),
               Reaches(trees, search.objects.b, back)});
  }
}

void Search::filter() {
  std::erase_if(kept, [this, most = bound()](const KeptPair& k) {
    return k.lower > most || is_behind(k.pair);
  });
}

namespace {

constexpr std::size_t kParts = 32;

// Deals the open pairs out to new searches, which begin with the bound of this one.
std::vector<Search> divide(Search& search) {
  std::vector<Search> out(std::min(kParts, search.open.size()));
  for (Search& part : out) {
    part.objects = search.objects;
    part.limit = search.limit;
    part.upper = search.upper;
    part.first = search.first;
    part.direction = search.direction;
    part.settled = search.settled;
    part.planes = search.planes;
    part.is_part = true;
    const auto settled = std::ranges::find(search.kept, search.settled, &KeptPair::pair);
    if (settled != search.kept.end()) part.kept.push_back(*settled);
  }
  // The last open pair is examined first, also in each part: the order is kept.
  const std::size_t n = search.open.size();
  for (std::size_t k = 0; k < n; ++k) out[(n - 1 - k) % out.size()].open.push_back(search.open[k]);
  search.open.clear();
  return out;
}

// Adds the pairs that a part found or left open to the search that it came from.
void join(Search& part, Search& search) {
  if (part.upper < search.upper) {
    search.upper = part.upper;
    search.direction = part.direction;
  }
  search.first = std::min(search.first, part.first);
  search.open.insert(search.open.end(), part.open.begin(), part.open.end());
  for (const KeptPair& kept : part.kept) {
    if (kept.pair != search.settled) search.kept.push_back(kept);
  }
  search.counts.add_work(part.counts);
  part = Search();
}

}  // namespace

double scaled_limit(const SceneTrees& trees, double within) {
  // A subnormal product is rounded, but the next larger number is at least the exact product.
  return std::nextafter(within * trees.scale(), std::numeric_limits<double>::infinity());
}

void require_room(const SceneTrees& trees, const Search& search, std::size_t most) {
  if (search.kept.size() <= most) return;
  throw Error(trees.scene().name,
              "more than " + std::to_string(most) + " pairs of triangles of the objects " +
                  std::to_string(search.objects.a) + " and " + std::to_string(search.objects.b) +
                  " may be nearest",
              "leave one of the objects out, or drop triangles that are there twice");
}

void go_on_divided(const SceneTrees& trees, unsigned threads, Search& search, std::size_t most) {
  while (!search.open.empty()) {
    std::vector<Search> parts = divide(search);
    for_each_with_memory<SearchMemory>(parts.size(), threads,
                                       [&](std::size_t k, SearchMemory& memory) {
                                         go_on(trees, kLeafPairsAtOnce, parts[k], memory);
                                       });
    for (Search& part : parts) join(part, search);
    search.filter();
    if (2 * search.kept.size() > search.kept_most) settle(trees, search);
    require_room(trees, search, most);
  }
}

NearPairs answer(const SceneTrees& trees, Search& search) {
  search.filter();
  search.counts.kept = search.kept.size();
  NearPairs out;
  out.objects = search.objects;
  double upper = std::numeric_limits<double>::infinity();
  out.pairs.reserve(search.kept.size());
  for (const KeptPair& k : search.kept) {
    out.pairs.push_back(k.pair);
    upper = std::min(upper, k.upper);
  }
  std::ranges::sort(out.pairs);
  // A subnormal quotient is rounded, but the next larger number is at least the exact quotient.
  out.upper = std::nextafter(upper / trees.scale(), std::numeric_limits<double>::infinity());
  return out;
}

}  // namespace farcull
