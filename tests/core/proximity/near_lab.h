// The old place of tests/lab/grid_distance.h.
#pragma once

#include "tests/lab/grid_distance.h"

namespace farcull::near_lab {

template <class T, class Visit>
void each_direction(const Corners<T>& a, const Corners<T>& b, const Visit& visit) {
  reference::any_direction(a, b, [&](const Triple<T>& d) {
    visit(d);
    return false;
  });
}
template <class T>
T gap_along(const Triple<T>& d, const Corners<T>& a, const Corners<T>& b) {
  return reference::gap(a, b, d);
}

}  // namespace farcull::near_lab
