// Each owner is marked against the earlier ones in masks of 64 slices per pixel; entries outside
// the slices that two owners touch are left out.
#include "core/pairs/lists.h"

#include "core/pairs/rows.h"

namespace farcull {
namespace {

// Triangles are fetched this far ahead, since their corners may lie anywhere.
constexpr std::size_t kAhead = 8;

// The slices first .. last as bits.
std::uint64_t slice_bits(int first, int last) {
  return (~std::uint64_t{0} >> (kSlices - 1 - last)) & (~std::uint64_t{0} << first);
}

}  // namespace

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

// Owner by owner: first the slices of earlier owners that it meets, then its own slices.
std::size_t TileLists::mark(const PairTile& tile, std::span<const PairItem> items) {
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
void TileLists::sort_entries(std::size_t cells) {
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
  // From the back, so that first_[c + 1], the end of list c, ends as its start.
  for (std::size_t k = raw_.size(); k-- > 0;) {
    const RawEntry& raw = raw_[k];
    const Shown& shown = shown_[raw.entry.shown];
    entries_[--first_[raw.cell + 1]] =
        shown.whole ? Entry{raw.entry.shown, shown.z0, shown.z1} : raw.entry;
  }
}

// The lists of the tile's pixels, the last owner's items (from `last` on) before the others, since
// they complete the conflicts; false: more than `limit` entries.
bool TileLists::list(const PairTile& tile, std::span<const PairItem> items, std::size_t last,
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
