// The stage between the scene and the canvas: turns each triangle into what a view draws. The
// offset arrives as a function, so that core alone, with raw triangles, is a complete CULLIDE.
#pragma once

#include <functional>
#include <optional>
#include <span>

#include "core/canvas/canvas.h"
#include "core/scene/scene.h"
#include "core/view/view.h"

namespace farcull {

ProxyBounds proxy_bounds(const Window& window);

/// The pixels of the window whose centres are in the box of `points`, grown by `margin` px on each
/// side. points: every `step` floats begin with x and y (px) of a point.
PixelRange pixel_range(std::span<const float> points, std::size_t step, double margin,
                       const Window& window);
/// The outline of a fitted proxy. Only its pixels are known.
ProxyOutline outline_of(const Proxy& proxy, const Window& window);

/// The largest radius (px) that offsets and their kernels are derived for (docs/budget.md, "The
/// radius").
constexpr double kMaxRadius = 0x1p20;

struct Fattener {
  std::string name;  // "raw", "obb", ...
  DepthMode mode;
  SolidProgram solid;  // fragment mode only
  /// Appends the elements of one item: `patch` (drawable, count > 0) fattened by a ball of `radius`
  /// px (>= 0).
  std::function<void(const Patch& patch, double radius, const ProxyBounds& bounds, Drawables& out)>
      fatten;
  /// Fattens many triangles at once, except those that need clipping, to the same bits as `fatten`;
  /// or finds the outlines of their proxies. Null: triangles are fattened one by one.
  void (*fatten_inside)(const FattenBatch& batch) = nullptr;
  bool raw = false;  // draws the triangles themselves, whatever the radius
};

/// CULLIDE's primitives: the clipped triangle itself, fixed-function depth; the radius is not used.
Fattener raw_triangles();

struct FattenCounts {
  std::uint32_t outside = 0;  // items without elements: no point in the region
  std::uint32_t clipped = 0;  // items cut by the region's border
  std::uint32_t undrawable = 0;
};

/// The elements of `triangles` (items, in this order) in `window`. Runs on all cores; the result
/// does not depend on them. used: drawables no longer needed; their memory is reused. reach: as
/// FattenBatch::reach. If it is given and the fattener has fatten_inside, proxies wait to be fitted
/// (Drawables::fit), and the result refers to `scene` and `window`.
Drawables fatten(const Scene& scene, std::span<const std::uint32_t> triangles, const Window& window,
                 const Fattener& fattener, double radius, FattenCounts& counts, Drawables used = {},
                 std::optional<double> reach = {});

}  // namespace farcull
