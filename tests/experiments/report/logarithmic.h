// An axis for tests.
#pragma once

#include "experiments/report/axes.h"

namespace farcull {

inline Axis logarithmic(bool zero = false) {
  Axis axis;
  axis.label = "pairs";
  axis.logarithmic = true;
  axis.shows_zero = zero;
  return axis;
}

}  // namespace farcull
