// Chooses the order in which a run visits its views.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/scene/scene.h"
#include "core/view/regions.h"
#include "core/view/view.h"

namespace farcull {

/// Returns the views in greedy order: of the remaining views, the next view is the one that should
/// cull the most triangles. Estimates these numbers from a sample of the triangles of `regions`.
/// The order affects speed, but no order loses a collision. The result is the same on every
/// machine. owner: per triangle of the scene.
std::vector<View> order_views(const Scene& scene, const Regions& regions,
                              std::span<const std::uint32_t> owner, std::vector<View> views);

}  // namespace farcull
