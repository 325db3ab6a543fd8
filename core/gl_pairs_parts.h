// The state of FAR pairs on GL, whose work is divided among gl_pairs.cpp (parts of the window and
// their items), gl_pairs_lists.cpp (lists of pixels) and gl_pairs_tests.cpp (pairs). For these
// alone.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <vector>

#include "core/gl_pairs.h"
#include "core/gl_pairs_device.h"
#include "core/pair_sort.h"

namespace farcull {

// Bytes.
constexpr std::size_t kWord = sizeof(std::uint32_t);
constexpr std::size_t kVec4 = 16;
constexpr std::size_t kRecord = 5 * kVec4;
constexpr std::size_t kEntry = 2 * kVec4;

// A part of the window.
struct PairPart {
  int i0, i1, j0, j1;  // pixels, inclusive
  int width() const { return i1 - i0 + 1; }
  int height() const { return j1 - j0 + 1; }
  std::size_t cells() const { return static_cast<std::size_t>(width()) * height(); }
};

// The memory of one part of the window.
struct PairRoom {
  std::size_t left;
  std::size_t block;
  bool last;  // a single pixel, which is done whatever it takes

  /// False: the part must be split. `bytes` of one buffer. Throws Error where a single pixel needs
  /// more than a block.
  bool take(std::size_t bytes);
};

// Lists of the cells of one level: pixels, then parts of crowded ones.
struct PairLevel {
  GlStore counts, first, entries, places, state, parents;
  std::size_t cells = 0;
  std::size_t listed = 0;                         // entries
  std::array<std::uint32_t, 4> bins{1, 6, 1, 0};  // as u_bins
  bool dirty = false;                             // counts are not all 0

  std::size_t all_bins() const { return cells * bins[0]; }
  /// About as many bins as entries are `expected`, within the memory, and room for their counts;
  /// false: too many.
  bool shape(std::size_t n, std::uint32_t groups, std::uint64_t expected, PairRoom& room);
  /// Room for n entries; false: too many.
  bool fill(std::size_t n, PairRoom& room);
};

/// A total of two words.
inline std::uint64_t two_words(const std::array<std::uint32_t, kTotals>& totals, PairTotal low) {
  return std::uint64_t{totals[low]} | std::uint64_t{totals[low + 1]} << 32;
}

// Launches work items first .. first + count - 1, which may append `capacity` pairs.
using PairLaunch =
    std::function<void(std::uint64_t first, std::uint64_t count, std::uint32_t capacity)>;

struct GlPairs::State {
  const GlContext& context;
  GlPairOptions options;
  PairDevice device;
  PairMirror vertices, triangles, owners, active, objects;
  GlStore heads, records, record_heads, listed, shown, rows, rows_before, masks, large, pairs,
      units, units_before, settled;
  std::array<PairLevel, kMaxLevel + 1> levels;
  bool gathered = false;  // triangles are sent one by one, since an array is beyond a block
  std::size_t sent = 0;

  const PairTask* task = nullptr;
  PairUniforms common;                      // of the part
  std::uint32_t owner_bits = 0;             // of an owner's number
  std::uint32_t groups = 1;                 // of entries, by owner
  bool same_group = true;                   // entries of one group may collide
  std::vector<std::uint32_t> object_words;  // as in pair_source.glsl
  std::size_t wholes = 0, items = 0, large_ones = 0, shown_ones = 0;  // of the part
  std::uint64_t row_items = 0;
  std::size_t settled_words = 0;  // bits of pairs that the part has emitted; 0: it keeps none
  std::optional<PairPool> found;
  PairCounts counts;

  State(const GlContext& c, const GlPairOptions& o) : context(c), options(o), device(c, o) {}

  /// The buffers that every program about triangles reads, and `more`.
  std::vector<PairBinding> with_scene(std::initializer_list<PairBinding> more) const {
    std::vector<PairBinding> all = {
        {0, &vertices.store()}, {1, &triangles.store()}, {2, &owners.store()}, {3, &active.store()},
        {4, &objects.store()},  {5, &records},           {6, &record_heads}};
    all.insert(all.end(), more.begin(), more.end());
    return all;
  }

  void begin(const PairTask& t);
  void send(PairMirror& mirror, std::span<const std::byte> data);
  void split(const PairPart& tile);
  bool run(const PairPart& tile);
  void send(const std::function<void(std::size_t, std::size_t)>& launch);
  bool make_items(PairRoom& room);
  bool lists(const PairPart& tile, PairRoom& room);
  void visit(PairProgram wholes_program, PairProgram rows_program, std::size_t capacity);
  bool make_records(PairRoom& room);
  bool cut(std::size_t l, std::size_t crowded, PairRoom& room, std::size_t& crowded_below);
  void settle(PairRoom& room);
  bool test(std::size_t l, bool some_cut, PairRoom& room);
  void compare_large(const PairRoom& room);
  std::uint32_t emit(std::uint64_t count, const PairRoom& room, const PairLaunch& launch);
  void check(const std::array<std::uint32_t, kTotals>& totals) const;
  bool overflow(const std::array<std::uint32_t, kTotals>& totals, const PairRoom& room) const;
};

}  // namespace farcull
