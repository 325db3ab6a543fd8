// The stage between the scene and the canvas: turns each triangle into what a view draws. A
// Fattener is given as functions, so core/ needs no code of offsets and is a complete CULLIDE.
#pragma once

#include <functional>
#include <optional>
#include <span>

#include "core/canvas/canvas.h"
#include "core/scene/scene.h"
#include "core/view/view.h"

namespace farcull {

ProxyBounds proxy_bounds(const Window& window);

/// Returns the pixels of the window whose centres are in the box of `points`, grown by `margin` px
/// on each side. points: every `step` floats begin with x and y (px) of a point.
PixelRange pixel_range(std::span<const float> points, std::size_t step, double margin,
                       const Window& window);
/// Returns the outline of a fitted proxy. Only the outline's pixel range is known.
ProxyOutline outline_of(const Proxy& proxy, const Window& window);

/// The largest radius (px) that offsets and their kernels are derived for (docs/budget.md, "The
/// radius").
constexpr double kMaxRadius = 0x1p20;

struct Fattener {
  std::string name;  // "raw", "obb", ...
  DepthMode mode;
  SolidProgram solid;  // fragment mode only
  /// Appends the elements of one item: `patch`, fattened by a ball of `radius` px (>= 0).
  /// Preconditions: the patch is drawable, and its count is above 0.
  std::function<void(const Patch& patch, double radius, const ProxyBounds& bounds, Drawables& out)>
      fatten;
  /// Fattens many triangles at once to the same bits as `fatten`, or finds the outlines of their
  /// proxies. Skips triangles that need clipping. Null: triangles are fattened one by one.
  void (*fatten_inside)(const FattenBatch& batch) = nullptr;
  bool raw = false;  // draws the triangles themselves, whatever the radius
};

/// Returns CULLIDE's fattener: draws the clipped triangle itself, at fixed depth, without radius.
Fattener raw_triangles();

struct FattenCounts {
  std::uint32_t outside = 0;  // items without elements: no point in the region
  std::uint32_t clipped = 0;  // items cut by the region's border
  std::uint32_t undrawable = 0;
};

/// Returns the elements of `triangles` (items, in this order) in `window`. Runs on all cores; their
/// number does not change the result. used: old drawables, whose memory is reused. reach: as
/// FattenBatch::reach. If `reach` is given and the fattener has fatten_inside, proxies are not
/// fitted yet (Drawables::fit), and the result refers to `scene` and `window`.
Drawables fatten(const Scene& scene, std::span<const std::uint32_t> triangles, const Window& window,
                 const Fattener& fattener, double radius, FattenCounts& counts, Drawables used = {},
                 std::optional<double> reach = {});

}  // namespace farcull
