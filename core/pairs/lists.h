// The lists of the pixels of a tile: which triangles meet another owner's slices in which pixels.
// Each owner is marked against the earlier ones in masks of 64 slices per pixel; entries outside
// the slices that two owners touch are left out.
//
// Also a table of the pairs of triangles that one thread has settled: reported already, or never
// to be reported. Long lists of triangles that lie on each other share most of their pairs from
// pixel to pixel; by this table of bits such a pair is passed over.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <span>
#include <vector>

#include "core/pairs/grid.h"

namespace farcull {

/// A symmetric table of bits, one for each two triangles that have a number. It may forget a pair,
/// which is then reported again; it never holds a pair that was not settled. Triangles get numbers
/// in the order of their first long list, from a hash table with linear probing.
class SettledPairs {
 public:
  /// Forgets everything. bytes: the size of the table, about; it always holds 64 triangles.
  void start(std::size_t bytes) {
    constexpr std::uint32_t kLeast = 64, kMost = 1 << 16;
    const double side = std::sqrt(8.0 * static_cast<double>(bytes));
    most_ = std::clamp(static_cast<std::uint32_t>(std::min<double>(side, kMost)) / 64 * 64, kLeast,
                       kMost);
    stride_ = most_ / 64;
    forget();
  }

  /// Makes sure that `count` more triangles can have numbers; forgets everything if that is needed.
  /// False: the table never holds so many.
  bool reserve(std::size_t count) {
    if (count > most_) return false;
    if (count_ + count > most_) forget();
    if (slots_.empty()) slots_.assign(2 * std::bit_ceil(most_), {0, kNone});
    bits_.resize(std::max(bits_.size(), (count_ + count) * stride_), 0);
    return true;
  }
  /// Grows whenever everything is forgotten: numbers of an earlier round are void.
  std::uint32_t round() const { return round_; }
  /// The number of a triangle in this round. Precondition: reserve() said that it fits.
  std::uint32_t number(std::uint32_t triangle) {
    const std::size_t mask = slots_.size() - 1;
    // Fibonacci hashing: the upper bits of the product depend on all bits of the index.
    for (std::size_t k = (triangle * 0x9e3779b97f4a7c15u) >> 40;; ++k) {
      Slot& slot = slots_[k & mask];
      if (slot.number == kNone) slot = {triangle, count_++};
      if (slot.triangle == triangle) return slot.number;
    }
  }

  /// Words of 64 bits that hold all numbers given up to now.
  std::size_t words() const { return (count_ + 63) / 64; }
  /// Bit b of row a: the pair of the numbers a, b is settled.
  std::span<const std::uint64_t> row(std::uint32_t a) const {
    return {&bits_[a * stride_], words()};
  }
  bool settled(std::uint32_t a, std::uint32_t b) const {
    return (bits_[a * stride_ + b / 64] >> (b % 64) & 1) != 0;
  }
  void settle(std::uint32_t a, std::uint32_t b) {
    bits_[a * stride_ + b / 64] |= std::uint64_t{1} << (b % 64);
    bits_[b * stride_ + a / 64] |= std::uint64_t{1} << (a % 64);
  }

 private:
  static constexpr std::uint32_t kNone = 0xffffffff;  // number of an empty slot
  void forget() {
    count_ = 0;
    ++round_;
    bits_.clear();
    slots_.clear();
  }

  struct Slot {
    std::uint32_t triangle, number;
  };
  std::uint32_t round_ = 0;
  std::uint32_t count_ = 0;
  std::uint32_t most_ = 0;  // triangles that can have numbers
  std::size_t stride_ = 0;  // words of a row
  std::vector<std::uint64_t> bits_;
  std::vector<Slot> slots_;  // by a hash of the triangle; a power of two, at most half full
};

/// The slices first .. last as bits.
inline std::uint64_t slice_bits(int first, int last) {
  return (~std::uint64_t{0} >> (kSlices - 1 - last)) & (~std::uint64_t{0} << first);
}

/// The lists of one tile after the other; keeps its buffers.
class TileLists {
 public:
  /// A triangle with an entry.
  struct alignas(64) Shown {
    std::uint32_t triangle;
    std::uint32_t owner;
    std::array<std::uint32_t, 3> vertices;
    float x0, y0, z0, x1, y1, z1;  // bounds, px
    std::uint16_t i0, j0;          // the first pixel of its bounds
    bool whole;                    // one interval in all its pixels
    std::uint32_t number = 0;      // in the table of settled pairs, valid in `round`
    std::uint32_t round = 0;       // of that table
    PairBounds bounds() const { return {{x0, y0, z0, 0}, {x1, y1, z1, 0}}; }
  };
  /// A triangle in a pixel or in a part of one.
  struct Entry {
    std::uint32_t shown;  // index of the Shown
    float near, far;      // px
  };
  struct RawEntry {
    std::uint32_t cell;
    Entry entry;  // its depths are not set for whole triangles
  };

