// The room that the work on a window is expected to need: as counted by the last windows, else
// guessed. The guess counts items as the device does it (pair_items.comp). It looks only at the
// bounds of the pixels that a triangle meets, so crowded pixels are guessed: those that the bounds
// of more than 1,024 triangles meet.
#include <algorithm>
#include <cmath>

#include "core/gl/pairs/finder.h"
#include "core/pairs/grid.h"

namespace farcull {
namespace {

// As many views as most frames have, so that the room is enough for each of them.
constexpr std::size_t kRemembered = 4;
constexpr std::size_t kLeastRoom = 64;
constexpr std::size_t kGuessedCells = std::size_t{1} << 20;  // where triangles are counted
// Chosen so that nearly all built-in scenes have room enough (docs/device-work.md). Where there is
// too little, the work is done again; where there is more than needed, memory stays unused.
constexpr std::size_t kPairsOfEntry = 256;                // reported, on average
constexpr std::size_t kMostUnits = std::size_t{1} << 22;  // work items of further tests
constexpr float kUnsure = 0x1p-8f;  // px, far more than the rounding of bounds
// Entries may be in several parts of a cell that is cut: guessed as twice as many in all.
constexpr std::size_t kCutEntries = 2;

// Calls change(mine, other) for each count.
template <class Change>
void for_each_count(PairForecast& mine, const PairForecast& other, const Change& change) {
  change(mine.wholes, other.wholes);
  change(mine.items, other.items);
  change(mine.large, other.large);
  change(mine.shown, other.shown);
  change(mine.pairs, other.pairs);
  change(mine.more, other.more);
  change(mine.row_items, other.row_items);
  for (std::size_t l = 0; l <= kMaxLevel; ++l) {
    change(mine.entries[l], other.entries[l]);
    change(mine.crowded[l], other.crowded[l]);
  }
}

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
  /// Ends the counting: finds the largest count of a cell, and the number of crowded pixels.
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

// Bytes that the items and the lists of a forecast take.
std::size_t bytes_of(const PairForecast& f) {
  std::size_t bytes = f.wholes * (kVec4 + 2 * kWord) + f.items * (kRecord + kVec4 + 3 * kWord) +
                      f.shown * (kRecord + kVec4);
  for (const std::size_t entries : f.entries) bytes += entries * (kEntry + 2 * kWord);
  return bytes;
}

// Counts the items of the active triangles and their entries; `cells` counts their bounds.
PairForecast count_bounds(const PairTask& task, CellCounts& cells) {
  const PairGrid grid(task);
  const float large = large_pixels(task.active.size());
  PairForecast guess;
  guess.triangles = task.triangles.size();
  std::size_t& listed = guess.entries[0];
  for (const std::uint32_t t : task.active) {
    const PairBounds bounds = grid.bounds(t);
    if (bounds.empty()) continue;
    PairItem item = grid.item(t, bounds);
    // Triangles that rounding may turn into either kind are counted as both.
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
      // The device may round the pixels otherwise: a triangle near the limit counts as both.
      if (pixels > 0.99f * large) ++guess.large;
      if (pixels > 1.01f * large) continue;
      guess.row_items += height * ((width - 1) / kSpan + 1);
      // The footprint is that of the triangle. Its solid is about half a pixel larger to each side,
      // so it meets about one more pixel for each row and column.
      listed += std::min(width * height, static_cast<std::size_t>(pixels) + width + height);
    }
    cells.add(item);
  }
  cells.finish();
  guess.shown = guess.wholes;
  return guess;
}

// Room for the work on a window, by the bounds of its active triangles: enough for most scenes. No
// answer depends on that, since the device counts all its work. memory: bytes for the masks and
// lists; block: bytes of one buffer. Empty if they would not suffice.
std::optional<PairForecast> first_guess(const PairTask& task, std::size_t memory,
                                        std::size_t block) {
  CellCounts cells(task.width, task.height);
  PairForecast guess = count_bounds(task, cells).with_room();
  // If masks leave entries out, few are left in most scenes.
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
  // With little memory to cut crowded pixels so often, fewer levels are expected: since masks leave
  // entries out, the pixels may not be so crowded.
  while (guess.levels > 0 && bytes_of(guess) > memory / 4 * 3) {
    guess.entries[guess.levels] = 0;
    guess.crowded[--guess.levels] = 0;
  }
  if (bytes_of(guess) > memory / 4 * 3) return {};
  std::size_t entries = 0;
  for (const std::size_t of_level : guess.entries) entries += of_level;
  // An entry with at most 256 others in its cell has no further tests.
  if (cells.largest > static_cast<int>(kUnit))
    guess.more = std::min(entries * (static_cast<std::size_t>(cells.largest) / kUnit), kMostUnits);
  // More pairs cost a second pass of the tests, but more room may be beyond a device's memory.
  const std::size_t most = std::min(memory / 2, block) / sizeof(TrianglePair);
  guess.pairs = std::min(kPairsOfEntry * entries, most - std::min<std::size_t>(most, 1));
  return guess;
}

}  // namespace

