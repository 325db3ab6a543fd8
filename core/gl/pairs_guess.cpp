// The items are counted as the device does it (pair_items.comp). Of the pixels that a triangle
// meets only its bounds are looked at, so crowded ones are guessed: those that the bounds of more
// than 1,024 triangles meet.
#include "core/gl/pairs_guess.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "core/pairs/grid.h"

namespace farcull {
namespace {

constexpr std::size_t kGuessedCells = std::size_t{1} << 20;  // where triangles are counted
// Chosen so that nearly all built-in scenes have room enough (docs/device-work.md). Where there is
// too little, the work is done again; where there is more than needed, memory stays unused.
constexpr std::size_t kPairsOfEntry = 256;                // reported, on average
constexpr std::size_t kMostUnits = std::size_t{1} << 22;  // work items of further tests
constexpr float kUnsure = 0x1p-8f;  // px, far more than the rounding of bounds
// Cutting a cell leaves entries that are in several of its parts: guessed as twice as many in all.
constexpr std::size_t kCutEntries = 2;

// Triangles whose bounds meet a cell: a block of pixels, a power of two along each side.
class CellCounts {
 public:
  CellCounts(int width, int height) {
    while (cells(width, height) > kGuessedCells) ++shift_;
    columns_ = (static_cast<std::size_t>(width - 1) >> shift_) + 2;
    rows_ = (static_cast<std::size_t>(height - 1) >> shift_) + 2;
    change_.assign(columns_ * rows_, 0);
  }
  void add(const PairItem& item) {
    const std::size_t i0 = item.i0 >> shift_, i1 = (item.i1 >> shift_) + 1;
    const std::size_t j0 = (item.j0 >> shift_) * columns_,
                      j1 = ((item.j1 >> shift_) + std::size_t{1}) * columns_;
    ++change_[j0 + i0];
    --change_[j0 + i1];
    --change_[j1 + i0];
    ++change_[j1 + i1];
  }
  /// Ends the counting: the largest count of a cell, and how many pixels lie in crowded cells.
  void finish() {
    for (std::size_t j = 0; j + 1 < rows_; ++j) {
      int row = 0;
      for (std::size_t i = 0; i + 1 < columns_; ++i) {
        int& here = change_[j * columns_ + i];
        row += here;
        here = row + (j > 0 ? change_[(j - 1) * columns_ + i] : 0);
        largest = std::max(largest, here);
        if (here > kCrowded) crowded += std::size_t{1} << (2 * shift_);
      }
    }
  }
  int largest = 0;
  std::size_t crowded = 0;

 private:
  std::size_t cells(int width, int height) const {
    return ((static_cast<std::size_t>(width) >> shift_) + 1) *
           ((static_cast<std::size_t>(height) >> shift_) + 1);
  }
  int shift_ = 0;
  std::size_t columns_ = 0, rows_ = 0;
  std::vector<int> change_;
};

PairBounds grown(const PairBounds& b, float by) {
  const interval::vec4 change = {by, by, 0, 0};
  return {b.lo - change, b.hi + change};
}

// Bytes of the lists: those of PairItems and PairLists.
std::size_t bytes_of(const PairForecast& f) {
  std::size_t bytes = f.wholes * (kVec4 + 2 * kWord) + f.items * (kRecord + kVec4 + 3 * kWord) +
                      f.shown * (kRecord + kVec4);
  for (const std::size_t entries : f.entries) bytes += entries * (kEntry + 2 * kWord);
  return bytes;
}

}  // namespace

std::optional<PairForecast> first_guess(const PairTask& task, std::size_t memory,
                                        std::size_t block) {
  const PairGrid grid(task);
  const float large = large_pixels(task.active.size());
  CellCounts cells(task.width, task.height);
  PairForecast guess;
  guess.triangles = task.triangles.size();
  std::size_t listed = 0;
  for (const std::uint32_t t : task.active) {
    const PairBounds bounds = grid.bounds(t);
    if (bounds.empty()) continue;
    PairItem item = grid.item(t, bounds);
    // Those that rounding may make either are counted as both.
    const bool grown_whole = grid.item(t, grown(bounds, kUnsure)).whole;
    const bool shrunk_whole = grid.item(t, grown(bounds, -kUnsure)).whole;
    if (item.whole && !grown_whole) ++guess.wholes;
    if (!item.whole && shrunk_whole) ++guess.wholes;
    item.whole = grown_whole;
    const std::size_t width = item.i1 - item.i0 + 1, height = item.j1 - item.j0 + 1;
    if (item.whole) {
      ++guess.wholes;
      listed += width * height;
    } else {
      ++guess.items;
      const float pixels =
          interval::far_footprint(grid.corner(t, 0), grid.corner(t, 1), grid.corner(t, 2),
                                  bounds.hi.x - bounds.lo.x, bounds.hi.y - bounds.lo.y);
      // The device may round the pixels otherwise: near the limit both are counted.
      if (pixels > 0.99f * large) ++guess.large;
      if (pixels > 1.01f * large) continue;
      guess.row_items += height * ((width - 1) / kSpan + 1);
      // The footprint is that of the triangle. Its solid is about half a pixel larger to each side,
      // so it meets about one more for each row and column.
      listed += std::min(width * height, static_cast<std::size_t>(pixels) + width + height);
    }
    cells.add(item);
  }
  cells.finish();
  guess.shown = guess.wholes;
  guess.entries[0] = listed;
  guess = guess.with_room();
  // Where masks leave entries out, mostly few are left.
  if (bytes_of(guess) > memory / 2) {
    guess.shown /= 4;
    guess.entries[0] /= 4;
  }
  std::size_t crowded = cells.crowded;
  for (std::size_t l = 0; l < kMaxLevel; ++l) {
    guess.crowded[l] = std::min(crowded, guess.entries[l] / kCrowded);
    if (guess.crowded[l] == 0) break;
    guess.levels = l + 1;
    guess.entries[l + 1] = kCutEntries * guess.entries[l];
    crowded = guess.crowded[l] * kSubdivision * kSubdivision;
  }
  // Where there is little memory to cut crowded pixels so often, they may not be so crowded: masks
  // leave entries out.
  while (guess.levels > 0 && bytes_of(guess) > memory / 4 * 3) {
    guess.entries[guess.levels] = 0;
    guess.crowded[--guess.levels] = 0;
  }
  if (bytes_of(guess) > memory / 4 * 3) return {};
  std::size_t entries = 0;
  for (const std::size_t of_level : guess.entries) entries += of_level;
  // An entry with at most 256 others in its cell has no further tests.
  if (cells.largest > static_cast<int>(kUnit)) {
    guess.more = std::min(entries * (static_cast<std::size_t>(cells.largest) / kUnit), kMostUnits);
  }
  // More pairs than this cost a second pass of the tests, but a device need not have the memory.
  const std::size_t most = std::min(memory / 2, block) / sizeof(TrianglePair);
  guess.pairs = std::min(kPairsOfEntry * entries, most - std::min<std::size_t>(most, 1));
  return guess;
}

}  // namespace farcull
