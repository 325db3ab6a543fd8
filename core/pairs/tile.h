// The pairs of one tile of the window, on one core: those whose intervals overlap in one of its
// pixels. Crowded pixels are cut into parts first.
#pragma once

#include <algorithm>
#include <array>
#include <atomic>
#include <bit>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "core/base/stopwatch.h"
#include "core/pairs/backend.h"
#include "core/pairs/grid.h"
#include "core/pairs/lists.h"
#include "core/pairs/sweep.h"
#include "core/scene/pair_sort.h"

namespace farcull {

/// Counts work of several threads. Whether the total is beyond the limit does not depend on the
/// order of the threads, and each thread sees it soon.
class WorkLimit {
 public:
  explicit WorkLimit(std::uint64_t most = UINT64_MAX) : most_(most) {}
  void add(std::uint64_t work) { done_.fetch_add(work, std::memory_order_relaxed); }
  bool exceeded() const { return done_.load(std::memory_order_relaxed) > most_; }
  std::uint64_t left() const {
    const std::uint64_t done = done_.load(std::memory_order_relaxed);
    return done > most_ ? 0 : most_ - done;
  }

 private:
  std::uint64_t most_;
  std::atomic<std::uint64_t> done_ = 0;
};

/// The rules by which a pair is passed over. Tests replace them by wrong rules, which lose pairs.
struct TileRules {
  /// True: a pair is settled also where its intervals do not overlap.
  static constexpr bool kSettlesApart = false;
  /// Bits of a whole triangle in a pixel: 1 if it has pixels of this tile to the left as well, 2 if
  /// below. Two triangles with a bit in common have an earlier common pixel, which reports them.
  static std::uint32_t begun(bool left, bool below) { return (left ? 1 : 0) | (below ? 2 : 0); }
};

/// Works on tiles one after the other; keeps its buffers.
template <class Rules = TileRules>
class TileWorker {
 public:
  /// Begins a window, whose pairs go to a list of the pool. More entries than `memory` holds
  /// (bytes) split a tile.
  /// work: of all threads together; beyond its limit a tile is left as it is, and its pairs are not
  /// all there. Null: without a limit.
  void begin(const PairGrid& grid, bool masked, std::size_t memory, PairPool& pool,
             std::size_t list, WorkLimit* work = nullptr);
  /// Adds the pairs of a tile, which may repeat. `items`: those that may meet it, ascending by
  /// triangle. `masked`, of begin(): leaves out entries whose slices no other owner touches.
  void run(const PairTile& tile, std::span<const PairItem> items, PairCounts& counts);

 private:
  using Shown = TileLists::Shown;
  using Entry = TileLists::Entry;

  // Longer lists are sorted by near depth, so that the partners of an entry stand together.
  static constexpr std::size_t kSortFrom = 224;
  // Pairs of such lists are looked up in the table of settled pairs if the list is crowded, or if
  // more than kRepeatedFrom pairs were added for each listed triangle, so that most must be
  // repeats: then the table costs little in comparison.
  static constexpr std::size_t kRepeatedFrom = 32;
  // The part of a worker's memory that the table may take.
  static constexpr std::size_t kSettledPart = 8;

  /// The place at which the pairs of a list are reported.
  struct Place {
    bool pixel;  // a whole pixel that is not crowded
    int i, j;
  };

  static bool meet(const Entry& a, const Shown& s, const Entry& b, const Shown& t);
  bool left_out(const Shown& a, const Shown& b) const;
  void split(const PairTile& tile, std::span<const PairItem> items, PairCounts& counts);
  void pair_pixel(std::span<Entry> entries, int i, int j);
  void pair_cell(std::span<Entry> entries, float x, float y, float size, int level);
  bool subdivide(std::span<Entry> entries, float x, float y, float size, int level);
  void sweep(std::span<Entry> entries, const Place& place);
  void fill_columns(std::span<const Entry> entries, const Place& place);
  bool reported_elsewhere(const Shown& a, const Shown& b, const Place& here) const;
  void keep(std::span<const TrianglePair> found, std::span<const Entry> entries,
            const Place& place);
  bool number_entries(std::span<const Entry> entries);
  bool sweep_unsettled(std::span<const Entry> entries);

  bool go_on(std::uint64_t done);

