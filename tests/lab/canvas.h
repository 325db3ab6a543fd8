// A laboratory for canvases: windows and primitives given directly in pixel space, without a scene
// or a view.
#pragma once

#include "core/canvas/fatten.h"
#include "core/view/budget.h"
#include "tests/lab/test.h"

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

inline void add(std::vector<Draw>& draws, const Drawables& drawables, std::uint32_t item,
                std::uint32_t slot) {
  for (std::uint32_t e = drawables.first[item]; e < drawables.first[item + 1]; ++e)
    draws.push_back({e, slot});
}

/// Whether element 1 is seen behind element 0 in some pixel.
inline bool is_seen(Canvas& canvas, const Window& w, const Drawables& drawables, bool touching) {
  Pass pass;
  pass.slots = 1;
  pass.touching = touching;
  pass.draws = {{0, 0}, {1, 0}};
  pass.steps = {{Verb::store, 0, 1}, {Verb::ask, 1, 1}};
  canvas.begin(w, drawables);
  return canvas.run(pass)[0] != 0;
}

inline double budget_radius(const Canvas& canvas, const Window& w) {
  return budget_for(canvas.limits(), viewport_side(w.width)).radius();
}

/// What the canvas stores and asks at each pixel is its sample under the depth map, rounded to
/// these bits, and asked so much behind.
inline void expect_held_under_map(Canvas& canvas, const Fattener& fattener, int depth_bits,
                                  double behind) {
  const Window w = window(64, 100);
  const std::vector<Patch> patches = {patch({{-20, -20, -60}, {20, -10, 30}, {0, 25, 80}}),
                                      patch({{-5, 0, 2}, {28, 3, 9}, {10, 30, -99}})};
  const Drawables drawables = fattened(w, fattener, 0.72, patches);
  canvas.begin(w, drawables);
  const std::vector<Draw> draws = {{0, 0}, {1, 0}};
  for (const Verb verb : {Verb::store, Verb::ask}) {
    const std::vector<float> px = canvas.samples(verb, draws), held = canvas.depths(verb, draws);
    int covered = 0;
    for (std::size_t i = 0; i < px.size(); ++i) {
      if (std::isnan(px[i])) {
        EXPECT_EQ(held[i], verb == Verb::store ? 1 : 0);
        continue;
      }
      ++covered;
      const double more = verb == Verb::ask ? behind : 0;
      const double map = 0.5 + static_cast<double>(px[i]) * depth_scale(w) + more;
      EXPECT_LE(std::abs(held[i] - map) * 0x1p24, depth_rounding(depth_bits) + (more > 0 ? 1 : 0));
    }
    EXPECT_GT(covered, 500);
  }
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
  double grid(double lo, double hi, double step) {
    return std::floor(between(lo, hi) / step) * step;
  }

 private:
  std::mt19937_64 engine_;
};

}  // namespace farcull::lab

// A canvas without errors of its own, for tests of what culling does with the answers: coverage is
// decided in double at the pixel centre, closed edges; depth is the solid's interval, or that of
// the triangle's plane (fixed depth), under the depth map of core/canvas/canvas.h, in float. Its
// faults, one at a time, are for tests that must fail.

namespace farcull {

enum class CanvasFault {
  none,
  greater,            // asks with GREATER instead of GEQUAL
  swapped,            // asks with LEQUAL, where something is stored
  drops_first_store,  // of every pass
  nothing_everywhere  // kEverywhere draws nothing
};

class IdealCanvas : public Canvas {
 public:
  explicit IdealCanvas(const SolidProgram& solid, CanvasFault fault = CanvasFault::none)
      : solid_(solid), fault_(fault) {
    limits_.subpixel_bits = 8;
    limits_.depth_bits = 32;
    limits_.max_resolution = 4096;
  }

  const RasterLimits& limits() const override { return limits_; }

  void begin(const Window& window, const Drawables& drawables) override {
    width_ = window.width;
    height_ = window.height;
    const float scale = depth_scale(window);
    fragments_.assign(drawables.elements(), {});
    for (std::size_t e = 0; e < drawables.elements(); ++e) {
      fragments_[e] = drawables.mode == DepthMode::fragment
                          ? rasterize(drawables.proxies[e], scale)
                          : rasterize(drawables.triangles[e], scale);
    }
  }

  std::vector<std::uint8_t> run(const Pass& pass) override {
    std::vector<std::uint8_t> seen(pass.slots);
    std::vector<float> stored(static_cast<std::size_t>(width_) * height_, 1.0f);
    bool drop = fault_ == CanvasFault::drops_first_store;
    for (const Step& step : pass.steps) {
      if (step.verb == Verb::store && std::exchange(drop, false)) continue;
      for (std::uint32_t d = step.first; d < step.first + step.count; ++d) {
        const Draw& draw = pass.draws.at(d);
        if (step.verb == Verb::store)
          store(draw, stored);
        else
          seen.at(draw.slot) |= sees(draw, stored, pass.touching);
      }
    }
    return seen;
  }

