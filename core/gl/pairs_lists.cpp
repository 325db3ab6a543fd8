// Lists are counted, their places are scanned, and they are filled in: three passes over the items.
// Crowded cells are cut in the same way, level by level.
#include "core/gl/pairs_lists.h"

#include <algorithm>

#include "core/base/error.h"
#include "core/base/stopwatch.h"

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
  if (dirty) {
    counts.clear(counts.bytes());
  }
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

// Runs one step of pair_lists.comp.
void PairLists::visit(PairProgram wholes_program, PairProgram rows_program, std::size_t capacity) {
  PairUniforms u = run_.common;
  const PairLevel& pixels = levels_[0];
  const bool fill = wholes_program == PairProgram::fill_wholes;
  u.bins = pixels.bins;
  u.capacity = static_cast<std::uint32_t>(capacity);
  u.extra[0] = run_.owners.bits;
  for (const bool by_rows : {false, true}) {
    run_.device.run(by_rows ? rows_program : wholes_program,
                    by_rows ? items_.all_rows() : (fill ? items_.all_shown() : items_.all_wholes()),
                    u,
                    {{0, &items_.record_store()},
                     {1, &rows_before_},
                     {2, &masks_},
                     {3, &pixels.counts},
                     {4, &pixels.first},
                     {6, by_rows || fill ? &items_.record_heads() : &items_.heads()},
                     {8, by_rows ? &items_.listed_flags() : &items_.shown_list()},
                     {9, &pixels.entries},
                     {10, &pixels.places}});
  }
}

// Marks the slices that two owners touch in each pixel.
void PairLists::mark(const PairPart& part, std::size_t mask_bytes) {
  const Stopwatch start;
  // Where this is lost, slices are left that seem to be touched: more is listed, nothing less.
  masks_.clear(mask_bytes);
  visit(PairProgram::mark_wholes, PairProgram::mark_rows, 0);
  PairUniforms u = run_.common;
  u.extra[0] = run_.owners.bits;
  run_.device.run(PairProgram::conflicts, 2 * part.cells(), u, {{2, &masks_}});
  run_.counts.mark_ms += start.ms();
}

// Counts the entries of the part's pixels, and gives their lists places; false: too much.
bool PairLists::count(const PairPart& part, PartMemory& memory) {
  PairLevel& pixels = levels_[0];
  levels_cut_ = 0;
  run_.common.cells = static_cast<std::uint32_t>(part.cells());
  rows_before_.reserve(std::max<std::size_t>(items_.items() * kWord, kVec4), memory.block);
  if (items_.row_items() > 0)
    run_.device.scan(items_.rows(), rows_before_, items_.items(), kTotalItems, kTotalRowItems);
  const std::size_t mask_bytes =
      run_.common.masked ? part.cells() * 8 * (1 + 2 * run_.owners.bits) : kVec4;
  if (!memory.take(mask_bytes)) return false;
  masks_.reserve(mask_bytes, memory.block);
  if (!pixels.shape(part.cells(), run_.owners.groups, 2 * items_.wholes() + 8 * items_.row_items(),
                    memory))
    return false;
  if (run_.common.masked) mark(part, mask_bytes);
  run_.device.stamp(PairStamp::marked);
  visit(PairProgram::count_wholes, PairProgram::count_rows, 0);
  run_.device.scan(pixels.counts, pixels.first, pixels.all_bins() + 1, kSerialStart, kTotalEntries);
  return true;
}

bool PairLists::fill(std::size_t shown, std::size_t entries, PartMemory& memory) {
  if (!items_.make_records(shown, memory) || !levels_[0].fill(entries, memory)) return false;
  visit(PairProgram::fill_wholes, PairProgram::fill_rows, entries);
  return true;
}

