// Implements a bucket sort with one bucket per first triangle. Sorts each bucket by the second
// triangle, or marks the second triangles as bits.
#include "core/scene/pair_sort.h"

#include <bit>
#include <cstdint>
#include <iterator>

#include "core/base/parallel.h"

namespace farcull {
namespace {

using Parts = std::span<const std::vector<TrianglePair>>;

// With at least this many pairs, second triangles may be marked as bits instead of sorted.
constexpr std::size_t kMarkFrom = 64;

// Sorts pairs that have the same first triangle, moves the distinct pairs to the front, and returns
// their number. If many second triangles lie in a small range, marks them in `bits` instead of
// sorting. All words of `bits` must be 0 before the call, and are 0 after the call.
std::size_t sort_partners(std::span<TrianglePair> pairs, std::vector<std::uint64_t>& bits) {
  if (pairs.size() >= kMarkFrom) {
    const auto [least, most] = std::ranges::minmax_element(pairs);
    const std::uint32_t from = least->b;
    const std::size_t words = (most->b - from) / 64 + 1;
    if (words <= pairs.size()) {
      if (bits.size() < words) bits.resize(words, 0);
      for (const TrianglePair& pair : pairs)
        bits[(pair.b - from) / 64] |= std::uint64_t{1} << ((pair.b - from) % 64);
      std::size_t count = 0;
      for (std::size_t w = 0; w < words; ++w) {
        for (std::uint64_t rest = std::exchange(bits[w], 0); rest != 0; rest &= rest - 1) {
          pairs[count++].b = from + static_cast<std::uint32_t>(64 * w) +
                             static_cast<std::uint32_t>(std::countr_zero(rest));
        }
      }
      return count;
    }
  }
  if (pairs.size() > 1) std::ranges::sort(pairs, {}, &TrianglePair::b);
  const auto after = std::ranges::unique(pairs).begin();
  return static_cast<std::size_t>(after - pairs.begin());
}

// Handles the pairs with from <= a < to. After count(), first[k] of these pairs have a < from + k.
struct Range {
  std::uint64_t from = 0, to = 0;
  std::vector<std::uint32_t> first = {};

  void count(Parts parts) {
    first.assign(to - from + 1, 0);
    for (const auto& part : parts) {
      for (const TrianglePair& pair : part) {
        if (pair.a >= from && pair.a < to) ++first[pair.a - from + 1];
      }
    }
    for (std::size_t a = 0; a + 1 < first.size(); ++a) first[a + 1] += first[a];
  }
  std::size_t size() const { return first.back(); }

  // Sorts the pairs into `out`, which has room for size() pairs. Returns the number of distinct
  // pairs, which are at the front of `out`.
  std::size_t sort(Parts parts, std::span<TrianglePair> out) {
    // Group k contains the pairs with a == from + k. Fills each group from its end, so that first[k
    // + 1] becomes the start of group k.
    for (const auto& part : parts) {
      for (const TrianglePair& pair : part) {
        if (pair.a >= from && pair.a < to) out[--first[pair.a - from + 1]] = pair;
      }
    }
    std::vector<std::uint64_t> bits;
    std::size_t distinct = 0;
    for (std::size_t a = 0; a < to - from; ++a) {
      const std::size_t begin = first[a + 1],
                        end = a + 2 < first.size() ? first[a + 2] : out.size();
      const std::size_t own = sort_partners(out.subspan(begin, end - begin), bits);
      if (distinct < begin) std::copy_n(out.begin() + begin, own, out.begin() + distinct);
      distinct += own;
    }
    return distinct;
  }
};

// Implements sorted_unique(). If `given` is not null, empties it once all parts are read.
std::vector<TrianglePair> sorted_of(Parts parts, unsigned threads,
                                    std::vector<std::vector<TrianglePair>>* given) {
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
  const std::uint64_t span = most - least + 1;
  std::vector<TrianglePair> out;
  // Range counts in 32 bits. For few pairs in a large range of `a`, std::sort is faster.
  if (total < span / 16 || total > UINT32_MAX) {
    out.reserve(total);
    for (const auto& part : parts) out.insert(out.end(), part.begin(), part.end());
    std::sort(out.begin(), out.end());
    out.erase(std::unique(out.begin(), out.end()), out.end());
    return out;
  }
  const std::size_t chunks = chunks_for(total, 4096, threads);
  std::vector<Range> ranges(chunks);
  std::vector<std::size_t> first(chunks + 1, 0), distinct(chunks);
  for_chunks(span, chunks, [&](std::size_t chunk, std::size_t begin, std::size_t end) {
    ranges[chunk] = {.from = least + begin, .to = least + end};
    ranges[chunk].count(parts);
  });
  for (std::size_t k = 0; k < chunks; ++k) first[k + 1] = first[k] + ranges[k].size();
  out.resize(total);
  for_chunks(chunks, chunks, [&](std::size_t chunk, std::size_t, std::size_t) {
    distinct[chunk] =
        ranges[chunk].sort(parts, std::span(out).subspan(first[chunk], ranges[chunk].size()));
  });
  if (given != nullptr) given->clear();
  std::size_t count = 0;
  for (std::size_t k = 0; k < chunks; ++k) {
    if (count < first[k]) std::copy_n(out.begin() + first[k], distinct[k], out.begin() + count);
    count += distinct[k];
  }
  out.resize(count);
  return out;
}

}  // namespace

std::vector<TrianglePair> sorted_unique(Parts parts, unsigned threads) {
  return sorted_of(parts, threads, nullptr);
}

std::vector<TrianglePair> sorted_unique(std::vector<std::vector<TrianglePair>>&& parts,
                                        unsigned threads) {
  return sorted_of(parts, threads, &parts);
}

void GatheredPairs::add(std::span<const TrianglePair> some) {
  while (!some.empty()) {
    if (parts_.empty() || parts_.back().size() == kPart) parts_.emplace_back().reserve(kPart);
    const std::size_t count = std::min(kPart - parts_.back().size(), some.size());
    parts_.back().insert(parts_.back().end(), some.begin(),
                         some.begin() + static_cast<std::ptrdiff_t>(count));
    some = some.subspan(count);
  }
}

PairPool::PairPool(std::size_t lists, std::size_t buffer)
    : buffer_(buffer), limit_(std::max<std::size_t>(buffer / lists, 1)), lists_(lists) {}

std::size_t PairPool::held() const {
  std::size_t count = distinct_.size();
  for (const List& list : lists_) count += list.pairs.size();
  return count;
}

void PairPool::shrink(std::size_t list) {
  std::vector<TrianglePair> sorted = sorted_unique(std::span(&lists_[list].pairs, 1), 1);
  lists_[list].pairs.clear();
  const std::lock_guard lock(mutex_);
  std::vector<TrianglePair> all;
  all.reserve(distinct_.size() + sorted.size());
  std::set_union(distinct_.begin(), distinct_.end(), sorted.begin(), sorted.end(),
                 std::back_inserter(all));
  distinct_ = std::move(all);
  limit_ = std::max<std::size_t>(std::max(buffer_, distinct_.size()) / lists_.size(), 1);
}

std::vector<TrianglePair> PairPool::take(unsigned threads) {
  std::vector<std::vector<TrianglePair>> parts;
  for (List& list : lists_) parts.push_back(std::move(list.pairs));
  lists_.clear();
  if (!distinct_.empty()) parts.push_back(std::exchange(distinct_, {}));
  return sorted_unique(std::move(parts), threads);
}

}  // namespace farcull