  void begin(const PairGrid& grid) { grid_ = &grid; }
  /// Marks the slices of the tile that two owners touch. `items`: those that may meet the tile,
  /// ascending by triangle. The items of the last owner are left to list(): returns where they
  /// begin.
  std::size_t mark(const PairTile& tile, std::span<const PairItem> items);
  /// Makes the lists. `masked`: leaves out entries whose slices no other owner touches, with `last`
  /// from mark(). False: more than `limit` entries.
  bool list(const PairTile& tile, std::span<const PairItem> items, std::size_t last, bool masked,
            std::size_t limit);

  /// The entries of a pixel, counted in rows of the tile.
  std::span<Entry> entries(std::size_t cell) {
    return std::span(entries_).subspan(first_[cell + 1], size(cell));
  }
  std::size_t size(std::size_t cell) const { return first_[cell + 2] - first_[cell + 1]; }
  std::size_t size() const { return entries_.size(); }
  std::size_t shown_count() const { return shown_.size(); }
  const Shown& shown(std::uint32_t index) const { return shown_[index]; }
  Shown& shown(std::uint32_t index) { return shown_[index]; }

 private:
  // Triangles are fetched this far ahead, since their corners may lie anywhere.
  static constexpr std::size_t kAhead = 8;

  template <class Visit>
  void for_each_pixel(const PairItem& item, const Visit& visit) const;
  void sort_entries(std::size_t cells);

  const PairGrid* grid_ = nullptr;
  PairTile tile_{};
  std::vector<std::uint64_t> any_;       // per pixel: slices that some owner touches
  std::vector<std::uint64_t> conflict_;  // per pixel: slices that two owners touch
  std::vector<Shown> shown_;
  std::vector<RawEntry> raw_;
  std::vector<std::uint32_t> first_;  // per pixel: into entries_
  std::vector<Entry> entries_;
};

// Calls visit(cell, slices, near, far) for every pixel of the tile that the item may meet;
// near and far are set where the item is not whole.
template <class Visit>
void TileLists::for_each_pixel(const PairItem& item, const Visit& visit) const {
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
  PairRows rows(*grid_, item.triangle, grid_->bounds(item.triangle));
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

// Goes owner by owner: first marks the slices of earlier owners that this one meets, then adds its
// own slices.
inline std::size_t TileLists::mark(const PairTile& tile, std::span<const PairItem> items) {
  tile_ = tile;
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

// Puts the raw entries in the order of their pixels.
inline void TileLists::sort_entries(std::size_t cells) {
  for (std::size_t k = 0; k < shown_.size(); ++k) {
    grid_->prefetch(shown_[std::min(k + kAhead, shown_.size() - 1)].triangle);
    const PairBounds b = grid_->bounds(shown_[k].triangle);
    Shown& shown = shown_[k];
    shown.x0 = b.lo.x, shown.y0 = b.lo.y, shown.z0 = b.lo.z;
    shown.x1 = b.hi.x, shown.y1 = b.hi.y, shown.z1 = b.hi.z;
  }
  for (std::size_t c = 0; c < cells; ++c) first_[c + 1] += first_[c];
  first_[cells + 1] = static_cast<std::uint32_t>(raw_.size());
  entries_.resize(raw_.size());
  // From the back, so that first_[c + 1], the end of list c, becomes its start.
  for (std::size_t k = raw_.size(); k-- > 0;) {
    const RawEntry& raw = raw_[k];
    const Shown& shown = shown_[raw.entry.shown];
    entries_[--first_[raw.cell + 1]] =
        shown.whole ? Entry{raw.entry.shown, shown.z0, shown.z1} : raw.entry;
  }
}

// The lists of the tile's pixels, the last owner's items (from `last` on) before the others, since
// they complete the conflicts; false: more than `limit` entries.
inline bool TileLists::list(const PairTile& tile, std::span<const PairItem> items, std::size_t last,
                            bool masked, std::size_t limit) {
  tile_ = tile;
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
      raw_.push_back({cell, {next, near, far}});
      ++first_[cell + 1];
    });
    if (raw_.size() == before) return;
    shown_.push_back({.triangle = item.triangle,
                      .owner = task.owners[item.triangle],
                      .vertices = task.triangles[item.triangle],
                      .x0 = 0,
                      .y0 = 0,
                      .z0 = 0,
                      .x1 = 0,
                      .y1 = 0,
                      .z1 = 0,
                      .i0 = item.i0,
                      .j0 = item.j0,
                      .whole = item.whole});
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
  sort_entries(cells);
  return true;
}

}  // namespace farcull
