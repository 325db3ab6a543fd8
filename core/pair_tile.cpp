#include "core/pair_tile.h"
#include "core/stopwatch.h"

#include <array>
#include <bit>
#include <cmath>

namespace farcull {
namespace {

using interval::FarStrip;

// Longer lists are sorted by near depth and swept.
constexpr std::size_t kSweepFrom = 64;
// Pairs of lists this long are looked up in the table of settled ones.
constexpr std::size_t kSettleFrom = 128;
// They are where a list is crowded, or where so many pairs were added for each listed triangle that
// most of them must be the same ones again: what the table costs is little then.
constexpr std::size_t kRepeatedFrom = 32;
// The part of a worker's memory that the table may take.
constexpr std::size_t kSettledPart = 8;
// Triangles are fetched this far ahead, since their corners may lie anywhere.
constexpr std::size_t kAhead = 8;

// The slices first .. last as bits.
std::uint64_t slice_bits(int first, int last) {
  return (~std::uint64_t{0} >> (kSlices - 1 - last)) & (~std::uint64_t{0} << first);
}

// The strip of one triangle over rows of pixels or sub-pixels, and its intervals in them.
class Rows {
 public:
  Rows(const PairGrid& grid, std::uint32_t triangle, const PairBounds& bounds)
      : bounds_(bounds),
        a_(grid.corner(triangle, 0)),
        b_(grid.corner(triangle, 1)),
        c_(grid.corner(triangle, 2)) {
    const PairBounds real = grid.real_bounds(triangle);
    margin_ = interval::far_margin(real.lo, real.hi, grid.task().widening);
  }
  /// The range along x of the real triangle between the rows' borders; false: none.
  bool row(float y0, float y1, float& lo, float& hi) {
    interval::far_strip(a_, b_, c_, y0 - margin_.y, y1 + margin_.y, strip_);
    lo = std::max(strip_.lo - margin_.x, bounds_.lo.x);
    hi = std::min(strip_.hi + margin_.x, bounds_.hi.x);
    return lo <= hi;
  }
  /// The interval over a rectangle of the row; false: none.
  bool depths(float x0, float x1, float& near, float& far) {
    if (!interval::far_depths(strip_, x0 - margin_.x, x1 + margin_.x, near, far)) return false;
    near = std::max(near - margin_.z, bounds_.lo.z);
    far = std::min(far + margin_.z, bounds_.hi.z);
    return near <= far;
  }

