// Lists are counted, their places are scanned, and they are filled in: three passes over the items.
// Crowded cells are cut in the same way, level by level.
#include <algorithm>

#include "core/base/stopwatch.h"
#include "core/gl/pairs/finder.h"

namespace farcull {
namespace {

constexpr std::size_t kSubCells = kSubdivision * kSubdivision;
constexpr std::size_t kBins = std::size_t{1} << 20;  // that are wanted at most

}  // namespace

bool PairLevel::shape(std::size_t n, std::uint32_t groups, std::uint64_t expected,
                      PartMemory& memory) {
  cells = n;
  std::uint32_t slices = kSlices, shift = 0;
  const std::size_t most = std::min<std::uint64_t>({expected, kBins, memory.left / (8 * kWord)});
  while (slices > 1 && cells * groups * slices > most) {
    slices /= 2;
    ++shift;
  }
  bins = {groups * slices, shift, slices, groups - 1};
  // Lists of smaller cells have a place more for each parent (pair_cut.comp).
  const std::size_t wanted = (all_bins() + cells / kSubCells + 1) * kWord;
  if (!memory.take(wanted) || !memory.take(wanted)) return false;
  if (counts.reserve(wanted, memory.block)) dirty = true;
  if (dirty) counts.clear(counts.bytes());
  dirty = true;  // until all that is counted is filled in
  first.reserve(wanted, memory.block);
  for (GlStore* store : {&entries, &places}) store->reserve(kVec4, kVec4);
  return true;
}

bool PairLevel::fill(std::size_t n, PartMemory& memory) {
  listed = n;
  if (!memory.take(n * kEntry) || !memory.take(n * 2 * kWord)) return false;
  entries.reserve(n * kEntry, memory.block);
  places.reserve(n * 2 * kWord, memory.block);
  return true;
}

bool PairFinder::make_lists() {
  if (!count_entries()) return false;
  PairTotalWords totals{};
  if (room_ == nullptr) {
    PairUniforms u = common_;
    u.bins = levels_[0].bins;
    device_.run(PairProgram::crowded, part_.cells(), u, {{4, &levels_[0].first}});
    totals = device_.read("pair lists");
    if (overflow(totals)) return false;
  }
  const auto entries_of = [&](std::size_t l) -> std::size_t {
    return room_ != nullptr ? room_->entries[l] : totals[of_level(kTotalEntries, l)];
  };
  const auto crowded_of = [&](std::size_t l) -> std::size_t {
    if (room_ != nullptr) return l < room_->levels ? room_->crowded[l] : 0;
    return l < kMaxLevel ? totals[of_level(kTotalCrowded, l)] : 0;
  };
  if (!fill_lists(room_ != nullptr ? room_->shown : totals[kTotalListed], entries_of(0)))
    return false;
  for (std::size_t l = 0;; ++l) {
    const std::size_t crowded = crowded_of(l);
    if (!take_parents(l, crowded)) return false;
    check_cells(l);
    if (crowded == 0) return true;
    cut_cells(l);
    if (room_ == nullptr) {
      totals = device_.read("pair subdivision");
      check_lists(totals);
      if (totals[of_level(kTotalParents, l)] != crowded) {
        throw_lost("pairs", "crowded pixels were counted twice with different results",
                   kLostInvocation);
      }
      if (overflow(totals)) return false;
    }
    if (!fill_cut(l, entries_of(l + 1))) return false;
  }
}

// Counts the entries of the part's pixels, and gives their lists places; false: too much.
bool PairFinder::count_entries() {
  PairLevel& pixels = levels_[0];
  levels_cut_ = 0;
  common_.cells = static_cast<std::uint32_t>(part_.cells());
  rows_before_.reserve(std::max<std::size_t>(items_ * kWord, kVec4), memory_.block);
  if (row_items_ > 0) device_.scan(rows_, rows_before_, items_, kTotalItems, kTotalRowItems);
  const std::size_t mask_bytes =
      common_.masked ? part_.cells() * 8 * (1 + 2 * owners_.bits) : kVec4;
  if (!memory_.take(mask_bytes)) return false;
  masks_.reserve(mask_bytes, memory_.block);
  if (!pixels.shape(part_.cells(), owners_.groups, 2 * wholes_ + 8 * row_items_, memory_))
    return false;
  if (common_.masked) mark(mask_bytes);
  device_.stamp(PairStamp::marked);
  visit(PairProgram::count_wholes, PairProgram::count_rows, 0);
  device_.scan(pixels.counts, pixels.first, pixels.all_bins() + 1, kSerialStart, kTotalEntries);
  return true;
}

// Marks the slices that two owners touch in each pixel.
void PairFinder::mark(std::size_t mask_bytes) {
  const Stopwatch start;
  // If this is lost, slices are left that seem to be touched: more is listed, nothing less.
  masks_.clear(mask_bytes);
  visit(PairProgram::mark_wholes, PairProgram::mark_rows, 0);
  PairUniforms u = common_;
  u.extra[0] = owners_.bits;
  device_.run(PairProgram::conflicts, 2 * part_.cells(), u, {{2, &masks_}});
  counts_.mark_ms += start.ms();
}

bool PairFinder::fill_lists(std::size_t shown, std::size_t entries) {
  if (!make_records(shown) || !levels_[0].fill(entries, memory_)) return false;
  visit(PairProgram::fill_wholes, PairProgram::fill_rows, entries);
  return true;
}

// Runs one step of pair_lists.comp.
void PairFinder::visit(PairProgram wholes_program, PairProgram rows_program, std::size_t capacity) {
  PairUniforms u = common_;
  const PairLevel& pixels = levels_[0];
  const bool fill = wholes_program == PairProgram::fill_wholes;
  u.bins = pixels.bins;
  u.capacity = static_cast<std::uint32_t>(capacity);
  u.extra[0] = owners_.bits;
  for (const bool by_rows : {false, true}) {
    device_.run(by_rows ? rows_program : wholes_program,
                by_rows ? PairWork(row_items_, kTotalRowItems)
                        : (fill ? PairWork(shown_, kTotalListed) : PairWork(wholes_, kTotalWholes)),
                u,
                {{0, &records_},
                 {1, &rows_before_},
                 {2, &masks_},
                 {3, &pixels.counts},
                 {4, &pixels.first},
                 {6, by_rows || fill ? &record_heads_ : &heads_},
                 {8, by_rows ? &listed_flags_ : &shown_list_},
                 {9, &pixels.entries},
                 {10, &pixels.places}});
  }
}

// Memory for the cells of level l that are cut, and for the counts of the level below.
bool PairFinder::take_parents(std::size_t l, std::size_t crowded) {
  PairLevel& level = levels_[l];
  level.crowded = crowded;
  level.parents.reserve(kVec4, kVec4);
  if (crowded == 0) return true;
  if (!memory_.take(level.cells * kWord) || !memory_.take(crowded * kVec4)) return false;
  level.state.reserve(level.cells * kWord, memory_.block);
  level.parents.reserve(crowded * kVec4, memory_.block);
  return levels_[l + 1].shape(crowded * kSubCells, owners_.groups, level.listed, memory_);
}

// Runs one step of pair_cut.comp on level l.
void PairFinder::cut_step(PairProgram program, std::size_t l, const PairWork& work,
                          std::size_t capacity) {
  const PairLevel& level = levels_[l];
  const bool checks = program == PairProgram::parents;
  const PairLevel& below = checks ? level : levels_[l + 1];
  PairUniforms u = common_;
  u.bins = below.bins;
  u.capacity = static_cast<std::uint32_t>(capacity);
  u.extra = {static_cast<std::uint32_t>(l), level.bins[0], 0, 0};
  u.numbers[0] = 1;
  for (std::size_t k = 0; k <= l; ++k) u.numbers[0] /= kSubdivision;
  u.numbers[1] = 1 / u.numbers[0];
  device_.run(program, work, u,
              {{0, &records_},
               {1, l > 0 ? &levels_[l - 1].parents : &level.parents},
               {2, &level.parents},
               {3, &below.counts},
               {4, &below.first},
               {5, &level.entries},
               {6, &level.places},
               {8, level.crowded > 0 ? &level.state : &level.parents},
               {9, &below.entries},
               {10, &below.places}});
}

// Whether all that was counted was filled in, and which cells are crowded.
void PairFinder::check_cells(std::size_t l) {
  cut_step(PairProgram::parents, l,
           l == 0 ? PairWork(levels_[0].cells)
                  : PairWork(levels_[l - 1].crowded, of_level(kTotalParents, l - 1), 1,
                             static_cast<std::uint32_t>(kSubCells)),
           levels_[l].crowded);
}

// Cuts the crowded cells of level l where that saves tests, and gives the smaller ones places.
void PairFinder::cut_cells(std::size_t l) {
  cut_step(PairProgram::cut_count, l, all_entries(l), 0);
  cut_step(PairProgram::cut_decide, l, {levels_[l].crowded, of_level(kTotalParents, l)}, 0);
  levels_cut_ = l + 1;
}

bool PairFinder::fill_cut(std::size_t l, std::size_t entries) {
  if (!levels_[l + 1].fill(entries, memory_)) return false;
  cut_step(PairProgram::cut_fill, l, all_entries(l), entries);
  return true;
}

}  // namespace farcull