 private:
  struct Fragment {
    std::size_t pixel;
    float entry, exit;
  };

  // The pixels of a side whose centres may lie in [lo, hi].
  static int first(float lo, int side) {
    return std::max(0, static_cast<int>(std::floor(lo)) + side / 2);
  }
  static int last(float hi, int side) {
    return std::min(side - 1, static_cast<int>(std::ceil(hi)) + side / 2);
  }

  std::vector<Fragment> rasterize(const Proxy& proxy, float scale) const {
    const auto& c = proxy.corners;
    const auto [x0, x1] = std::minmax({c[0], c[2], c[4], c[6]});
    const auto [y0, y1] = std::minmax({c[1], c[3], c[5], c[7]});
    const auto map = [scale](float z) {
      const float product = z * scale;
      return std::clamp(0.5f + product, 0.25f, 0.75f);
    };
    std::vector<Fragment> out;
    for (int j = first(y0, height_); j <= last(y1, height_); ++j) {
      for (int i = first(x0, width_); i <= last(x1, width_); ++i) {
        const double cx = i - width_ / 2 + 0.5, cy = j - height_ / 2 + 0.5;
        float entry, exit;
        if (!covers(c, cx, cy) || !solid_.interval(static_cast<float>(cx), static_cast<float>(cy),
                                                   proxy.solid, entry, exit))
          continue;
        out.push_back({static_cast<std::size_t>(j) * width_ + i, map(entry), map(exit)});
      }
    }
    return out;
  }

  // Of a triangle at fixed depth; seen from its edge it covers nothing.
  std::vector<Fragment> rasterize(const std::array<float, 12>& t, float scale) const {
    const auto cross = [](double ax, double ay, double bx, double by, double px, double py) {
      return (bx - ax) * (py - ay) - (by - ay) * (px - ax);
    };
    const double area = cross(t[0], t[1], t[4], t[5], t[8], t[9]);
    std::vector<Fragment> out;
    if (area == 0) return out;
    const auto [x0, x1] = std::minmax({t[0], t[4], t[8]});
    const auto [y0, y1] = std::minmax({t[1], t[5], t[9]});
    for (int j = first(y0, height_); j <= last(y1, height_); ++j) {
      for (int i = first(x0, width_); i <= last(x1, width_); ++i) {
        const double x = i - width_ / 2 + 0.5, y = j - height_ / 2 + 0.5;
        const double a = cross(t[4], t[5], t[8], t[9], x, y) / area;
        const double b = cross(t[8], t[9], t[0], t[1], x, y) / area;
        const double c = cross(t[0], t[1], t[4], t[5], x, y) / area;
        if (a < 0 || b < 0 || c < 0) continue;
        const auto z = static_cast<float>(a * t[2] + b * t[6] + c * t[10]);
        const float mapped = 0.5f + z * scale;
        out.push_back({static_cast<std::size_t>(j) * width_ + i, mapped, mapped});
      }
    }
    return out;
  }

  static bool covers(const std::array<float, 8>& c, double x, double y) {
    bool left = true, right = true;
    for (int i = 0; i < 4; ++i) {
      const int j = (i + 1) % 4;
      const double side = (double(c[2 * j]) - c[2 * i]) * (y - c[2 * i + 1]) -
                          (double(c[2 * j + 1]) - c[2 * i + 1]) * (x - c[2 * i]);
      left = left && side >= 0;
      right = right && side <= 0;
    }
    return left || right;
  }

  void store(const Draw& draw, std::vector<float>& stored) const {
    if (draw.element == kEverywhere) {
      if (fault_ != CanvasFault::nothing_everywhere) std::ranges::fill(stored, 0.0f);
      return;
    }
    for (const Fragment& f : fragments_.at(draw.element))
      stored[f.pixel] = std::min(stored[f.pixel], f.entry);
  }

  bool sees(const Draw& draw, const std::vector<float>& stored, bool touching) const {
    if (draw.element == kEverywhere) return fault_ != CanvasFault::nothing_everywhere;
    const auto& fragments = fragments_.at(draw.element);
    return std::ranges::any_of(fragments, [&](const Fragment& f) {
      const float behind = stored[f.pixel];
      if (fault_ == CanvasFault::swapped) return behind < 1 && f.exit <= behind;
      if (fault_ == CanvasFault::greater || !touching) return f.exit > behind;
      return f.exit >= behind;
    });
  }

  SolidProgram solid_;
  CanvasFault fault_;
  RasterLimits limits_;
  int width_ = 0, height_ = 0;
  std::vector<std::vector<Fragment>> fragments_;  // per element
};

}  // namespace farcull
