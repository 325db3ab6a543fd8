// A laboratory for canvases: windows and primitives given directly in pixel space, without a scene
// or a view.
#pragma once

#include <cmath>
#include <cstdint>
#include <functional>
#include <initializer_list>
#include <memory>
#include <random>
#include <span>
#include <vector>

#include "core/canvas/fatten.h"
#include "core/view/budget.h"
#include "core/view/view.h"

namespace farcull::lab {

/// A window of side x side px whose pixel space is the world itself; depths within +-depth px.
inline Window window(int side, double depth = 256) {
  Window w{.view = parse_view("z"),
           .origin = Vec3::Zero(),
           .map = Eigen::Matrix3d::Identity(),
           .pixel_size = 1,
           .width = side,
           .height = side,
           .lo = {},
           .hi = {}};
  w.hi = Vec3(0.5 * side, 0.5 * side, depth);
  w.lo = -w.hi;
  return w;
}

inline Patch patch(std::initializer_list<Vec3> points) {
  Patch p;
  for (const Vec3& q : points) p.corners[p.count++] = q;
  return p;
}

/// An item per patch.
inline Drawables fattened(const Window& w, const Fattener& fattener, double radius,
                          std::span<const Patch> patches) {
  Drawables out;
  out.mode = fattener.mode;
  for (const Patch& p : patches) {
    fattener.fatten(p, radius, proxy_bounds(w), out);
    out.first.push_back(static_cast<std::uint32_t>(out.elements()));
  }
  return out;
}

/// Draws of all elements of an item for a slot.
inline void add(std::vector<Draw>& draws, const Drawables& drawables, std::uint32_t item,
                std::uint32_t slot) {
  for (std::uint32_t e = drawables.first[item]; e < drawables.first[item + 1]; ++e)
    draws.push_back({e, slot});
}

inline double budget_radius(const Canvas& canvas, const Window& w) {
  return budget_for(canvas.limits(), viewport_side(w.width)).radius();
}

using MakeCanvas = std::function<std::unique_ptr<Canvas>(const Fattener&)>;

/// Uniform in [0, 1), the same on every platform.
class Random {
 public:
  explicit Random(std::uint64_t seed) : engine_(seed) {}
  double unit() { return static_cast<double>(engine_() >> 11) * 0x1p-53; }
  double between(double lo, double hi) { return lo + (hi - lo) * unit(); }
  int below(int n) { return static_cast<int>(engine_() % static_cast<std::uint64_t>(n)); }
  double sign() { return engine_() & 1 ? 1 : -1; }
  /// A multiple of `step` in [lo, hi].
  double grid(double lo, double hi, double step) {
    return std::floor(between(lo, hi) / step) * step;
  }

 private:
  std::mt19937_64 engine_;
};

}  // namespace farcull::lab
