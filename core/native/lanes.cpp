// Lists the usable instruction sets, and selects the set that Highway's dispatch calls.
#include "core/native/canvas.h"

#include <hwy/highway.h>
#include <hwy/targets.h>

#include <atomic>
#include <cstdint>

#include "core/base/error.h"

namespace farcull {
namespace {

// Returns the instruction sets that were compiled and that the processor supports, the best first.
// In Highway's masks, a lower bit means a better instruction set.
std::vector<std::int64_t> usable() {
  std::vector<std::int64_t> found;
  const std::int64_t both = hwy::SupportedTargets() & HWY_TARGETS;
  for (int bit = 0; bit < 63; ++bit) {
    if (both >> bit & 1) found.push_back(std::int64_t{1} << bit);
  }
  return found;
}

std::atomic<std::int64_t>& chosen() {
  static std::atomic<std::int64_t> target = usable().front();
  return target;
}

}  // namespace

std::vector<std::string> lane_targets() {
  std::vector<std::string> names;
  for (const std::int64_t bit : usable()) names.emplace_back(hwy::TargetName(bit));
  return names;
}

std::string lane_target() { return hwy::TargetName(chosen()); }

void use_lane_target(const std::string& name) {
  std::string known;
  for (const std::int64_t bit : usable()) {
    const std::string is = hwy::TargetName(bit);
    if (name.empty() || name == is) {
      chosen() = bit;
      hwy::GetChosenTarget().Update(bit);
      return;
    }
    known += (known.empty() ? "" : ", ") + is;
  }
  throw Error("lanes", "this processor has no '" + name + "'", "choose one of " + known);
}

}  // namespace farcull