bool PairLists::make(const PairPart& part, PartMemory& memory) {
  if (!count(part, memory)) return false;
  PairUniforms u = run_.common;
  u.bins = levels_[0].bins;
  run_.device.run(PairProgram::crowded, part.cells(), u, {{4, &levels_[0].first}});
  auto totals = run_.device.read("pair lists");
  if (overflow(totals, memory)) return false;
  if (!fill(totals[kTotalListed], totals[kTotalEntries], memory)) return false;
  for (std::size_t l = 0;; ++l) {
    const std::size_t crowded = l < kMaxLevel ? totals[of_level(kTotalCrowded, l)] : 0;
    if (!take_parents(l, crowded, memory)) return false;
    check(l);
    if (crowded == 0) return true;
    cut(l);
    totals = run_.device.read("pair subdivision");
    check_lists(totals);
    if (totals[of_level(kTotalParents, l)] != crowded) {
      throw Error("GL pairs", "crowded pixels were counted twice with different results",
                  "a compute invocation was lost: run again, or with another {device}");
    }
    if (overflow(totals, memory)) return false;
    if (!fill_cut(l, totals[of_level(kTotalEntries, l + 1)], memory)) return false;
  }
}

bool PairLists::make(const PairPart& part, const PairForecast& forecast, PartMemory& memory) {
  if (!count(part, memory) || !fill(forecast.shown, forecast.entries[0], memory)) return false;
  for (std::size_t l = 0;; ++l) {
    const bool last = l == forecast.levels;
    if (!take_parents(l, last ? 0 : forecast.crowded[l], memory)) return false;
    check(l);
    if (last) return true;
    cut(l);
    if (!fill_cut(l, forecast.entries[l + 1], memory)) return false;
  }
}

// Memory for the cells of level l that are cut, and for the counts of the level below.
bool PairLists::take_parents(std::size_t l, std::size_t crowded, PartMemory& memory) {
  PairLevel& level = levels_[l];
  level.crowded = crowded;
  level.parents.reserve(kVec4, kVec4);
  if (crowded == 0) return true;
  if (!memory.take(level.cells * kWord) || !memory.take(crowded * kVec4)) return false;
  level.state.reserve(level.cells * kWord, memory.block);
  level.parents.reserve(crowded * kVec4, memory.block);
  return levels_[l + 1].shape(crowded * kSubCells, run_.owners.groups, level.listed, memory);
}

// Runs one step of pair_cut.comp on level l.
void PairLists::step(PairProgram program, std::size_t l, const PairWork& work,
                     std::size_t capacity) {
  const PairLevel& level = levels_[l];
  const bool checks = program == PairProgram::parents;
  const PairLevel& below = checks ? level : levels_[l + 1];
  PairUniforms u = run_.common;
  u.bins = below.bins;
  u.capacity = static_cast<std::uint32_t>(capacity);
  u.extra = {static_cast<std::uint32_t>(l), level.bins[0], 0, 0};
  u.numbers[0] = 1;
  for (std::size_t k = 0; k <= l; ++k) u.numbers[0] /= kSubdivision;
  u.numbers[1] = 1 / u.numbers[0];
  run_.device.run(program, work, u,
                  {{0, &items_.record_store()},
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
void PairLists::check(std::size_t l) {
  step(PairProgram::parents, l,
       l == 0 ? PairWork(levels_[0].cells)
              : PairWork(levels_[l - 1].crowded, of_level(kTotalParents, l - 1), 1,
                         static_cast<std::uint32_t>(kSubCells)),
       levels_[l].crowded);
}

// Cuts the crowded cells of level l where that saves tests, and gives the smaller ones places.
void PairLists::cut(std::size_t l) {
  step(PairProgram::cut_count, l, all_entries(l), 0);
  step(PairProgram::cut_decide, l, {levels_[l].crowded, of_level(kTotalParents, l)}, 0);
  levels_cut_ = l + 1;
}

bool PairLists::fill_cut(std::size_t l, std::size_t entries, PartMemory& memory) {
  if (!levels_[l + 1].fill(entries, memory)) return false;
  step(PairProgram::cut_fill, l, all_entries(l), entries);
  return true;
}

void PairLists::set_done() {
  for (std::size_t l = 0; l <= levels_cut_; ++l) levels_[l].dirty = false;
}

void PairLists::set_broken_off() {
  for (PairLevel& level : levels_) level.dirty = true;
}

}  // namespace farcull
