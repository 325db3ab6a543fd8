// The error budget: named terms in pixels. The radius of a fattened primitive must exceed the sum
// of the terms; then the reliability lemmas hold on a real rasterizer. For each term,
// docs/budget.md has a section of the same name with the derivation.
#pragma once

#include <array>
#include <string>

#include "core/view/view.h"

namespace farcull {

struct BudgetTerm {
  std::string name;  // also the title of the term's section in docs/budget.md
  double px;
};

/// Each term bounds the length of a displacement in px. A term that is derived from bounds of
/// single coordinates includes the square root of the dimension.
struct Budget {
  double sampling = 0;  // largest distance of a point of a pixel from the pixel's centre
  double input = 0;     // rounding of proxy corners from double to float32
  double double_ = 0;   // rounding of the affine map and of clipping, in double
  double vertex = 0;    // rounding of vertex stage, division by w = 1, viewport transform
  double snap = 0;      // snapping of window coordinates
  double offset = 0;    // rounding of the offset: zero, since offsets round outward

  std::array<BudgetTerm, 6> terms() const;
  /// Returns a number strictly greater than the sum of the terms (px).
  double radius() const;
};

/// Returns the budget of one view. viewport: the larger side of the viewport in px. Every
/// |coordinate| that is drawn is at most viewport / 2.
Budget budget_for(const RasterLimits& limits, int viewport);

/// Returns the radius in px that was published (Govindaraju, Lin, Manocha 2004, section 4). It is
/// half the diagonal of a pixel, 1/2 sqrt(dx^2 + dy^2 + dz^2), with dx = dy = 1 px. dz is the
/// smallest step of the depth buffer in px. This radius is too small for real rasterizers.
double published_radius(double depth_step);

}  // namespace farcull
