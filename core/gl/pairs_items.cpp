// Items are counted first; where they do not fit their buffers, these grow and the items are made
// again.
#include "core/gl/pairs_items.h"

#include <algorithm>

#include "core/base/error.h"

namespace farcull {
namespace {

// A first guess, so that few windows make their items twice: a whole item for each triangle and a
// record for one in eight, where that takes little of the memory.
constexpr std::size_t kGuessedRecords = 8, kGuessPart = 16;

}  // namespace

void PairItems::launch(std::size_t whole_capacity, std::size_t capacity) {
  PairUniforms u = run_.common;
  u.numbers[0] = large_pixels(run_.task->active.size());
  u.capacity = static_cast<std::uint32_t>(capacity);
  u.extra = {0, run_.scene.gathered(), static_cast<std::uint32_t>(whole_capacity), 0};
  run_.scene.for_each_piece([&](std::size_t first, std::size_t count) {
    u.extra[0] = static_cast<std::uint32_t>(first);
    run_.device.run(PairProgram::items, count, u,
                    run_.scene.bindings(records_, record_heads_,
                                        {{8, &heads_}, {9, &listed_flags_}, {10, &rows_}}));
  });
}

bool PairItems::take(PartMemory& memory) const {
  return memory.take(wholes_ * kVec4) && memory.take(wholes_ * kWord) &&
         memory.take(items_ * kRecord) && memory.take(items_ * (kVec4 + 3 * kWord));
}

bool PairItems::make(PartMemory& memory) {
  for (GlStore* store : {&heads_, &records_, &record_heads_, &listed_flags_, &shown_list_, &rows_})
    store->reserve(kVec4, kVec4);
  const auto reserve = [&](std::size_t wholes, std::size_t items) {
    heads_.reserve(wholes * kVec4, memory.block);
    records_.reserve(items * kRecord, memory.block);
    record_heads_.reserve(items * kVec4, memory.block);
    listed_flags_.reserve(items * kWord, memory.block);
    rows_.reserve(items * kWord, memory.block);
  };
  const std::size_t guess = run_.task->active.size();
  if (guess * kVec4 <= std::min(memory.left / kGuessPart, memory.block))
    reserve(guess, guess / kGuessedRecords);
  for (int attempt = 0;; ++attempt) {
    const std::size_t whole_capacity = heads_.bytes() / kVec4;
    const std::size_t capacity =
        std::min({records_.bytes() / kRecord, record_heads_.bytes() / kVec4,
                  listed_flags_.bytes() / kWord, rows_.bytes() / kWord});
    run_.device.reset(kItemTotals);
    launch(whole_capacity, capacity);
    const auto totals = run_.device.read("pair items");
    wholes_ = totals[kTotalWholes];
    items_ = totals[kTotalItems];
    large_ = totals[kTotalLarge];
    row_items_ = two_words(totals, kTotalRows);
    if (wholes_ <= whole_capacity && items_ <= capacity) break;
    if (attempt > 0) {
      throw Error("GL pairs", "the same triangles were counted twice with different results",
                  "a command was lost: run again, or with another {device}");
    }
    PartMemory trial = memory;
    if (!trial.take(wholes_ * kVec4) || !trial.take(items_ * kRecord)) return false;
    reserve(wholes_, items_);
  }
  run_.common.items = static_cast<std::uint32_t>(items_);
  if (!take(memory)) return false;
  shown_list_.reserve(wholes_ * kWord, memory.block);
  return row_items_ >> 31 == 0 || memory.last;
}

bool PairItems::make(const PairForecast& forecast, PartMemory& memory) {
  wholes_ = forecast.wholes;
  items_ = forecast.items;
  large_ = forecast.large;
  row_items_ = forecast.row_items;
  const std::size_t all = items_ + forecast.shown;
  if (!take(memory) || all * kRecord > memory.block || row_items_ >> 31 != 0) return false;
  heads_.reserve(wholes_ * kVec4, memory.block);
  records_.reserve(all * kRecord, memory.block);
  record_heads_.reserve(all * kVec4, memory.block);
  listed_flags_.reserve(items_ * kWord, memory.block);
  rows_.reserve(items_ * kWord, memory.block);
  shown_list_.reserve(wholes_ * kWord, memory.block);
  run_.common.items = static_cast<std::uint32_t>(items_);
  launch(wholes_, items_);
  return true;
}

bool PairItems::make_records(std::size_t shown, PartMemory& memory) {
  shown_ = shown;
  const std::size_t all = records();
  if (!memory.take(shown_ * kRecord) || !memory.take(shown_ * kVec4) ||
      all * kRecord > memory.block) {
    return false;
  }
  run_.device.grow(records_, all * kRecord, items_ * kRecord);
  run_.device.grow(record_heads_, all * kVec4, items_ * kVec4);
  PairUniforms u = run_.common;
  u.extra[1] = run_.scene.gathered();
  run_.scene.for_each_piece([&](std::size_t first, std::size_t count) {
    u.extra[0] = static_cast<std::uint32_t>(first);
    u.extra[2] = static_cast<std::uint32_t>(count);
    run_.device.run(
        PairProgram::records, all_shown(), u,
        run_.scene.bindings(records_, record_heads_, {{8, &heads_}, {9, &shown_list_}}));
  });
  return true;
}

}  // namespace farcull
