// A long search is divided into a fixed number of parts, which begin with the same bound and take
// nothing from each other; after a while they are joined, and what is left is divided again.
#include "core/proximity/split.h"

#include <cmath>
#include <limits>
#include <string>

#include "core/base/error.h"

namespace farcull {
namespace {

constexpr std::size_t kParts = 32;

// Deals the open pairs to searches of their own, which begin with the bound of this one.
std::vector<Search> divide(Search& search) {
  std::vector<Search> out(std::min(kParts, search.open.size()));
  for (Search& part : out) {
    part.objects = search.objects;
    part.limit = search.limit;
    part.upper = search.upper;
    part.first = search.first;
    part.direction = search.direction;
  }
  // The last one is looked at first, in each part as well.
  const std::size_t n = search.open.size();
  for (std::size_t k = 0; k < n; ++k) {
    out[(n - 1 - k) % out.size()].open.push_back(search.open[k]);
  }
  search.open.clear();
  return out;
}

// Adds what a part found, and what it left open, to the search that it came from.
void join(Search& part, Search& search) {
  if (part.upper < search.upper) {
    search.upper = part.upper;
    search.direction = part.direction;
  }
  search.first = std::min(search.first, part.first);
  search.open.insert(search.open.end(), part.open.begin(), part.open.end());
  search.kept.insert(search.kept.end(), part.kept.begin(), part.kept.end());
  search.counts.box_pairs += part.counts.box_pairs;
  search.counts.triangle_pairs += part.counts.triangle_pairs;
  part = Search();
}

}  // namespace

double scaled_limit(const SceneTrees& trees, double within) {
  // A product that is subnormal is rounded; and the next number is not below the exact one.
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
                                         go_on(trees, kRunPairsAtOnce, parts[k], memory);
                                       });
    for (Search& part : parts) join(part, search);
    search.filter();
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
  // A quotient that is subnormal is rounded.
  out.upper = std::nextafter(upper / trees.scale(), std::numeric_limits<double>::infinity());
  return out;
}

}  // namespace farcull