  const PairGrid* grid_ = nullptr;
  WorkLimit* work_ = nullptr;
  std::uint64_t done_ = 0;  // work that is not in work_ yet
  bool masked_ = false;
  std::size_t memory_ = 0;
  PairPool* pool_ = nullptr;
  std::size_t pool_list_ = 0;
  PairTile tile_{};
  PairCounts* counts_ = nullptr;
  TileLists lists_;
  SettledPairs settled_;
  std::size_t added_ = 0, listed_ = 0;  // pairs and triangles of the window up to now
  bool some_crowded_ = false;           // pixels of the tile
  SweepColumns columns_;
  std::vector<TrianglePair> found_;
  // For one list: the number of each entry, the entry of each number, and the numbers to come.
  std::vector<std::uint32_t> numbers_, places_;
  std::vector<std::uint64_t> to_come_;
};

// Adds work; false: all threads together are beyond the limit.
template <class Rules>
bool TileWorker<Rules>::go_on(std::uint64_t done) {
  constexpr std::uint64_t kAtOnce = 1 << 14;
  if (work_ == nullptr) return true;
  if ((done_ += done) >= kAtOnce) work_->add(std::exchange(done_, 0));
  return !work_->exceeded();
}

// True where the bounds in the image and the intervals overlap.
template <class Rules>
bool TileWorker<Rules>::meet(const Entry& a, const Shown& s, const Entry& b, const Shown& t) {
  return a.near <= b.far && b.near <= a.far && s.x0 <= t.x1 && t.x0 <= s.x1 && s.y0 <= t.y1 &&
         t.y0 <= s.y1;
}

// Whether two triangles are neighbours and the task does not ask for such pairs.
template <class Rules>
bool TileWorker<Rules>::left_out(const Shown& a, const Shown& b) const {
  if (grid_->task().neighbours || a.owner != b.owner) return false;
  return share_index(a.vertices, b.vertices);
}

// Fills the columns of a sweep. `begun` (TileRules) keeps pairs of whole triangles from repeats.
// Two whole triangles overlap in all their common pixels or in none. Only the first of these in
// this tile, the lower left corner of the common rectangle, reports them. Both are listed in that
// pixel if they are listed here: a list leaves an entry out by its slices alone. These are the same
// in all pixels of a whole triangle, and two triangles that overlap in depth have a common slice,
// which is in conflict in every pixel that both meet. Bounds are cut to the limits before, so the
// limits are the same everywhere. If the first pixel is crowded, this one reports them too, since
// their intervals may be finer there.
template <class Rules>
void TileWorker<Rules>::fill_columns(std::span<const Entry> entries, const Place& place) {
  constexpr std::uint32_t kAlone = 0x80000000;  // a group of one
  const PairTask& task = grid_->task();
  const bool first_only = place.pixel && !some_crowded_;
  columns_.start(entries.size());
  std::uint32_t position = 0;
  for (const Entry& entry : entries) {
    const Shown& s = lists_.shown(entry.shown);
    const bool left = s.i0 < place.i && place.i > tile_.i0;
    const bool below = s.j0 < place.j && place.j > tile_.j0;
    columns_.add({.x0 = s.x0,
                  .y0 = s.y0,
                  .near = entry.near,
                  .x1 = s.x1,
                  .y1 = s.y1,
                  .far = entry.far,
                  .id = some_crowded_ && place.pixel ? position : s.triangle,
                  .group = task.self[s.owner] ? kAlone | position : s.owner,
                  .begun = first_only && s.whole ? Rules::begun(left, below) : 0,
                  .owner = s.owner,
                  .v0 = s.vertices[0],
                  .v1 = s.vertices[1],
                  .v2 = s.vertices[2]});
    ++position;
  }
  columns_.finish();
}

// Whether the first common pixel of two triangles is another one that reports them.
template <class Rules>
bool TileWorker<Rules>::reported_elsewhere(const Shown& a, const Shown& b,
                                           const Place& here) const {
  if (!a.whole || !b.whole) return false;
  const int i = std::max({static_cast<int>(a.i0), static_cast<int>(b.i0), tile_.i0});
  const int j = std::max({static_cast<int>(a.j0), static_cast<int>(b.j0), tile_.j0});
  if (i == here.i && j == here.j) return false;
  return lists_.size(static_cast<std::size_t>(j - tile_.j0) * tile_.width() + (i - tile_.i0)) <=
         kCrowded;
}

// Puts pairs that a sweep found into the pool; in a tile with crowded pixels, by index.
template <class Rules>
void TileWorker<Rules>::keep(std::span<const TrianglePair> found, std::span<const Entry> entries,
                             const Place& place) {
  if (!some_crowded_ || !place.pixel) {
    added_ += found.size();
    pool_->add(pool_list_, found);
    return;
  }
  for (const TrianglePair& pair : found) {
    const Shown& a = lists_.shown(entries[pair.a].shown);
    const Shown& b = lists_.shown(entries[pair.b].shown);
    if (reported_elsewhere(a, b, place)) continue;
    ++added_;
    pool_->add(pool_list_, {std::min(a.triangle, b.triangle), std::max(a.triangle, b.triangle)});
  }
}

// Reports each two entries that meet and whose triangles may collide. Sorts a long list first.
template <class Rules>
void TileWorker<Rules>::sweep(std::span<Entry> entries, const Place& place) {
  const std::size_t n = entries.size();
  const bool sorted = n > kSortFrom;
  if (sorted) {
    std::sort(entries.begin(), entries.end(),
              [](const Entry& x, const Entry& y) { return x.near < y.near; });
    const bool repeats = n > kCrowded || added_ > kRepeatedFrom * listed_;
    if (repeats && sweep_unsettled(entries)) return;
  }
  fill_columns(entries, place);
  if (found_.size() < n + kSweepPadding) found_.resize(2 * n + 64 * kSweepPadding);
  Sweep state{&columns_, sorted, !grid_->task().neighbours};
  std::uint64_t tests = 0;
  while (state.next < n && go_on(state.tests - tests)) {
    tests = state.tests;
    keep(std::span(found_).first(sweep_on(state, found_)), entries, place);
  }
  go_on(state.tests - tests);
  counts_->tests += state.tests;
}

// Gives the entries their numbers in the table of settled pairs. False: too many.
template <class Rules>
bool TileWorker<Rules>::number_entries(std::span<const Entry> entries) {
  const std::size_t n = entries.size();
  if (!settled_.reserve(n)) return false;
  numbers_.resize(n);
  for (std::size_t x = 0; x < n; ++x) {
    Shown& item = lists_.shown(entries[x].shown);
    if (item.round != settled_.round()) {
      item.number = settled_.number(item.triangle);
      item.round = settled_.round();
    }
    numbers_[x] = item.number;
  }
  const std::size_t words = settled_.words();
  places_.resize(64 * words);
  to_come_.assign(words, 0);
  for (std::size_t x = 0; x < n; ++x) {
    places_[numbers_[x]] = static_cast<std::uint32_t>(x);
    to_come_[numbers_[x] / 64] |= std::uint64_t{1} << (numbers_[x] % 64);
  }
  return true;
}

// sweep() for a long list, sorted by near depth: a pair that is settled is passed over, and one
// that is looked at becomes settled. False: the list is too long.
//
// The partners of an entry are the entries behind it up to its far depth. Reading a row of the
// table costs about an eighth of a test for each word. So the row is read only if it is much
// shorter than the list of partners, and used only if it leaves fewer partners: the sweep is never
// much slower than without the table.
//
// Nothing is lost: a pair is looked at where its intervals overlap. It is kept there, or no pixel
// will ever keep it, because of its owners, because nobody asks for neighbours, or because the
// bounds in the image, which are the same in all pixels, are apart. A pair whose intervals do not
// overlap here is not settled. The pool holds kept pairs until the whole window is done, and the
// bits are forgotten before the next window. The rule of whole triangles (fill_columns()) is not
// needed here, since the bits already prevent repeats.
template <class Rules>
bool TileWorker<Rules>::sweep_unsettled(std::span<const Entry> entries) {
  const std::size_t n = entries.size();
  if (!number_entries(entries)) return false;
  const std::size_t words = settled_.words();
  const PairTask& task = grid_->task();
  for (std::size_t x = 0; x + 1 < n; ++x) {
    const Entry a = entries[x];
    const Shown& s = lists_.shown(a.shown);
    const std::uint32_t number = numbers_[x];
    to_come_[number / 64] &= ~(std::uint64_t{1} << (number % 64));
    const std::size_t end = static_cast<std::size_t>(
        std::upper_bound(entries.begin() + static_cast<std::ptrdiff_t>(x) + 1, entries.end(), a.far,
                         [](float far, const Entry& y) { return far < y.near; }) -
        entries.begin());
    const bool self = task.self[s.owner] != 0;
    const auto look = [&](std::size_t y) {
      const Entry& b = entries[y];
      const Shown& t = lists_.shown(b.shown);
      settled_.settle(number, numbers_[y]);
      if ((!self && t.owner == s.owner) || !meet(a, s, b, t) || left_out(s, t)) return;
      ++added_;
      pool_->add(pool_list_, {std::min(s.triangle, t.triangle), std::max(s.triangle, t.triangle)});
    };
    if constexpr (Rules::kSettlesApart) {
      for (std::size_t y = end; y < n; ++y) settled_.settle(number, numbers_[y]);
    }
    const std::span<const std::uint64_t> row = settled_.row(number);
    std::size_t left = end - x - 1;
    // Settled pairs are counted too: which are settled depends on threads.
    if (!go_on(left)) return true;
    if (left > 2 * words) {
      std::size_t unsettled = 0;
      for (std::size_t w = 0; w < words; ++w) {
        unsettled += static_cast<std::size_t>(std::popcount(to_come_[w] & ~row[w]));
      }
      if (unsettled < left) {
        counts_->tests += unsettled;
        for (std::size_t w = 0; w < words; ++w) {
          for (std::uint64_t rest = to_come_[w] & ~row[w]; rest != 0; rest &= rest - 1) {
            const std::size_t y =
                places_[64 * w + static_cast<std::size_t>(std::countr_zero(rest))];
            if (y < end) look(y);
          }
        }
        continue;
      }
    }
    counts_->tests += left;
    for (std::size_t y = x + 1; y < end; ++y) {
      if (!settled_.settled(number, numbers_[y])) look(y);
    }
  }
  return true;
}

template <class Rules>
void TileWorker<Rules>::pair_pixel(std::span<Entry> entries, int i, int j) {
  if (entries.size() > kCrowded) {
    ++counts_->crowded;
    pair_cell(entries, static_cast<float>(i), static_cast<float>(j), 1, 0);
    return;
  }
  sweep(entries, {.pixel = true, .i = i, .j = j});
}

template <class Rules>
void TileWorker<Rules>::pair_cell(std::span<Entry> entries, float x, float y, float size,
                                  int level) {
  if (entries.size() > kCrowded && level < kMaxLevel && subdivide(entries, x, y, size, level)) {
    return;
  }
  sweep(entries, {.pixel = false, .i = 0, .j = 0});
}

// Cuts a crowded cell, unless that leaves more than half of the tests.
template <class Rules>
bool TileWorker<Rules>::subdivide(std::span<Entry> entries, float x, float y, float size,
                                  int level) {
  constexpr int kCells = kSubdivision * kSubdivision;
  const float part = size / kSubdivision;
  std::vector<TileLists::RawEntry> raw;
  std::array<std::uint32_t, kCells + 1> first{};
  const auto index = [parts_per_px = 1 / part](float p, float from) {
    return interval::far_part(p, from, parts_per_px, kSubdivision - 1);
  };
  for (const Entry& entry : entries) {
    const Shown& item = lists_.shown(entry.shown);
    const PairBounds b = item.bounds();
    const int i0 = index(b.lo.x, x), i1 = index(b.hi.x, x);
    const int j0 = index(b.lo.y, y), j1 = index(b.hi.y, y);
    const auto add = [&](int i, int j, float near, float far) {
      const auto cell = static_cast<std::uint32_t>(j * kSubdivision + i);
      raw.push_back({cell, {entry.shown, near, far}});
      ++first[cell + 1];
    };
    if ((i1 - i0 + 1) * (j1 - j0 + 1) <= kWholePixels) {
      for (int j = j0; j <= j1; ++j) {
        for (int i = i0; i <= i1; ++i) add(i, j, entry.near, entry.far);
      }
      continue;
    }
    PairRows rows(*grid_, item.triangle, b);
    for (int j = j0; j <= j1; ++j) {
      float lo, hi;
      const float y0 = y + static_cast<float>(j) * part;
      if (!rows.row(y0, y0 + part, lo, hi)) continue;
      for (int i = index(lo, x); i <= index(hi, x); ++i) {
        float near, far;
        const float x0 = x + static_cast<float>(i) * part;
        if (!rows.depths(x0, x0 + part, near, far)) continue;
        near = std::max(near, entry.near);
        far = std::min(far, entry.far);
        if (near <= far) add(i, j, near, far);
      }
    }
  }
  const auto tests = [](std::uint64_t n) { return n * (n - std::min<std::uint64_t>(n, 1)) / 2; };
  std::uint64_t left = 0;
  for (int c = 0; c < kCells; ++c) left += tests(first[c + 1]);
  if (2 * left > tests(entries.size())) return false;

  counts_->entries += raw.size();
  if (!go_on(raw.size())) return true;
  for (int c = 0; c < kCells; ++c) first[c + 1] += first[c];
  std::vector<Entry> sorted(raw.size());
  std::array<std::uint32_t, kCells + 1> next = first;
  for (const TileLists::RawEntry& part_of : raw) {
    sorted[next[part_of.cell]++] = part_of.entry;
  }
  for (int c = 0; c < kCells; ++c) {
    const std::size_t n = first[c + 1] - first[c];
    if (n < 2) continue;
    pair_cell(std::span(sorted).subspan(first[c], n),
              x + static_cast<float>(c % kSubdivision) * part,
              y + static_cast<float>(c / kSubdivision) * part, part, level + 1);
  }
  return true;
}

template <class Rules>
void TileWorker<Rules>::begin(const PairGrid& grid, bool masked, std::size_t memory, PairPool& pool,
                              std::size_t list, WorkLimit* work) {
  grid_ = &grid;
  work_ = work;
  done_ = 0;
  lists_.begin(grid);
  masked_ = masked;
  memory_ = memory;
  pool_ = &pool;
  pool_list_ = list;
  settled_.start(memory / kSettledPart);
  added_ = listed_ = 0;
}

template <class Rules>
void TileWorker<Rules>::split(const PairTile& tile, std::span<const PairItem> items,
                              PairCounts& counts) {
  PairTile low = tile, high = tile;
  if (tile.height() > 1) {
    low.j1 = tile.j0 + tile.height() / 2 - 1;
    high.j0 = low.j1 + 1;
  } else {
    low.i1 = tile.i0 + tile.width() / 2 - 1;
    high.i0 = low.i1 + 1;
  }
  ++counts.bands;
  run(low, items, counts);
  run(high, items, counts);
}

template <class Rules>
void TileWorker<Rules>::run(const PairTile& tile, std::span<const PairItem> items,
                            PairCounts& counts) {
  tile_ = tile;
  counts_ = &counts;
  if (!go_on(0)) return;
  const std::size_t cells = static_cast<std::size_t>(tile.width()) * tile.height();
  const std::size_t fixed = cells * (2 * sizeof(std::uint64_t) + sizeof(std::uint32_t));
  // Lists grow by doubling; a triangle has at least one entry.
  const std::size_t entry_bytes = 2 * (sizeof(TileLists::RawEntry) + sizeof(Shown)) + sizeof(Entry);
  // A single pixel is done whatever it takes.
  const std::size_t limit = cells == 1        ? SIZE_MAX
                            : memory_ > fixed ? (memory_ - fixed) / entry_bytes
                                              : 0;
  const Stopwatch start;
  bool fits = limit > 0;
  if (fits) {
    const std::size_t last = masked_ ? lists_.mark(tile, items) : 0;
    counts.mark_ms += start.ms();
    const Stopwatch listing;
    // Entries are work, so no more are listed than may be done.
    const std::uint64_t most = work_ ? work_->left() : UINT64_MAX;
    fits =
        lists_.list(tile, items, last, masked_,
                    static_cast<std::size_t>(std::min<std::uint64_t>({limit, UINT32_MAX, most})));
    counts.list_ms += listing.ms();
    if (!fits && most < limit) work_->add(most + 1);
  }
  if (!fits) {
    split(tile, items, counts);
    return;
  }
  listed_ += lists_.shown_count();
  counts.listed += lists_.shown_count();
  counts.entries += lists_.size();
  const Stopwatch pairing;
  some_crowded_ = false;
  for (std::size_t c = 0; c < cells; ++c) some_crowded_ |= lists_.size(c) > kCrowded;
  go_on(lists_.size());
  for (std::size_t c = 0; c < cells; ++c) {
    if (lists_.size(c) < 2) continue;
    if (!go_on(0)) break;
    pair_pixel(lists_.entries(c), tile.i0 + static_cast<int>(c % tile.width()),
               tile.j0 + static_cast<int>(c / tile.width()));
  }
  counts.pair_ms += pairing.ms();
  if (work_) work_->add(std::exchange(done_, 0));
}

}  // namespace farcull
