// Items are counted first; where they do not fit their buffers, these grow and the items are made
// again.
#include "core/gl/pairs_items.h"

#include <algorithm>

#include "core/base/error.h"

namespace farcull {

bool PairItems::make(PairMemory& memory) {
  PairUniforms u = run_.common;
  u.extra[1] = run_.scene.gathered();
  u.numbers[0] =
      std::max<float>(kLargePixels, 0.125f * static_cast<float>(run_.task->active.size()));
  for (GlStore* store : {&heads_, &records_, &record_heads_, &listed_flags_, &shown_list_}) {
    store->reserve(kVec4, kVec4);
  }
  for (int attempt = 0;; ++attempt) {
    const std::size_t whole_capacity = heads_.bytes() / kVec4;
    const std::size_t capacity = std::min(
        {records_.bytes() / kRecord, record_heads_.bytes() / kVec4, listed_flags_.bytes() / kWord});
    u.capacity = static_cast<std::uint32_t>(capacity);
    u.extra[2] = static_cast<std::uint32_t>(whole_capacity);
    run_.device.reset(kItemTotals);
    run_.scene.for_each_piece([&](std::size_t first, std::size_t count) {
      u.extra[0] = static_cast<std::uint32_t>(first);
      run_.device.run(
          PairProgram::items, count, u,
          run_.scene.bindings(records_, record_heads_, {{8, &heads_}, {9, &listed_flags_}}));
    });
    const auto totals = run_.device.read("pair items");
    wholes_ = totals[kTotalWholes];
    items_ = totals[kTotalItems];
    large_ = totals[kTotalLarge];
    row_items_ = two_words(totals, kTotalRows);
    if (wholes_ <= whole_capacity && items_ <= capacity) break;
    if (attempt > 0) {
      throw Error("GL pairs", "the same triangles were counted twice with different results",
                  "a command was lost: run again, or with another --device");
    }
    PairMemory trial = memory;
    if (!trial.take(wholes_ * kVec4) || !trial.take(items_ * kRecord)) return false;
    heads_.reserve(wholes_ * kVec4, memory.block);
    records_.reserve(items_ * kRecord, memory.block);
    record_heads_.reserve(items_ * kVec4, memory.block);
    listed_flags_.reserve(items_ * kWord, memory.block);
  }
  run_.common.items = static_cast<std::uint32_t>(items_);
  if (!memory.take(wholes_ * kVec4) || !memory.take(wholes_ * kWord) ||
      !memory.take(items_ * kRecord) || !memory.take(items_ * (kVec4 + 3 * kWord))) {
    return false;
  }
  shown_list_.reserve(wholes_ * kWord, memory.block);
  return row_items_ >> 31 == 0 || memory.last;
}

bool PairItems::make_records(std::size_t shown, PairMemory& memory) {
  shown_ = shown;
  if (shown_ == 0) return true;
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
        PairProgram::records, shown_, u,
        run_.scene.bindings(records_, record_heads_, {{8, &heads_}, {9, &shown_list_}}));
  });
  return true;
}

}  // namespace farcull
