// Memory of a part, checks of totals, and the uniforms that all parts of a window share.
#include "core/gl/pairs_run.h"

#include <algorithm>
#include <string>

#include "core/base/error.h"

namespace farcull {

bool PairMemory::take(std::size_t bytes) {
  if (bytes > block && last) {
    throw Error("GL pairs", "one pixel needs a buffer of " + std::to_string(bytes) + " bytes",
                "use --device cpu or a larger --resolution");
  }
  if (last) return true;
  if (bytes > block || bytes > left) return false;
  left -= bytes;
  return true;
}

void PairRun::begin(const PairTask& t) {
  task = &t;
  counts = {};
  counts.bands = 0;
  device.start(true);
  common = {};
  common.widen = {t.widening.x, t.widening.y, t.widening.z, 0};
  common.window = {t.width, t.height};
  // As in PairGrid.
  common.depth = {t.near_px, kSlices / std::max(t.far_px - t.near_px, 0x1p-20f)};
  common.masked =
      std::any_of(t.self.begin(), t.self.end(), [](std::uint8_t self) { return self == 0; });
  owners = scene.begin(t);
}

void check_lists(const PairTotalWords& totals) {
  if (totals[kTotalMismatches] == 0) return;
  throw Error("GL pairs",
              std::to_string(totals[kTotalMismatches]) +
                  " lists were not filled with as many entries as were counted",
              "a compute invocation was lost: run again, or with another --device");
}

bool overflow(const PairTotalWords& totals, const PairMemory& memory) {
  if (totals[kTotalOverflow] == 0) return false;
  if (memory.last) {
    throw Error("GL pairs", "one pixel has more work than can be counted in 32 bits",
                "use --device cpu or a larger --resolution");
  }
  return true;
}

}  // namespace farcull
