// The error budget: named terms in pixels. The radius of a fattened primitive has to exceed their
// sum, so that the reliability lemmas hold on a real rasterizer. Each term is derived in
// docs/budget.md, in the section of its name.
#pragma once

#include <array>
#include <string>

#include "core/view/view.h"

namespace farcull {

struct BudgetTerm {
  std::string name;  // also that of its section in docs/budget.md
  double px;
};

/// Each term bounds the length of a displacement in the plane or in space, so the square root of
/// the dimension is included.
struct Budget {
  double sampling = 0;  // the largest distance of a point of a pixel from its centre
  double input = 0;     // rounding of proxy corners from double to float32
  double double_ = 0;   // the affine map and the clipping of a primitive that is just drawable
  double vertex = 0;    // rounding of vertex stage, division by w = 1 and viewport transform
  double snap = 0;      // snapping of window coordinates
  double offset = 0;    // rounding of the offset: zero, since offsets round outward

  std::array<BudgetTerm, 6> terms() const;
  /// Strictly greater than the sum of the terms, rounded up.
  double radius() const;
};

/// The budget of one view. `viewport` is the larger side of the viewport in px: |coordinate| <=
/// viewport / 2 for all that is drawn.
Budget budget_for(const RasterLimits& limits, int viewport);

/// The published radius: half the diagonal of a pixel, 1/2 sqrt(dx^2 + dy^2 + dz^2) with dx = dy =
/// 1 px and dz the smallest step of the depth buffer in px (Govindaraju, Lin, Manocha 2004, section
/// 4). It fails on real rasterizers.
double published_radius(double depth_step);

}  // namespace farcull
