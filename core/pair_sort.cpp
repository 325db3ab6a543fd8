#include "core/pair_sort.h"

#include <algorithm>

namespace farcull {

void sort_unique(std::vector<TrianglePair>& pairs, std::size_t triangles) {
  if (pairs.size() < triangles / 16) {
    std::sort(pairs.begin(), pairs.end());
    pairs.erase(std::unique(pairs.begin(), pairs.end()), pairs.end());
    return;
  }
  // Counted by a; each triangle has few partners, which are sorted on their own.
  std::vector<std::size_t> first(triangles + 1, 0);
  for (const TrianglePair& pair : pairs) ++first[pair.a + 1];
  for (std::size_t a = 0; a < triangles; ++a) first[a + 1] += first[a];
  std::vector<std::uint32_t> partners(pairs.size());
  {
    std::vector<std::size_t> next(first.begin(), first.end() - 1);
    for (const TrianglePair& pair : pairs) partners[next[pair.a]++] = pair.b;
  }
  std::size_t kept = 0;
  for (std::size_t a = 0; a < triangles; ++a) {
    const auto begin = partners.begin() + static_cast<std::ptrdiff_t>(first[a]);
    const auto end = partners.begin() + static_cast<std::ptrdiff_t>(first[a + 1]);
    std::sort(begin, end);
    for (auto b = begin; b != end; ++b) {
      if (b == begin || *b != *(b - 1)) pairs[kept++] = {static_cast<std::uint32_t>(a), *b};
    }
  }
  pairs.resize(kept);
}

}  // namespace farcull
