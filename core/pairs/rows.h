// Intervals of one triangle over rows of pixels or of parts of pixels.
#pragma once

#include <algorithm>

#include "core/pairs/grid.h"
#include "core/pairs/interval.h"

namespace farcull {

/// The strip of one triangle over rows of pixels or sub-pixels, and its intervals in them.
class PairRows {
 public:
  PairRows(const PairGrid& grid, std::uint32_t triangle, const PairBounds& bounds)
      : bounds_(bounds),
        a_(grid.corner(triangle, 0)),
        b_(grid.corner(triangle, 1)),
        c_(grid.corner(triangle, 2)) {
    const PairBounds real = grid.real_bounds(triangle);
    margin_ = interval::far_margin(real.lo, real.hi, grid.task().widening);
  }
  /// The range along x of the real triangle between the rows' borders; false: none.
  bool row(float y0, float y1, float& lo, float& hi) {
    interval::far_strip(a_, b_, c_, y0 - margin_.y, y1 + margin_.y, strip_);
    lo = std::max(strip_.lo - margin_.x, bounds_.lo.x);
    hi = std::min(strip_.hi + margin_.x, bounds_.hi.x);
    return lo <= hi;
  }
  /// The interval over a rectangle of the row; false: none.
  bool depths(float x0, float x1, float& near, float& far) {
    if (!interval::far_depths(strip_, x0 - margin_.x, x1 + margin_.x, near, far)) return false;
    near = std::max(near - margin_.z, bounds_.lo.z);
    far = std::min(far + margin_.z, bounds_.hi.z);
    return near <= far;
  }

 private:
  PairBounds bounds_;
  interval::vec4 a_, b_, c_;
  interval::vec4 margin_;
  interval::FarStrip strip_;
};

}  // namespace farcull
