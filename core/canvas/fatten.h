// Turns each triangle of a scene into the elements that a canvas draws in one view: the triangle
// itself, or proxies for the triangle grown by a ball. A Fattener holds the functions for this.
#pragma once

#include <functional>
#include <optional>
#include <span>

#include "core/canvas/canvas.h"
#include "core/scene/scene.h"
#include "core/view/view.h"

namespace farcull {

ProxyBounds proxy_bounds(const Window& window);

/// Returns the pixels of the window whose centres are in the bounding rectangle of `points`, grown
/// by `margin` px on each side. points: `step` floats per point; the first two are x and y (px).
PixelRange pixel_range(std::span<const float> points, std::size_t step, double margin,
                       const Window& window);
/// Returns an outline of the proxy with its pixel range. The depth bounds are infinite.
ProxyOutline outline_of(const Proxy& proxy, const Window& window);

/// The largest radius (px) for which the error bounds of fatteners and kernels hold
/// (docs/budget.md, "The radius").
constexpr double kMaxRadius = 0x1p20;

struct Fattener {
  std::string name;  // "raw", "obb", ...
  DepthMode mode;
  SolidProgram solid;  // for DepthMode::fragment only
  /// Appends elements that cover `patch` (the clipped triangle), grown by a ball of `radius` px
  /// (>= 0). Preconditions: the patch is drawable and not empty (patch.count > 0).
  std::function<void(const Patch& patch, double radius, const ProxyBounds& bounds, Drawables& out)>
      fatten;
  /// Fattens many triangles at once, with the same bits as `fatten`, or only finds the outlines of
  /// their proxies (FattenBatch). Skips triangles that must be clipped. May be null.
  void (*fatten_inside)(const FattenBatch& batch) = nullptr;
  bool raw = false;  // true: draws the triangles themselves and ignores the radius
};

/// Returns the fattener of CULLIDE, which draws the clipped triangle itself and ignores the radius.
Fattener raw_triangles();

struct FattenCounts {
  std::uint32_t outside = 0;  // items without elements, because no point is in the region
  std::uint32_t clipped = 0;  // items that were clipped to the region
  std::uint32_t undrawable = 0;
};

/// Returns the elements of `triangles` (items, in this order) in `window`. Runs on all cores; the
/// result does not depend on their number. used: old drawables, whose memory is reused. reach: as
/// FattenBatch::reach. If `reach` is given and the fattener has fatten_inside, most proxies are not
/// made yet (Drawables::fit), and the result keeps pointers to `scene` and `window`.
Drawables fatten(const Scene& scene, std::span<const std::uint32_t> triangles, const Window& window,
                 const Fattener& fattener, double radius, FattenCounts& counts, Drawables used = {},
                 std::optional<double> reach = {});

}  // namespace farcull
