// The lists of pixels, and of parts of crowded ones, on a GL device.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "core/gl/pairs_items.h"
#include "core/gl/pairs_run.h"
#include "core/pairs/backend.h"

namespace farcull {

/// Lists of the cells of one level: pixels, then parts of crowded ones.
struct PairLevel {
  GlStore counts, first, entries, places, state, parents;
  std::size_t cells = 0;
  std::size_t listed = 0;                         // entries
  std::array<std::uint32_t, 4> bins{1, 6, 1, 0};  // as u_bins
  bool dirty = false;                             // counts are not all 0

  std::size_t all_bins() const { return cells * bins[0]; }
  /// Chooses about as many bins as entries are `expected` and takes the memory of their counts;
  /// false: too much.
  bool shape(std::size_t n, std::uint32_t groups, std::uint64_t expected, PairMemory& memory);
  /// Takes the memory of n entries; false: too much.
  bool fill(std::size_t n, PairMemory& memory);
};

class PairLists {
 public:
  PairLists(PairRun& run, PairItems& items) : run_(run), items_(items) {}

  PairLevel& level(std::size_t l) { return levels_[l]; }
  /// The lists of the part's pixels; false: too much.
  bool make(const PairPart& part, PairMemory& memory);
  /// Cuts the crowded cells of level l into those of the next, of which `crowded_below` are crowded
  /// again; false: too much.
  bool cut(std::size_t l, std::size_t crowded, PairMemory& memory, std::size_t& crowded_below);
  /// Says whether the counts of all levels are 0, as they are after a part that was done.
  void set_dirty(bool dirty);

 private:
  void visit(PairProgram wholes_program, PairProgram rows_program, std::size_t capacity);
  void mark(const PairPart& part, std::size_t mask_bytes);

  PairRun& run_;
  PairItems& items_;
  GlStore rows_, rows_before_, masks_;
  std::array<PairLevel, kMaxLevel + 1> levels_;
};

}  // namespace farcull
