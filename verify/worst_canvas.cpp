// A pixel counts as covered only if it is covered for all roundings that the device assumptions
// allow. Its depths are the worst that these roundings give.
#include "verify/worst_canvas.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <utility>

#include "core/base/glsl_worst.h"

namespace farcull {
namespace {

// Relative error of a float32 operation in any rounding mode (GLSL 4.50, 4.7.1).
constexpr double kUlp = 0x1p-23;

struct Range {
  double lo, hi;
};

// Returns how far a window coordinate can be from the exact coordinate. A coordinate is multiplied
// by 2/viewport, divided by w = 1, multiplied by viewport/2, added to the centre, then snapped.
// Assumption A1 bounds the error over the whole viewport. So every corner may be as far off as a
// corner at the rim, which has the largest intermediate results.
double displacement(int viewport, int subpixel_bits) {
  const double half = 0.5 * viewport;
  double x = half;
  for (const double units : {1.0, 2.5, 1.0}) x += units * kUlp * x;
  x += half;
  x += kUlp * x;
  return (x - viewport) + std::ldexp(1.0, -subpixel_bits);
}

struct Point {
  double x, y;
};

double cross(const Point& a, const Point& b, const Point& c) {
  return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
}

// True if c is on the inner side of the edge for every choice of the edge's ends. The product is
// linear in each coordinate, so its least value is at corners of the ranges.
bool surely_inside(const Range (&a)[2], const Range (&b)[2], const Point& c, double orientation) {
  for (int bits = 0; bits < 16; ++bits) {
    const Point from = {bits & 1 ? a[0].hi : a[0].lo, bits & 2 ? a[1].hi : a[1].lo};
    const Point to = {bits & 4 ? b[0].hi : b[0].lo, bits & 8 ? b[1].hi : b[1].lo};
    if (orientation * cross(from, to, c) <= 0) return false;
  }
  return true;
}

// Like surely_inside(), for a rasterizer that compares the products dx (c.y - a.y) and
// dy (c.x - a.x) in floats. Factors and products are off by half a unit in the last place, to the
// worse side. The comparison is exact. Here, doubles are off by only 2^-53 of the products.
bool surely_beside(const float* a, const float* b, const Point& c, double orientation) {
  constexpr double kHalfUnit = 0x1p-24;
  const double dx = double(b[0]) - a[0], dy = double(b[1]) - a[1];
  const double left = dx * (c.y - a[1]), right = dy * (c.x - a[0]);
  const double lost = 3 * kHalfUnit * (std::abs(left) + std::abs(right));
  return orientation * (left - right) > lost;
}

std::uint64_t mixed(std::uint64_t x) {
  x = (x ^ x >> 31) * 0x9e3779b97f4a7c15u;
  x = (x ^ x >> 29) * 0xbf58476d1ce4e5b9u;
  return x ^ x >> 32;
}

// Returns the first and last index of the pixels whose centre is in [lo, hi], in a row of `size`.
std::pair<int, int> pixels(double lo, double hi, int size) {
  return {std::max(0, static_cast<int>(std::ceil(lo + 0.5 * size - 0.5))),
          std::min(size - 1, static_cast<int>(std::floor(hi + 0.5 * size - 0.5)))};
}

/// Calls visit(pixel, centre) for the pixels whose centres lie in the box of the points.
template <std::size_t count, class Visit>
void for_pixels(const Window& window, const Point (&points)[count], const Visit& visit) {
  const auto [left, right] = std::ranges::minmax(points, {}, &Point::x);
  const auto [low, high] = std::ranges::minmax(points, {}, &Point::y);
  const auto [x0, x1] = pixels(left.x, right.x, window.width);
  const auto [y0, y1] = pixels(low.y, high.y, window.height);
  for (int y = y0; y <= y1; ++y) {
    for (int x = x0; x <= x1; ++x) {
      visit(static_cast<std::size_t>(y) * window.width + x,
            Point{x + 0.5 - 0.5 * window.width, y + 0.5 - 0.5 * window.height});
    }
  }
}

}  // namespace

WorstCanvas::WorstCanvas(const SolidProgram& solid, const WorstCanvasOptions& options)
    : solid_(solid), options_(options) {
  limits_.subpixel_bits = options.subpixel_bits;
  limits_.depth_bits = options.depth_bits;
  limits_.max_resolution = options.max_resolution;
  limits_.exact_samples = options.exact_samples;
}

void WorstCanvas::begin(const Window& window, const Drawables& drawables) {
  window_ = window;
  drawables_ = &drawables;
}

// Returns the depth buffer's value for a depth if all programs round to nearest. With 24 bits, the
// value is rounded down to a multiple of 2^-24.
float WorstCanvas::held(float z) const {
  const float mapped = std::min(std::max(0.5f + z * depth_scale(window_), 0.25f), 0.75f);
  if (options_.depth_bits == 32) return mapped;
  return static_cast<float>(std::floor(mapped * 0x1p24) * 0x1p-24);
}

// Returns the depth-buffer value of depth z in the program of `verb` (store or ask). Each rounding
// goes to the lower or the upper end of the range that glsl_worst computes.
float WorstCanvas::held(float z, Verb verb) const {
  if (options_.exact_samples) return held(z);
  const bool ask = verb == Verb::ask;
  std::uint64_t down = ask ? ~std::uint64_t{0} : 0;  // one bit for each rounding: 1 rounds down
  if (options_.rounding_seed != 0)
    down =
        mixed(mixed(options_.rounding_seed * 2 + (ask ? 1 : 0)) ^ std::bit_cast<std::uint32_t>(z));
  const auto goes_down = [&] { return (std::exchange(down, down >> 1) & 1) != 0; };
  using glsl_worst::Worst;
  const auto end = [&](const Worst& range) { return goes_down() ? range.lo() : range.hi(); };
  float depth = std::clamp(end(Worst(0.5f) + Worst(z) * Worst(depth_scale(window_))), 0.25f, 0.75f);
  if (ask) depth = end(Worst(depth) + Worst(options_.asked_behind));
  if (options_.depth_bits == 32) return depth;
  constexpr double kMost = 0x1p24 - 1;  // steps may be rounded up or down (OpenGL 4.6, 2.3.5.2)
  const double steps = depth * kMost;   // exact: at most 48 bits
  return static_cast<float>((goes_down() ? std::floor(steps) : std::ceil(steps)) * 0x1p-24);
}

// True if the pixel centre is inside the proxy for all roundings that the assumptions allow.
bool WorstCanvas::covers(const Proxy& proxy, double orientation, double cx, double cy) const {
  const Point c = {cx, cy};
  for (int i = 0; i < 4; ++i) {
    const float* const a = &proxy.corners[2 * i];
    const float* const b = &proxy.corners[2 * ((i + 1) % 4)];
    if (options_.exact_samples) {
      if (!surely_beside(a, b, c, orientation)) return false;
      continue;
    }
    Range from[2], to[2];
    for (int k = 0; k < 2; ++k) {
      const int size = k == 0 ? window_.width : window_.height;
      const double d = displacement(viewport_side(size), options_.subpixel_bits);
      from[k] = {a[k] - d, a[k] + d};
      to[k] = {b[k] - d, b[k] + d};
    }
    if (!surely_inside(from, to, c, orientation)) return false;
  }
  return true;
}

// Calls visit(pixel, px, held) for each fragment of an element. px is the entry or exit depth. held
// is the value that the depth buffer stores for px, or compares with its own value.
void WorstCanvas::rasterize(std::uint32_t element, Verb verb, const auto& visit) const {
  if (element == kEverywhere) {
    const std::size_t pixels = static_cast<std::size_t>(window_.width) * window_.height;
    for (std::size_t pixel = 0; pixel < pixels; ++pixel) visit(pixel, 0, 0);
    return;
  }
  if (drawables_->mode == DepthMode::fixed) {
    const std::array<float, 12>& t = drawables_->triangles[element];
    const Point corners[] = {{t[0], t[1]}, {t[4], t[5]}, {t[8], t[9]}};
    const double area = cross(corners[0], corners[1], corners[2]);
    if (area == 0) return;
    for_pixels(window_, corners, [&](std::size_t pixel, const Point& p) {
      const double wa = cross(corners[1], corners[2], p) / area;
      const double wb = cross(corners[2], corners[0], p) / area;
      const double wc = cross(corners[0], corners[1], p) / area;
      if (wa <= 0 || wb <= 0 || wc <= 0) return;
      const float z = static_cast<float>(wa * t[2] + wb * t[6] + wc * t[10]);
      visit(pixel, z, held(z));
    });
    return;
  }
  const Proxy& proxy = drawables_->proxies[element];
  Point nominal[4];
  for (int i = 0; i < 4; ++i) nominal[i] = {proxy.corners[2 * i], proxy.corners[2 * i + 1]};
  const double orientation = cross(nominal[0], nominal[1], nominal[2]) > 0 ? 1 : -1;
  for_pixels(window_, nominal, [&](std::size_t pixel, const Point& c) {
    if (!covers(proxy, orientation, c.x, c.y)) return;
    float entry, exit;
    if (!solid_.interval_worst(static_cast<float>(c.x), static_cast<float>(c.y), proxy.solid, entry,
                               exit))
      return;
    const float z = verb == Verb::store ? entry : exit;
    visit(pixel, z, held(z, verb));
  });
}

std::vector<std::uint8_t> WorstCanvas::run(const Pass& pass) {
  constexpr float kClear = 1;
  std::vector<float> depth(static_cast<std::size_t>(window_.width) * window_.height, kClear);
  std::vector<std::uint8_t> seen(pass.slots);
  for (const Step& step : pass.steps) {
    for (std::uint32_t i = step.first; i < step.first + step.count; ++i) {
      const Draw& draw = pass.draws[i];
      if (step.verb == Verb::ask && seen[draw.slot]) continue;
      rasterize(draw.element, step.verb, [&](std::size_t pixel, float, float d) {
        if (step.verb == Verb::store) {
          depth[pixel] = std::min(depth[pixel], d);
        } else if (d > depth[pixel] || (pass.touching && d == depth[pixel])) {
          seen[draw.slot] = 1;
        }
      });
    }
  }
  return seen;
}

std::vector<float> WorstCanvas::depths(Verb verb, const std::vector<Draw>& draws) {
  const bool store = verb == Verb::store;
  std::vector<float> out(static_cast<std::size_t>(window_.width) * window_.height,
                         store ? 1.0f : 0.0f);
  for (const Draw& draw : draws) {
    rasterize(draw.element, verb, [&](std::size_t pixel, float, float d) {
      out[pixel] = store ? std::min(out[pixel], d) : std::max(out[pixel], d);
    });
  }
  return out;
}

std::vector<float> WorstCanvas::samples(Verb verb, const std::vector<Draw>& draws) {
  if (drawables_->mode == DepthMode::fixed)
    throw std::logic_error("WorstCanvas::samples: proxies only");
  std::vector<float> out(static_cast<std::size_t>(window_.width) * window_.height,
                         std::numeric_limits<float>::quiet_NaN());
  for (const Draw& draw : draws) {
    rasterize(draw.element, verb, [&](std::size_t pixel, float z, float) {
      float& kept = out[pixel];
      if (std::isnan(kept) || (verb == Verb::store ? z < kept : z > kept)) kept = z;
    });
  }
  return out;
}

}  // namespace farcull
