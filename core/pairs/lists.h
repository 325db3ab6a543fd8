// The lists of the pixels of a tile: which triangles meet another owner's slices in which pixels.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "core/pairs/grid.h"

namespace farcull {

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
    std::uint32_t number = 0;      // in the table of settled pairs, where its round is
    std::uint32_t round = 0;       // this one
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

}  // namespace farcull
