// The order in which a run visits its views.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/scene/scene.h"
#include "core/view/regions.h"
#include "core/view/view.h"

namespace farcull {

/// Returns the views in another order: each view is the one that should cull most of the triangles
/// that the views before it leave. The numbers are estimates from a sample of the triangles of
/// `regions`, so any order is reliable. The result depends on the arguments alone, and is the same
/// on every machine. owner: per triangle of the scene.
std::vector<View> order_views(const Scene& scene, const Regions& regions,
                              std::span<const std::uint32_t> owner, std::vector<View> views);

}  // namespace farcull
