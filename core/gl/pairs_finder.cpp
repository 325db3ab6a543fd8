// A part of the window that is too much for the memory is split in two, down to single pixels.
#include "core/gl/pairs_finder.h"

#include <algorithm>

#include "core/base/stopwatch.h"

namespace farcull {

std::vector<TrianglePair> PairFinder::find(const PairTask& task, PairCounts& counts) {
  const Stopwatch start;
  run_.begin(task);
  emission_.begin();
  run_.counts.mark_ms = start.ms();
  if (!task.active.empty()) split({0, task.width - 1, 0, task.height - 1});
  run_.counts.dispatches = run_.device.dispatches();
  run_.counts.readbacks = run_.device.readbacks();
  counts = run_.counts;
  return emission_.take();
}

// One part of the window; false: too much for the memory.
bool PairFinder::find_in(const PairPart& part) {
  PairMemory memory{run_.options.memory, run_.device.block(), part.cells() == 1};
  // The bytes that every pixel needs, before any work is done.
  const std::size_t fixed = part.cells() * (2 * run_.owners.groups * kWord +
                                            (run_.common.masked ? 8 + 16 * run_.owners.bits : 0));
  if (!memory.last && (fixed > memory.left / 2 || fixed > memory.block)) return false;

  const Stopwatch marking;
  run_.device.start(false);
  run_.common.tile = {part.i0, part.i1, part.j0, part.j1};
  if (!items_.make(memory)) return false;
  run_.counts.mark_ms += marking.ms();
  if (items_.empty()) return true;

  const double marked = run_.counts.mark_ms;
  const Stopwatch listing;
  if (!lists_.make(part, memory)) return false;
  run_.counts.list_ms += listing.ms() - (run_.counts.mark_ms - marked);

  const Stopwatch pairing;
  emission_.settle(lists_.level(0), memory);
  std::size_t crowded = run_.counts.crowded;
  for (std::size_t l = 0;; ++l) {
    std::size_t crowded_below = 0;
    const bool some_cut = crowded > 0 && l < kMaxLevel;
    if (some_cut && !lists_.cut(l, crowded, memory, crowded_below)) return false;
    if (!emission_.test(lists_.level(l), l == 0, some_cut, memory)) return false;
    run_.counts.entries += lists_.level(l).listed;
    if (!some_cut) break;
    crowded = crowded_below;
  }
  emission_.compare_large(memory);
  check_lists(run_.device.read("pairs"));
  lists_.set_dirty(false);
  run_.counts.large = std::max<std::uint64_t>(run_.counts.large, items_.large());
  run_.counts.pair_ms += pairing.ms();
  return true;
}

void PairFinder::split(const PairPart& part) {
  const PairCounts before = run_.counts;
  run_.counts.crowded = 0;
  if (find_in(part)) {
    run_.counts.crowded += before.crowded;
    ++run_.counts.bands;
    return;
  }
  // The next parts believe what was sent for this one, so it is checked first.
  run_.device.read("pairs");
  run_.counts = before;
  lists_.set_dirty(true);
  PairPart low = part, high = part;
  if (part.height() > 1) {
    low.j1 = part.j0 + part.height() / 2 - 1;
    high.j0 = low.j1 + 1;
  } else {
    low.i1 = part.i0 + part.width() / 2 - 1;
    high.i0 = low.i1 + 1;
  }
  split(low);
  split(high);
}

}  // namespace farcull