 private:
  PairBounds bounds_;
  interval::vec4 a_, b_, c_;
  interval::vec4 margin_;
  FarStrip strip_;
};

}  // namespace

PairGrid::PairGrid(const PairTask& task)
    : task_(task), slices_per_px_(kSlices / std::max(task.far_px - task.near_px, 0x1p-20f)) {}

// Calls visit(cell, slices, near, far, whole) for every pixel of the tile that the item may meet;
// near and far are set where the item is not whole.
template <class Visit>
void PairTileWorker::for_each_pixel(const PairItem& item, const Visit& visit) const {
  const int i0 = std::max<int>(item.i0, tile_.i0), i1 = std::min<int>(item.i1, tile_.i1);
  const int j0 = std::max<int>(item.j0, tile_.j0), j1 = std::min<int>(item.j1, tile_.j1);
  if (i0 > i1 || j0 > j1) return;
  const int width = tile_.width();
  if (item.whole) {
    const std::uint64_t bits = slice_bits(item.s0, item.s1);
    for (int j = j0; j <= j1; ++j) {
      const std::uint32_t row = static_cast<std::uint32_t>((j - tile_.j0) * width - tile_.i0);
      for (int i = i0; i <= i1; ++i) visit(row + static_cast<std::uint32_t>(i), bits, 0.f, 0.f);
    }
    return;
  }
  Rows rows(*grid_, item.triangle, grid_->bounds(item.triangle));
  for (int j = j0; j <= j1; ++j) {
    float lo, hi;
    const float y = static_cast<float>(j);
    if (!rows.row(y, y + 1, lo, hi)) continue;
    const int from = std::max(i0, static_cast<int>(interval::clamp(lo, 0, 65536)));
    const int to = std::min(i1, static_cast<int>(interval::clamp(hi, 0, 65536)));
    const std::uint32_t row = static_cast<std::uint32_t>((j - tile_.j0) * width - tile_.i0);
    for (int i = from; i <= to; ++i) {
      const float x = static_cast<float>(i);
      float near, far;
      if (!rows.depths(x, x + 1, near, far)) continue;
      visit(row + static_cast<std::uint32_t>(i), slice_bits(grid_->slice(near), grid_->slice(far)),
            near, far);
    }
  }
}

// Owner by owner: first what meets the slices of earlier owners, then the owner's own slices. What
// the last owner meets is left to list(): returns where that owner's items begin.
std::size_t PairTileWorker::mark(std::span<const PairItem> items) {
  const std::size_t cells = static_cast<std::size_t>(tile_.width()) * tile_.height();
  any_.assign(cells, 0);
  conflict_.assign(cells, 0);
  const PairTask& task = grid_->task();
  std::size_t begin = 0, end = 0;
  for (; begin < items.size(); begin = end) {
    const std::uint32_t owner = task.owners[items[begin].triangle];
    while (end < items.size() && task.owners[items[end].triangle] == owner) ++end;
    if (end == items.size()) break;
    const bool self = task.self[owner] != 0;
    if (self || begin > 0) {
      for (std::size_t k = begin; k < end; ++k) {
        for_each_pixel(items[k], [&](std::uint32_t cell, std::uint64_t bits, float, float) {
          conflict_[cell] |= self ? bits : any_[cell] & bits;
        });
      }
    }
    for (std::size_t k = begin; k < end; ++k) {
      for_each_pixel(items[k], [&](std::uint32_t cell, std::uint64_t bits, float, float) {
        any_[cell] |= bits;
      });
    }
  }
  return begin;
}

// The lists of the tile's pixels, the last owner's items (from `last` on) before the others, since
// they complete the conflicts; false: more than `limit` entries.
bool PairTileWorker::list(std::span<const PairItem> items, std::size_t last, bool masked,
                          std::size_t limit) {
  const PairTask& task = grid_->task();
  const std::size_t cells = static_cast<std::size_t>(tile_.width()) * tile_.height();
  first_.assign(cells + 2, 0);
  raw_.clear();
  shown_.clear();
  // Lists one item; meets(cell, slices) says whether it has an entry there.
  const auto add = [&](const PairItem& item, const auto& meets) {
    const std::uint32_t next = static_cast<std::uint32_t>(shown_.size());
    const std::size_t before = raw_.size();
    for_each_pixel(item, [&](std::uint32_t cell, std::uint64_t bits, float near, float far) {
      if (!meets(cell, bits)) return;
      raw_.push_back({cell, next, near, far});
      ++first_[cell + 1];
    });
    if (raw_.size() == before) return;
    shown_.push_back(
        {item.triangle, task.owners[item.triangle], task.triangles[item.triangle], {}, item.whole});
  };
  if (masked && last < items.size()) {
    const bool self = task.self[task.owners[items[last].triangle]] != 0;
    for (std::size_t k = last; k < items.size() && raw_.size() <= limit; ++k) {
      add(items[k], [&](std::uint32_t cell, std::uint64_t bits) {
        const std::uint64_t common = self ? bits : bits & any_[cell];
        conflict_[cell] |= common;
        return common != 0;
      });
    }
    items = items.first(last);
  }
  for (std::size_t k = 0; k < items.size() && raw_.size() <= limit; ++k) {
    if (masked) {
      add(items[k],
          [&](std::uint32_t cell, std::uint64_t bits) { return (conflict_[cell] & bits) != 0; });
    } else {
      add(items[k], [](std::uint32_t, std::uint64_t) { return true; });
    }
  }
  if (raw_.size() > limit) return false;
  for (std::size_t k = 0; k < shown_.size(); ++k) {
    grid_->prefetch(shown_[std::min(k + kAhead, shown_.size() - 1)].triangle);
    shown_[k].bounds = grid_->bounds(shown_[k].triangle);
  }
  for (std::size_t c = 0; c < cells; ++c) first_[c + 1] += first_[c];
  first_[cells + 1] = static_cast<std::uint32_t>(raw_.size());
  entries_.resize(raw_.size());
  // From the back, so that first_[c + 1], the end of list c, ends as its start.
  for (std::size_t k = raw_.size(); k-- > 0;) {
    const RawEntry& raw = raw_[k];
    const Shown& shown = shown_[raw.shown];
    entries_[--first_[raw.cell + 1]] = entry(raw.shown, shown.whole ? shown.bounds.lo.z : raw.near,
                                             shown.whole ? shown.bounds.hi.z : raw.far);
  }
  return true;
}

PairTileWorker::Entry PairTileWorker::entry(std::uint32_t index, float near, float far) const {
  const Shown& shown = shown_[index];
  const PairBounds& b = shown.bounds;
  return {b.lo.x, b.lo.y, near, index | (shown.whole ? kWholeBit : 0),
          b.hi.x, b.hi.y, far,  shown.owner};
}

// Whether the bounds in the image and the intervals overlap.
bool PairTileWorker::meet(const Entry& a, const Entry& b) {
#ifdef __SSE2__
  const __m128 a_lo = _mm_load_ps(&a.x0), a_hi = _mm_load_ps(&a.x1);
  const __m128 b_lo = _mm_load_ps(&b.x0), b_hi = _mm_load_ps(&b.x1);
  const __m128 apart = _mm_or_ps(_mm_cmpgt_ps(a_lo, b_hi), _mm_cmpgt_ps(b_lo, a_hi));
  return (_mm_movemask_ps(apart) & 7) == 0;
#else
  return a.near <= b.far && b.near <= a.far && a.x0 <= b.x1 && b.x0 <= a.x1 && a.y0 <= b.y1 &&
         b.y0 <= a.y1;
#endif
}

// Neighbours that the task does not ask for.
bool PairTileWorker::left_out(const Shown& a, const Shown& b) const {
  if (grid_->task().neighbours || a.owner != b.owner) return false;
  const auto& [p, q, r] = b.vertices;
  bool shared = false;
  for (const std::uint32_t v : a.vertices) shared |= (v == p) | (v == q) | (v == r);
  return shared;
}

// Calls emit for each two entries that meet and whose triangles may collide. Entries of an
// owner stand together; long lists are put into another order.
template <class Emit>
void PairTileWorker::sweep(std::span<Entry> entries, const Emit& emit) {
  const std::size_t n = entries.size();
  const PairTask& task = grid_->task();
  if (n <= kSweepFrom) {
    for (std::size_t begin = 0, end = 0; begin < n; begin = end) {
      const std::uint32_t owner = entries[begin].owner;
      while (end < n && entries[end].owner == owner) ++end;
      const bool self = task.self[owner] != 0;
      for (std::size_t x = begin; x < end; ++x) {
        const Entry a = entries[x];
        const std::size_t from = self ? x + 1 : end;
        counts_->tests += n - from;
        for (std::size_t y = from; y < n; ++y) {
          if (meet(a, entries[y])) emit(a, entries[y]);
        }
      }
    }
    return;
  }
  std::sort(entries.begin(), entries.end(),
            [](const Entry& x, const Entry& y) { return x.near < y.near; });
  const bool repeats = n > kCrowded || added_ > kRepeatedFrom * listed_;
  if (n >= kSettleFrom && repeats && sweep_unsettled(entries)) return;
  for (std::size_t x = 0; x + 1 < n; ++x) {
    const Entry a = entries[x];
    const bool self = task.self[a.owner] != 0;
    std::size_t y = x + 1;
    for (; y < n && entries[y].near <= a.far; ++y) {
      if ((self || entries[y].owner != a.owner) && meet(a, entries[y])) emit(a, entries[y]);
    }
    counts_->tests += y - x - 1;
  }
}

// The same for a long list, in order by near depth: a pair that is settled is passed over, and one
// that is looked at becomes settled. False: too long.
//
// The partners of an entry are those behind it up to its far depth. Reading a row of the table
// costs about an eighth of a test for each word, so the row is read only where it is much shorter
// than the partners, and used only where it leaves fewer of them: never much slower than without
// the table.
//
// Nothing is lost: a pair is looked at where its intervals overlap. It is kept there, or no pixel
// will ever keep it, because of its owners, because nobody asks for neighbours, or because the
// bounds in the image, which are the same in all pixels, are apart. A pair whose intervals do not
// overlap here is not settled. The pool holds kept pairs until the whole window is done, and the
// bits are forgotten before the next one. The rule of whole triangles is not needed here, since the
// bits say the same.
bool PairTileWorker::sweep_unsettled(std::span<const Entry> entries) {
  const std::size_t n = entries.size();
  if (!settled_.make_room(n)) return false;
  numbers_.resize(n);
  for (std::size_t x = 0; x < n; ++x) {
    Shown& item = shown(entries[x]);
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
  const PairTask& task = grid_->task();
  for (std::size_t x = 0; x + 1 < n; ++x) {
    const Entry a = entries[x];
    const std::uint32_t number = numbers_[x];
    to_come_[number / 64] &= ~(std::uint64_t{1} << (number % 64));
    const std::size_t end = static_cast<std::size_t>(
        std::upper_bound(entries.begin() + static_cast<std::ptrdiff_t>(x) + 1, entries.end(), a.far,
                         [](float far, const Entry& y) { return far < y.near; }) -
        entries.begin());
    const bool self = task.self[a.owner] != 0;
    const auto look = [&](std::size_t y) {
      const Entry& b = entries[y];
      settled_.settle(number, numbers_[y]);
      if ((self || b.owner != a.owner) && meet(a, b)) keep(a, b);
    };
    if (fault == TileFault::settled_apart) {
      for (std::size_t y = end; y < n; ++y) settled_.settle(number, numbers_[y]);
    }
    const std::span<const std::uint64_t> row = settled_.row(number);
    std::size_t left = end - x - 1;
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

void PairTileWorker::pair_pixel(std::span<Entry> entries, int i, int j) {
  if (entries.size() > kCrowded) {
    ++counts_->crowded;
    pair_cell(entries, static_cast<float>(i), static_cast<float>(j), 1, 0);
    return;
  }
  // Two whole triangles overlap in all their common pixels or in none: the first of these alone, in
  // the lower left corner of the common rectangle, reports them. Both are listed there if they are
  // here: a list leaves an entry out by its slices alone, which are the same in all pixels of a
  // whole triangle, and two that overlap in depth have a common slice, which is in conflict in
  // every pixel that both meet. Bounds are cut to the limits before, so the limits are the same
  // everywhere. Where that pixel lies in another tile (of another band or part of the window) this
  // one reports them too, and where it is crowded, since their intervals may be finer there.
  const auto elsewhere = [&](const Entry& a, const Entry& b) {
    const auto first = [](float p, int count) {
      return static_cast<int>(interval::clamp(p, 0, static_cast<float>(count - 1)));
    };
    const bool right = fault != TileFault::wrong_pixel;
    const int ri = first(right ? std::max(a.x0, b.x0) : std::min(a.x0, b.x0), grid_->task().width);
    const int rj = first(right ? std::max(a.y0, b.y0) : std::min(a.y0, b.y0), grid_->task().height);
    if ((ri == i && rj == j) || ri < tile_.i0 || rj < tile_.j0) return false;
    const std::size_t c = static_cast<std::size_t>(rj - tile_.j0) * tile_.width() + (ri - tile_.i0);
    return first_[c + 2] - first_[c + 1] <= kCrowded;
  };
  sweep(entries, [&](const Entry& a, const Entry& b) {
    if ((a.shown & b.shown & kWholeBit) == 0 || !elsewhere(a, b)) keep(a, b);
  });
}

void PairTileWorker::keep(const Entry& a, const Entry& b) {
  const Shown &s = shown(a), &t = shown(b);
  if (left_out(s, t)) return;
  ++added_;
  pool_->add(pool_list_, {std::min(s.triangle, t.triangle), std::max(s.triangle, t.triangle)});
}

void PairTileWorker::pair_cell(std::span<Entry> entries, float x, float y, float size, int level) {
  if (entries.size() > kCrowded && level < kMaxLevel && subdivide(entries, x, y, size, level)) {
    return;
  }
  sweep(entries, [&](const Entry& a, const Entry& b) { keep(a, b); });
}

// Cuts a crowded cell, unless that leaves more than half of the tests.
bool PairTileWorker::subdivide(std::span<Entry> entries, float x, float y, float size, int level) {
  constexpr int kCells = kSubdivision * kSubdivision;
  const float part = size / kSubdivision;
  std::vector<RawEntry> raw;
  std::array<std::uint32_t, kCells + 1> first{};
  const auto index = [parts_per_px = 1 / part](float p, float from) {
    return interval::far_part(p, from, parts_per_px, kSubdivision - 1);
  };
  for (const Entry& entry : entries) {
    const Shown& item = shown(entry);
    const PairBounds& b = item.bounds;
    const int i0 = index(b.lo.x, x), i1 = index(b.hi.x, x);
    const int j0 = index(b.lo.y, y), j1 = index(b.hi.y, y);
    const auto add = [&](int i, int j, float near, float far) {
      const auto cell = static_cast<std::uint32_t>(j * kSubdivision + i);
      raw.push_back({cell, entry.shown & ~kWholeBit, near, far});
      ++first[cell + 1];
    };
    if ((i1 - i0 + 1) * (j1 - j0 + 1) <= kWholePixels) {
      for (int j = j0; j <= j1; ++j) {
        for (int i = i0; i <= i1; ++i) add(i, j, entry.near, entry.far);
      }
      continue;
    }
    Rows rows(*grid_, item.triangle, b);
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
  for (int c = 0; c < kCells; ++c) first[c + 1] += first[c];
  std::vector<Entry> sorted(raw.size());
  std::array<std::uint32_t, kCells + 1> next = first;
  for (const RawEntry& part_of : raw) {
    sorted[next[part_of.cell]++] = entry(part_of.shown, part_of.near, part_of.far);
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

void PairTileWorker::begin(const PairGrid& grid, bool masked, std::size_t memory, PairPool& pool,
                           std::size_t list) {
  grid_ = &grid;
  masked_ = masked;
  memory_ = memory;
  pool_ = &pool;
  pool_list_ = list;
  settled_.start(memory / kSettledPart);
  added_ = listed_ = 0;
}

void PairTileWorker::run(const PairTile& tile, std::span<const PairItem> items,
                         PairCounts& counts) {
  tile_ = tile;
  counts_ = &counts;
  const std::size_t cells = static_cast<std::size_t>(tile.width()) * tile.height();
  const std::size_t fixed = cells * (2 * sizeof(std::uint64_t) + sizeof(std::uint32_t));
  // Lists grow by doubling; a triangle has at least one entry.
  const std::size_t entry_bytes = 2 * (sizeof(RawEntry) + sizeof(Shown)) + sizeof(Entry);
  // A single pixel is done whatever it takes.
  const std::size_t limit = cells == 1        ? SIZE_MAX
                            : memory_ > fixed ? (memory_ - fixed) / entry_bytes
                                              : 0;
  const Stopwatch start;
  bool fits = limit > 0;
  if (fits) {
    const std::size_t last = masked_ ? mark(items) : 0;
    counts.mark_ms += start.ms();
    const Stopwatch listing;
    fits = list(items, last, masked_, std::min<std::size_t>(limit, UINT32_MAX));
    counts.list_ms += listing.ms();
  }
  if (!fits) {
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
    return;
  }
  listed_ += shown_.size();
  counts.listed += shown_.size();
  counts.entries += entries_.size();
  const Stopwatch pairing;
  for (std::size_t c = 0; c < cells; ++c) {
    const std::size_t n = first_[c + 2] - first_[c + 1];
    if (n < 2) continue;
    pair_pixel(std::span(entries_).subspan(first_[c + 1], n),
               tile.i0 + static_cast<int>(c % tile.width()),
               tile.j0 + static_cast<int>(c / tile.width()));
  }
  counts.pair_ms += pairing.ms();
}

}  // namespace farcull
