#include "core/pair_sort.h"

#include <algorithm>
#include <cstdint>

#include "core/parallel.h"

namespace farcull {
namespace {

using Parts = std::span<const std::vector<TrianglePair>>;

// The pairs with from <= a < to: counted by a, so that only the few partners of each triangle are
// left to sort.
std::vector<TrianglePair> sorted_range(Parts parts, std::uint64_t from, std::uint64_t to) {
  std::vector<std::uint32_t> first(to - from + 1, 0);
  for (const auto& part : parts) {
    for (const TrianglePair& pair : part) {
      if (pair.a >= from && pair.a < to) ++first[pair.a - from + 1];
    }
  }
  for (std::size_t a = 0; a + 1 < first.size(); ++a) first[a + 1] += first[a];
  std::vector<std::uint32_t> partners(first.back());
  // From the back: first[a + 1], the end of the partners of a, ends as their start.
  for (const auto& part : parts) {
    for (const TrianglePair& pair : part) {
      if (pair.a >= from && pair.a < to) partners[--first[pair.a - from + 1]] = pair.b;
    }
  }
  std::vector<TrianglePair> out;
  out.reserve(partners.size());
  for (std::size_t a = 0; a < to - from; ++a) {
    std::uint32_t* const begin = partners.data() + first[a + 1];
    std::uint32_t* const end =
        partners.data() + (a + 2 < first.size() ? first[a + 2] : partners.size());
    if (end - begin > 1) std::sort(begin, end);
    for (std::uint32_t* b = begin; b != end; ++b) {
      if (b == begin || *b != *(b - 1)) out.push_back({static_cast<std::uint32_t>(from + a), *b});
    }
  }
  return out;
}

}  // namespace

std::vector<TrianglePair> sorted_unique(Parts parts, unsigned threads) {
  std::uint64_t least = UINT64_MAX, most = 0;
  std::size_t total = 0;
  for (const auto& part : parts) {
    total += part.size();
    for (const TrianglePair& pair : part) {
      least = std::min<std::uint64_t>(least, pair.a);
      most = std::max<std::uint64_t>(most, pair.a);
    }
  }
  if (total == 0) return {};
  const std::uint64_t range = most - least + 1;
  // Counting takes 32-bit places and is worth while where pairs are not few among the triangles.
  if (total < range / 16 || total > UINT32_MAX) {
    std::vector<TrianglePair> out;
    out.reserve(total);
    for (const auto& part : parts) out.insert(out.end(), part.begin(), part.end());
    std::sort(out.begin(), out.end());
    out.erase(std::unique(out.begin(), out.end()), out.end());
    return out;
  }
  const std::size_t chunks = chunks_for(total, 4096, threads);
  std::vector<std::vector<TrianglePair>> sorted(chunks);
  for_chunks(range, chunks, [&](std::size_t chunk, std::size_t begin, std::size_t end) {
    sorted[chunk] = sorted_range(parts, least + begin, least + end);
  });
  std::vector<TrianglePair> out = std::move(sorted[0]);
  for (std::size_t k = 1; k < chunks; ++k) {
    out.insert(out.end(), sorted[k].begin(), sorted[k].end());
  }
  return out;
}

}  // namespace farcull
