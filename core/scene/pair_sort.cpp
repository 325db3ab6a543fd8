// Pairs are put into buckets by their first triangle; the partners of each are sorted or marked.
#include "core/scene/pair_sort.h"

#include <algorithm>
#include <bit>
#include <cstdint>
#include <iterator>
#include <utility>

#include "core/base/parallel.h"

namespace farcull {
namespace {

using Parts = std::span<const std::vector<TrianglePair>>;

// From so many on, the partners of one triangle may be marked instead of sorted.
constexpr std::size_t kMarkFrom = 64;

// Sorts the partners of one triangle and appends its pairs, each once. Many partners among few
// triangles are marked in `bits` instead, whose words are 0 before and after.
void append_partners(std::uint32_t a, std::span<std::uint32_t> partners,
                     std::vector<std::uint64_t>& bits, std::vector<TrianglePair>& out) {
  if (partners.size() >= kMarkFrom) {
    const auto [least, most] = std::minmax_element(partners.begin(), partners.end());
    const std::uint32_t from = *least;
    const std::size_t words = (*most - from) / 64 + 1;
    if (words <= partners.size()) {
      if (bits.size() < words) bits.resize(words, 0);
      for (const std::uint32_t b : partners) {
        bits[(b - from) / 64] |= std::uint64_t{1} << ((b - from) % 64);
      }
      for (std::size_t w = 0; w < words; ++w) {
        for (std::uint64_t rest = std::exchange(bits[w], 0); rest != 0; rest &= rest - 1) {
          out.push_back({a, from + static_cast<std::uint32_t>(64 * w) +
                                static_cast<std::uint32_t>(std::countr_zero(rest))});
        }
      }
      return;
    }
  }
  if (partners.size() > 1) std::sort(partners.begin(), partners.end());
  for (std::size_t k = 0; k < partners.size(); ++k) {
    if (k == 0 || partners[k] != partners[k - 1]) out.push_back({a, partners[k]});
  }
}

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
  // From the back: first[a + 1], the end of the partners of a, becomes their start.
  for (const auto& part : parts) {
    for (const TrianglePair& pair : part) {
      if (pair.a >= from && pair.a < to) partners[--first[pair.a - from + 1]] = pair.b;
    }
  }
  std::vector<TrianglePair> out;
  out.reserve(partners.size());
  std::vector<std::uint64_t> bits;
  for (std::size_t a = 0; a < to - from; ++a) {
    const std::size_t end = a + 2 < first.size() ? first[a + 2] : partners.size();
    append_partners(static_cast<std::uint32_t>(from + a),
                    std::span(partners).subspan(first[a + 1], end - first[a + 1]), bits, out);
  }
  return out;
}

// All pairs of the parts, as sorted_unique(). Calls `release` when the parts are no longer read.
template <class Release>
std::vector<TrianglePair> sorted_of(Parts parts, unsigned threads, const Release& release) {
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
  // Counting takes 32-bit places, and pays unless pairs are few compared with the range.
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
  release();
  if (chunks == 1) return std::move(sorted[0]);
  std::size_t distinct = 0;
  for (const auto& part : sorted) distinct += part.size();
  std::vector<TrianglePair> out;
  out.reserve(distinct);
  for (auto& part : sorted) {
    out.insert(out.end(), part.begin(), part.end());
    std::vector<TrianglePair>().swap(part);  // `= {}` would keep its memory
  }
  return out;
}

}  // namespace

std::vector<TrianglePair> sorted_unique(Parts parts, unsigned threads) {
  return sorted_of(parts, threads, [] {});
}

std::vector<TrianglePair> sorted_unique(std::vector<std::vector<TrianglePair>>&& parts,
                                        unsigned threads) {
  return sorted_of(parts, threads, [&] { parts.clear(); });
}

PairPool::PairPool(std::size_t lists, std::size_t buffer, Narrow narrow)
    : buffer_(buffer),
      narrow_(std::move(narrow)),
      limit_(std::max<std::size_t>(buffer / lists, 1)),
      lists_(lists) {}

std::span<TrianglePair> PairPool::append(std::size_t list, std::size_t count,
                                         const TrianglePair& value) {
  std::vector<TrianglePair>& pairs = lists_[list].pairs;
  const std::size_t before = pairs.size();
  pairs.resize(before + count, value);
  return std::span(pairs).subspan(before);
}

std::size_t PairPool::held() const {
  std::size_t count = distinct_.size();
  for (const List& list : lists_) count += list.pairs.size();
  return count;
}

void PairPool::shrink(std::size_t list) {
  std::vector<TrianglePair> sorted = sorted_unique(std::span(&lists_[list].pairs, 1), 1);
  lists_[list].pairs.clear();
  if (narrow_) narrow_(sorted);
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
