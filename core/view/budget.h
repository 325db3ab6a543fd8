// The error budget: named terms in pixels. The radius of a fattened primitive has to exceed the sum
// of the terms, so that the reliability lemmas hold on a real rasterizer. docs/budget.md derives
// each term in a section with the term's name.
#pragma once

#include <array>
#include <string>

#include "core/view/view.h"

namespace farcull {

struct BudgetTerm {
  std::string name;  // the title of its section in docs/budget.md
  double px;
};

/// Each term bounds the length of a displacement in px. So if it bounds coordinates, it includes
/// the square root of the dimension.
struct Budget {
  double sampling = 0;  // the largest distance of a point of a pixel from the pixel's centre
  double input = 0;     // rounding of proxy corners from double to float32
  double double_ = 0;   // rounding of the affine map and of clipping, in double
  double vertex = 0;    // rounding of vertex stage, division by w = 1 and viewport transform
  double snap = 0;      // snapping of window coordinates
  double offset = 0;    // rounding of the offset: zero, since offsets round outward

  std::array<BudgetTerm, 6> terms() const;
  /// Returns a number strictly greater than the sum of the terms (px).
  double radius() const;
};

/// Returns the budget of one view. viewport: the larger side of the viewport in px. Every drawn
/// |coordinate| is at most viewport / 2.
Budget budget_for(const RasterLimits& limits, int viewport);

/// Returns the published radius in px, which fails on real rasterizers: half the diagonal of a
/// pixel, 1/2 sqrt(dx^2 + dy^2 + dz^2). dx = dy = 1 px; dz is the smallest step of the depth buffer
/// in px (Govindaraju, Lin, Manocha 2004, section 4).
double published_radius(double depth_step);

}  // namespace farcull
