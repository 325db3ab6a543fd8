// Memory of a part, checks of totals, and the uniforms that all parts of a window share.
#include "core/gl/pairs_run.h"

#include <algorithm>
#include <string>

#include "core/base/error.h"
#include "core/pairs/grid.h"

namespace farcull {

bool PartMemory::take(std::size_t bytes) {
  if (bytes > block && last) {
    throw Error("GL pairs", "one pixel needs a buffer of " + std::to_string(bytes) + " bytes",
                "use {device} cpu or a larger {resolution}");
  }
  if (last) return true;
  if (bytes > block || bytes > left) return false;
  left -= bytes;
  return true;
}

namespace {

constexpr std::size_t kLeastRoom = 64;

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

void PairRun::begin(const PairTask& t) {
  task = &t;
  counts = {};
  counts.bands = 0;
  device.start(true);
  common = {};
  common.widen = {t.widening.x, t.widening.y, t.widening.z, 0};
  common.window = {t.width, t.height};
  const DepthSlices slices = depth_slices(t.near_px, t.far_px);
  common.steps_per_px = slices.steps_per_px;
  common.first_step = slices.first_step;
  common.slices_per_step = slices.slices_per_step;
  common.masked =
      std::any_of(t.self.begin(), t.self.end(), [](std::uint8_t self) { return self == 0; });
  owners = scene.begin(t);
}

void check_lists(const PairTotalWords& totals) {
  if (totals[kTotalMismatches] == 0) return;
  throw Error(
      "GL pairs",
      std::to_string(totals[kTotalMismatches]) + " lists were not filled as they were counted",
      "a compute invocation was lost, or two programs of this device round differently: run "
      "again, or with another {device}");
}

bool overflow(const PairTotalWords& totals, const PartMemory& memory) {
  if (totals[kTotalOverflow] == 0) return false;
  if (memory.last) {
    throw Error("GL pairs", "one pixel has more work than can be counted in 32 bits",
                "use {device} cpu or a larger {resolution}");
  }
  return true;
}

}  // namespace farcull
