// Turns each triangle of a scene into the elements that a canvas draws in one view. A Fattener
// holds functions, so that core/ can run CULLIDE without the code of offsets.
#pragma once

#include <functional>
#include <optional>
#include <span>

#include "core/canvas/canvas.h"
#include "core/scene/scene.h"
#include "core/view/view.h"

namespace farcull {

ProxyBounds proxy_bounds(const Window& window);

/// Returns the pixels of the window whose centres are in the box of `points`, enlarged by `margin`
/// px on each side. points: `step` floats for each point; the first two are x and y (px).
PixelRange pixel_range(std::span<const float> points, std::size_t step, double margin,
                       const Window& window);
/// Returns the outline of a fitted proxy, with its pixel range only.
ProxyOutline outline_of(const Proxy& proxy, const Window& window);

/// Largest radius (px) for which offsets and their kernels are derived (docs/budget.md, "The
/// radius").
constexpr double kMaxRadius = 0x1p20;

struct Fattener {
  std::string name;  // "raw", "obb", ...
  DepthMode mode;
  SolidProgram solid;  // for DepthMode::fragment only
  /// Appends the elements of one item: `patch`, fattened by a ball of `radius` px (>= 0).
  /// Preconditions: the patch is drawable and not empty (patch.count > 0).
  std::function<void(const Patch& patch, double radius, const ProxyBounds& bounds, Drawables& out)>
      fatten;
  /// Fattens many triangles at once, with the same bits as `fatten`, or finds the outlines of their
  /// proxies (FattenBatch). Skips triangles that need clipping. Null: only `fatten` is used.
  void (*fatten_inside)(const FattenBatch& batch) = nullptr;
  bool raw = false;  // draws the triangles themselves, for any radius
};

/// Returns CULLIDE's fattener: draws the clipped triangle itself, at fixed depth, without radius.
Fattener raw_triangles();

struct FattenCounts {
  std::uint32_t outside = 0;  // items without elements: no point is in the region
  std::uint32_t clipped = 0;  // items that the region's border cuts
  std::uint32_t undrawable = 0;
};

/// Returns the elements of `triangles` (items, in this order) in `window`. Runs on all cores; their
/// number does not change the result. used: old drawables, whose memory is reused. reach: as
/// FattenBatch::reach. If `reach` is given and the fattener has fatten_inside, the proxies are not
/// fitted yet (Drawables::fit), and the result refers to `scene` and `window`.
Drawables fatten(const Scene& scene, std::span<const std::uint32_t> triangles, const Window& window,
                 const Fattener& fattener, double radius, FattenCounts& counts, Drawables used = {},
                 std::optional<double> reach = {});

}  // namespace farcull
