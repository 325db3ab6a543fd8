// Questions to a kernel and its answers, wherever it runs: on a device
// (core/gl/probe/probe.h) or on the CPU. verify/kernel_check.h decides which answers are right.
#pragma once

#include <array>
#include <cstdint>

#include "core/canvas/canvas.h"

namespace farcull {

/// A solid, and the line along the depth through a pixel centre (px).
struct SolidCase {
  float cx, cy;
  Solid solid;
};
/// What solid_interval (core/canvas/canvas.h) gives for a SolidCase; without a hit, entry and exit
/// mean nothing.
struct SolidAnswer {
  bool hit;
  float entry, exit;
};

}  // namespace farcull
