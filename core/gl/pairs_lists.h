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
  std::size_t cells = 0;                          // or room for so many
  std::size_t listed = 0;                         // entries, or room for so many
  std::size_t crowded = 0;                        // cells that are cut, or room for so many
  std::array<std::uint32_t, 4> bins{1, 6, 1, 0};  // as u_bins
  bool dirty = false;                             // counts are not all 0

  std::size_t all_bins() const { return cells * bins[0]; }
  /// Chooses about as many bins as entries are `expected` and takes the memory of their counts;
  /// false: too much.
  bool shape(std::size_t n, std::uint32_t groups, std::uint64_t expected, PartMemory& memory);
  /// Takes the memory of n entries; false: too much.
  bool fill(std::size_t n, PartMemory& memory);
};

class PairLists {
 public:
  PairLists(PairRun& run, PairItems& items) : run_(run), items_(items) {}

  PairLevel& level(std::size_t l) { return levels_[l]; }
  /// The lists of the part's pixels and of the parts of crowded ones; false: too much. Counts are
  /// read where they are needed.
  bool make(const PairPart& part, PartMemory& memory);
  /// The same with room for as many as the forecast says, and nothing is read.
  bool make(const PairPart& part, const PairForecast& forecast, PartMemory& memory);
  /// Levels that are cut: level l has lists for l <= levels().
  std::size_t levels() const { return levels_cut_; }
  PairWork all_entries(std::size_t l) const {
    return {levels_[l].listed, of_level(kTotalEntries, l)};
  }
  /// After a part that was done the counts of its levels are 0; after one that was broken off
  /// nobody knows.
  void set_done();
  void set_broken_off();

 private:
  void visit(PairProgram wholes_program, PairProgram rows_program, std::size_t capacity);
  void mark(const PairPart& part, std::size_t mask_bytes);
  bool count(const PairPart& part, PartMemory& memory);
  bool fill(std::size_t shown, std::size_t entries, PartMemory& memory);
  bool take_parents(std::size_t l, std::size_t crowded, PartMemory& memory);
  void check(std::size_t l);
  void cut(std::size_t l);
  bool fill_cut(std::size_t l, std::size_t entries, PartMemory& memory);
  void step(PairProgram program, std::size_t l, const PairWork& work, std::size_t capacity);

  PairRun& run_;
  PairItems& items_;
  GlStore rows_before_, masks_;
  std::array<PairLevel, kMaxLevel + 1> levels_;
  std::size_t levels_cut_ = 0;
};

}  // namespace farcull
