#include <algorithm>
#include <chrono>

#include "core/error.h"
#include "core/gl_pairs_parts.h"

namespace farcull {
namespace {

using Clock = std::chrono::steady_clock;

constexpr std::size_t kSubCells = kSubdivision * kSubdivision;
constexpr std::size_t kBins = std::size_t{1} << 20;  // that are wanted at most

}  // namespace

bool PairLevel::shape(std::size_t n, std::uint32_t groups, std::uint64_t expected, PairRoom& room) {
  cells = n;
  std::uint32_t slices = kSlices, shift = 0;
  const std::size_t most = std::min<std::uint64_t>({expected, kBins, room.left / (8 * kWord)});
  while (slices > 1 && cells * groups * slices > most) {
    slices /= 2;
    ++shift;
  }
  bins = {groups * slices, shift, slices, groups - 1};
  const std::size_t wanted = (all_bins() + 1) * kWord;
  if (!room.take(wanted) || !room.take(wanted)) return false;
  if (counts.reserve(wanted, room.block)) dirty = true;
  if (dirty) {
    counts.clear(counts.bytes());
  }
  dirty = true;  // until all that is counted is filled in
  first.reserve(wanted, room.block);
  for (GlStore* store : {&entries, &places}) store->reserve(kVec4, kVec4);
  return true;
}

bool PairLevel::fill(std::size_t n, PairRoom& room) {
  listed = n;
  if (!room.take(n * kEntry) || !room.take(n * 2 * kWord)) return false;
  entries.reserve(n * kEntry, room.block);
  places.reserve(n * 2 * kWord, room.block);
  return true;
}

// One step of pair_lists.comp.
void GlPairs::State::visit(PairProgram wholes_program, PairProgram rows_program,
                           std::size_t capacity) {
  PairUniforms u = common;
  const PairLevel& pixels = levels[0];
  const bool fill = wholes_program == PairProgram::fill_wholes;
  u.bins = pixels.bins;
  u.capacity = static_cast<std::uint32_t>(capacity);
  u.extra[0] = owner_bits;
  for (const bool by_rows : {false, true}) {
    device.run(by_rows ? rows_program : wholes_program,
               by_rows ? row_items : (fill ? shown_ones : wholes), u,
               {{0, &records},
                {1, &rows_before},
                {2, &masks},
                {3, &pixels.counts},
                {4, &pixels.first},
                {6, by_rows || fill ? &record_heads : &heads},
                {8, by_rows ? &listed : &shown},
                {9, &pixels.entries},
                {10, &pixels.places}});
  }
}

// The whole items that are listed become records; false: too many.
bool GlPairs::State::make_records(PairRoom& room) {
  if (shown_ones == 0) return true;
  const std::size_t all = items + shown_ones;
  if (!room.take(shown_ones * kRecord) || !room.take(shown_ones * kVec4) ||
      all * kRecord > room.block) {
    return false;
  }
  device.grow(records, all * kRecord, items * kRecord);
  device.grow(record_heads, all * kVec4, items * kVec4);
  PairUniforms u = common;
  u.extra[1] = gathered;
  send([&](std::size_t first, std::size_t count) {
    u.extra[0] = static_cast<std::uint32_t>(first);
    u.extra[2] = static_cast<std::uint32_t>(count);
    device.run(PairProgram::records, shown_ones, u, with_scene({{8, &heads}, {9, &shown}}));
  });
  return true;
}

// The lists of the part's pixels; false: too much.
bool GlPairs::State::lists(const PairPart& tile, PairRoom& room) {
  PairLevel& pixels = levels[0];
  common.cells = static_cast<std::uint32_t>(tile.cells());
  rows_before.reserve(std::max<std::size_t>(items * kWord, kVec4), room.block);
  if (row_items > 0) {
    rows.reserve(items * kWord, room.block);
    device.run(PairProgram::spans, items, common, {{3, &rows}, {6, &record_heads}});
    device.scan(rows, rows_before, items);
  }
  const std::size_t mask_bytes = common.masked ? tile.cells() * 8 * (1 + 2 * owner_bits) : kVec4;
  if (!room.take(mask_bytes)) return false;
  masks.reserve(mask_bytes, room.block);
  if (!pixels.shape(tile.cells(), groups, 2 * wholes + 8 * row_items, room)) return false;
  if (common.masked) {
    const auto start = Clock::now();
    // Where this is lost, slices are left that seem to be touched: more is listed, nothing less.
    masks.clear(mask_bytes);
    visit(PairProgram::mark_wholes, PairProgram::mark_rows, 0);
    PairUniforms u = common;
    u.extra[0] = owner_bits;
    device.run(PairProgram::conflicts, 2 * tile.cells(), u, {{2, &masks}});
    counts.mark_ms += std::chrono::duration<double, std::milli>(Clock::now() - start).count();
  }
  visit(PairProgram::count_wholes, PairProgram::count_rows, 0);
  if (device.fault == PairFault::corrupted_count) {
    const std::size_t at = device.fault_at % pixels.all_bins() * kWord;
    std::uint32_t count = 0;
    pixels.counts.read(at, &count, kWord);
    ++count;
    pixels.counts.write(at, &count, kWord);
    device.fault = PairFault::none;
  }
  device.scan(pixels.counts, pixels.first, pixels.all_bins() + 1);
  PairUniforms u = common;
  u.bins = pixels.bins;
  device.run(PairProgram::crowded, tile.cells(), u, {{3, &pixels.counts}, {4, &pixels.first}});
  const auto totals = device.read("pair lists");
  if (overflow(totals, room)) return false;
  shown_ones = totals[kTotalListed];
  counts.crowded += totals[kTotalCrowded];
  if (!make_records(room) || !pixels.fill(totals[kTotalScanned], room)) return false;
  visit(PairProgram::fill_wholes, PairProgram::fill_rows, pixels.listed);
  device.run(PairProgram::filled, pixels.all_bins(), u, {{3, &pixels.counts}, {4, &pixels.first}});
  counts.listed += totals[kTotalListed] + totals[kTotalListedRows];
  return true;
}

// Cuts the crowded cells of level l into those of the next; false: too much.
bool GlPairs::State::cut(std::size_t l, std::size_t crowded, PairRoom& room,
                         std::size_t& crowded_below) {
  PairLevel& level = levels[l];
  PairLevel& below = levels[l + 1];
  if (!room.take(level.cells * kWord) || !room.take(crowded * kVec4)) return false;
  level.state.reserve(level.cells * kWord, room.block);
  level.parents.reserve(crowded * kVec4, room.block);
  if (!below.shape(crowded * kSubCells, groups, level.listed, room)) return false;

  PairUniforms u = common;
  u.bins = below.bins;
  u.capacity = static_cast<std::uint32_t>(crowded);
  u.extra = {static_cast<std::uint32_t>(l), level.bins[0], 0, 0};
  u.numbers[0] = 1;
  for (std::size_t k = 0; k <= l; ++k) u.numbers[0] /= kSubdivision;
  u.numbers[1] = 1 / u.numbers[0];
  const auto step = [&](PairProgram program, std::size_t n) {
    device.run(program, n, u,
               {{0, &records},
                {1, l > 0 ? &levels[l - 1].parents : &level.parents},
                {2, &level.parents},
                {3, &below.counts},
                {4, program == PairProgram::parents ? &level.first : &below.first},
                {5, &level.entries},
                {6, &level.places},
                {8, &level.state},
                {9, &below.entries},
                {10, &below.places}});
  };
  device.reset(kCutTotals);
  step(PairProgram::parents, level.cells);
  step(PairProgram::cut_count, level.listed);
  step(PairProgram::cut_decide, crowded);
  device.scan(below.counts, below.first, below.all_bins() + 1);
  device.run(PairProgram::crowded, below.cells, u, {{3, &below.counts}, {4, &below.first}});
  const auto totals = device.read("pair subdivision");
  if (totals[kTotalParents] != crowded) {
    throw Error("GL pairs", "crowded pixels were counted twice with different results",
                "a compute invocation was lost: run again, or with another --device");
  }
  if (overflow(totals, room)) return false;
  crowded_below = totals[kTotalCrowded];
  if (!below.fill(totals[kTotalScanned], room)) return false;
  u.capacity = static_cast<std::uint32_t>(below.listed);
  if (below.listed > 0) step(PairProgram::cut_fill, level.listed);
  device.run(PairProgram::filled, below.all_bins(), u, {{3, &below.counts}, {4, &below.first}});
  return true;
}

}  // namespace farcull
