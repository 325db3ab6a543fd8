// `farcull experiment lemma`: the lemmas on a canvas at one radius, or along a sweep of the radius
// factor.
#pragma once

#include <cstdint>
#include <functional>
#include <string>

#include "core/cull/cull.h"

namespace farcull {

struct LemmaArguments {
  std::uint64_t points = 100000;
  std::string radius = "budget";  // budget, published or a factor
  std::string sweep;              // FROM:TO:STEP of the factor; then `radius` is not used
  /// native, gl or worst; empty: that of the device; without one GL where hardware answers and
  /// passes its probes, else native.
  std::string canvas;
  std::string offset = "obb";  // obb or exact
  std::string device;
  std::uint64_t seed = 1;
  std::string json;
  std::string csv;  // of the sweep
};

/// Prints the rows; writes --json and --csv. 0: no violation at the budget radius or beyond (others
/// promise nothing); 1: one. Throws Error for bad arguments and for faults of the device. `done` is
/// called before anything is printed, to clear the progress.
int lemma_command(const LemmaArguments& arguments, const Progress& progress,
                  const std::function<void()>& done);

}  // namespace farcull
