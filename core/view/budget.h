// The error budget: named terms, in pixels, whose sum the radius of a fattened primitive has to
// exceed so that the reliability lemmas hold on a real rasterizer. Each term is derived in
// docs/budget.md, in the section of its name.
#pragma once

#include <array>
#include <string>

#include "core/view/view.h"

namespace farcull {

struct BudgetTerm {
  std::string name;  // also the section of docs/budget.md
  double px;
};

/// All terms are bounds on a displacement in the plane or in space, square roots of the dimension
/// included.
struct Budget {
  double sampling = 0;  // a point of a pixel is this far from its centre, at most
  double input = 0;     // proxy corners, double to float32
  double double_ =
      0;              // the affine map and the clipping, of a primitive at the limit of drawability
  double vertex = 0;  // vertex stage, division by w = 1, viewport transform
  double snap = 0;    // snapping of window coordinates
  double offset = 0;  // the offset's own rounding: zero, since offsets round outward

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