void PairForecast::join(const PairForecast& other) {
  for_each_count(*this, other, [](auto& mine, auto its) { mine = std::max(mine, its); });
  levels = std::max(levels, other.levels);
}

PairForecast PairForecast::with_room() const {
  PairForecast out = *this;
  for_each_count(out, *this, [](auto& mine, auto its) {
    if (its > 0) mine = its + its / 4 + kLeastRoom;
  });
  return out;
}

// Repeats the comparison that the device made. Rows of pixels beyond the forecast, and crowded
// cells of the last level, were left out.
bool PairForecast::holds(const PairTotalWords& totals, std::size_t cut) const {
  bool enough = totals[kTotalWholes] <= wholes && totals[kTotalItems] <= items &&
                totals[kTotalLarge] <= large && totals[kTotalListed] <= shown &&
                two_words(totals, kTotalRows) == totals[kTotalRowItems] &&
                totals[kTotalRowItems] <= row_items;
  for (std::size_t l = 0; l <= cut; ++l) {
    enough &= totals[of_level(kTotalEntries, l)] <= entries[l];
    enough &= l == kMaxLevel || totals[of_level(kTotalParents, l)] <= (l < cut ? crowded[l] : 0);
  }
  return enough;
}

SeenWindow::SeenWindow(const PairTask& task) {
  constexpr std::size_t kLooked = 16;  // objects
  side = static_cast<float>(std::max(task.width, task.height));
  places = {static_cast<float>(task.width), static_cast<float>(task.height)};
  for (std::size_t o = 0; o < std::min(task.limits.size(), kLooked); ++o) {
    const PixelBox& box = task.limits[o];
    for (const float x : {box.lo.x, box.lo.y, box.lo.z, box.hi.x, box.hi.y, box.hi.z})
      places.push_back(x);
  }
}

bool SeenWindow::is_like(const SeenWindow& other) const {
  constexpr float kStep = 0.125f;  // of the window
  const auto near = [&](float a, float b) { return std::abs(a - b) <= kStep * other.side; };
  return near(side, other.side) &&
         std::equal(places.begin(), places.end(), other.places.begin(), other.places.end(), near);
}

// Empty if the counts are to be read between the steps.
std::optional<PairForecast> PairFinder::expected_room(const SeenWindow& window) const {
  if (options_.step_by_step || scene_.gathered()) return {};
  std::optional<PairForecast> room;
  const bool known =
      !last_ones_.empty() && last_ones_.front().counts.triangles == task_->triangles.size();
  if (known) {
    PairForecast all = last_ones_.front().counts;
    for (const Seen& one : last_ones_) {
      if (one.counts.triangles == all.triangles) all.join(one.counts);
    }
    room = all.with_room();
  }
  if (!known || std::none_of(last_ones_.begin(), last_ones_.end(),
                             [&](const Seen& one) { return one.window.is_like(window); })) {
    auto guess = first_guess(*task_, options_.memory, device_.block());
    if (guess && known) guess->join(*room);
    room = guess;
  }
  if (!room) return {};
  const std::uint64_t batches = (room->large + kLargeBatch - 1) / kLargeBatch;
  if (batches * task_->active.size() >> 31 != 0) return {};  // beyond one dispatch
  return room;
}

// Remembers a window that was done in one part and whose counts are all known.
void PairFinder::remember(const SeenWindow& window) {
  if (!seen_ || counts_.bands != 1 || counts_.given_up) {
    last_ones_.clear();
    return;
  }
  last_ones_.push_front({*seen_, window});
  if (last_ones_.size() > kRemembered) last_ones_.pop_back();
}

}  // namespace farcull
