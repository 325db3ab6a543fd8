#include "core/pairs/view.h"

#include <algorithm>
#include <atomic>
#include <cmath>

#include "core/base/parallel.h"
#include "core/pairs/grown_box.h"

namespace farcull {
namespace {

constexpr double kLargest = 0x1p20;         // px, of a coordinate that kernels take
constexpr double kSmallest = 0x1p-60;       // px, of one that is not zero
constexpr double kLeastWidening = 0x1p-40;  // px

// A float that is not below x.
float float_above(double x) {
  const float f = static_cast<float>(x);
  return f < x ? std::nextafter(f, HUGE_VALF) : f;
}
float float_below(double x) { return -float_above(-x); }

PixelVertex pixel_vertex(const Vec3& p) {
  const auto rounded = [](double x) { return static_cast<float>(std::abs(x) < kSmallest ? 0 : x); };
  return {rounded(p.x()), rounded(p.y()), rounded(p.z()), 0};
}

}  // namespace

std::optional<PairWindow> pair_window(const PairRegions& regions, const View& view, int resolution,
                                      double clearance) {
  std::vector<Box> present;
  for (const Box& box : regions.objects) {
    if (box.is_empty()) continue;
    present.push_back(box);
  }
  const std::optional<Window> window = fit_window(view, present, resolution);
  if (!window) return std::nullopt;
  PairWindow out{.window = *window, .widening = {}};
  // The clearance, and the double arithmetic of the map for a vertex at the limit of drawability.
  for (int axis = 0; axis < 3; ++axis) {
    // Scaled before it is squared: rows of huge scenes are below what a square can hold.
    const double ball = half_of(clearance) * window->map.row(axis).stableNorm();
    const double sum = (ball + kMaxDoubleError + kLeastWidening) * (1 + 0x1p-20);
    if (!(sum <= kLargest)) return std::nullopt;
    out.widening[axis] = float_above(sum);
  }
  return out;
}

void look(const Scene& scene, const PairRegions& regions, std::span<const std::uint32_t> triangles,
          const PairWindow& seen_in, unsigned threads, PairScene& out) {
  const Window* const window = &seen_in.window;
  const std::array<float, 3>& widening = seen_in.widening;
  out.window = *window;

  const Vec3 corner(0.5 * window->width, 0.5 * window->height, 0);
  out.limits.resize(scene.objects.size());
  for (std::size_t o = 0; o < scene.objects.size(); ++o) {
    if (regions.objects[o].is_empty()) {
      out.limits[o] = {{1, 1, 1, 0}, {-1, -1, -1, 0}};
      continue;
    }
    Box px = pixel_box(*window, regions.objects[o]);
    px.lo += corner;
    px.hi += corner;
    out.limits[o] = {{float_below(px.lo.x()), float_below(px.lo.y()), float_below(px.lo.z()), 0},
                     {float_above(px.hi.x()), float_above(px.hi.y()), float_above(px.hi.z()), 0}};
  }

  // Where the boxes of the objects already are within the bounds, so is each of their vertices.
  const Box whole = pixel_box(*window, regions.reach);
  const double largest = std::max(whole.lo.cwiseAbs().maxCoeff(), whole.hi.cwiseAbs().maxCoeff());
  const bool all_drawable = largest + corner.maxCoeff() <= kLargest &&
                            pixel_error(*window, regions.reach) <= kMaxDoubleError;
  const std::size_t n = scene.vertices.size();
  out.vertices.resize(n);
  const std::size_t chunks = chunks_for(n, 4096, threads);
  std::atomic<bool> some_undrawable = false;
  for_chunks(n, chunks, [&](std::size_t, std::size_t begin, std::size_t end) {
    if (all_drawable) {
      const Eigen::Matrix3d map = window->map;
      const Vec3 origin = window->origin;
      for (std::size_t v = begin; v < end; ++v) {
        out.vertices[v] = pixel_vertex(map * (scene.vertices[v] - origin) + corner);
      }
      return;
    }
    bool bad = false;
    for (std::size_t v = begin; v < end; ++v) {
      const PixelPoint point = to_pixel(*window, scene.vertices[v]);
      const Vec3 p = point.p + corner;
      const bool drawable = point.error <= kMaxDoubleError && p.cwiseAbs().maxCoeff() <= kLargest;
      bad |= !drawable;
      out.vertices[v] = drawable ? pixel_vertex(p) : PixelVertex{0, 0, 0, 1};
    }
    if (bad) some_undrawable = true;
  });

  out.undrawable.clear();
  out.active.assign(triangles.begin(), triangles.end());
  if (some_undrawable) {
    out.active.clear();
    for (const std::uint32_t t : triangles) {
      const auto& c = scene.triangles[t];
      const bool bad =
          out.vertices[c[0]].w != 0 || out.vertices[c[1]].w != 0 || out.vertices[c[2]].w != 0;
      (bad ? out.undrawable : out.active).push_back(t);
    }
  }
  out.owners = owners(scene);
  out.self.resize(scene.objects.size());
  for (std::size_t o = 0; o < scene.objects.size(); ++o) out.self[o] = scene.objects[o].self;
  out.task = {.vertices = out.vertices,
              .triangles = scene.triangles,
              .owners = out.owners,
              .self = out.self,
              .limits = out.limits,
              .active = out.active,
              .width = window->width,
              .height = window->height,
              .near_px = float_below(window->lo[2]),
              .far_px = float_above(window->hi[2]),
              .widening = {widening[0], widening[1], widening[2], 0}};
}

}  // namespace farcull
