// Compiles fit.inl for scalars. Then defines each offset: its kernel with float, its kernel with
// the number type Worst, and its fatteners.
#include "offsets/offsets.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "core/base/glsl_shim.h"
#include "embedded/minkowski_glsl.h"
#include "embedded/obb_glsl.h"
#include "embedded/slab_glsl.h"
#include "offsets/kernel.h"
#include "offsets/lanes.h"
#include "offsets/rounding.h"

namespace farcull {

// ---- fit.inl on scalars ----

namespace fit {

struct dvec3 {
  double x, y, z;
};
double min(double a, double b) { return b < a ? b : a; }
double max(double a, double b) { return a < b ? b : a; }
double abs(double a) { return std::fabs(a); }
double sqrt(double a) { return std::sqrt(a); }

#define FAR_NEAREST(x) static_cast<double>(nearest(x))
#include "offsets/fit.inl"
#undef FAR_NEAREST

}  // namespace fit

namespace {

constexpr std::size_t kMostPoints = std::tuple_size_v<decltype(Patch::corners)>;

// The points as an array for fit.inl.
struct Points {
  explicit Points(std::span<const Vec3> from) : count(static_cast<int>(from.size())) {
    if (from.empty() || from.size() > kMostPoints) throw std::logic_error("fit: too many points");
    for (int i = 0; i < count; ++i) p[i] = {from[i][0], from[i][1], from[i][2]};
  }
  int count;
  fit::dvec3 p[kMostPoints];
};

Solid solid_of(const double (&numbers)[20]) {
  Solid solid;
  for (int i = 0; i < 20; ++i) solid[i / 4][i % 4] = nearest(numbers[i]);
  return solid;
}

}  // namespace

std::array<float, 8> proxy_rectangle(std::span<const Vec3> points, double radius,
                                     const ProxyBounds& bounds) {
  const Points given(points);
  double corners[8];
  fit::fit_rectangle(given.p, given.count, radius, bounds.x, bounds.y, corners);
  std::array<float, 8> out;
  for (int i = 0; i < 8; ++i) out[i] = nearest(corners[i]);
  return out;
}

Solid obb_of(std::span<const Vec3> points, double radius) {
  const Points given(points);
  double numbers[20];
  fit::fit_box(given.p, given.count, radius, numbers);
  return solid_of(numbers);
}

Solid minkowski_solid(const Vec3& a, const Vec3& b, const Vec3& c, double radius) {
  const Points given(std::array{a, b, c});
  double numbers[20];
  fit::fit_minkowski(given.p, radius, numbers);
  return solid_of(numbers);
}

// ---- the box ----

namespace glsl::obb {
#include "offsets/slab.glsl"

#include "offsets/obb.glsl"
}  // namespace glsl::obb
namespace glsl_worst::obb {
#define float Worst
#include "offsets/slab.glsl"

#include "offsets/obb.glsl"
#undef float
}  // namespace glsl_worst::obb

namespace {

void fatten_proxy(const Patch& patch, double radius, const ProxyBounds& bounds, Drawables& out) {
  out.proxies.push_back(
      {proxy_rectangle(patch.points(), radius, bounds), obb_of(patch.points(), radius)});
}

// Draws the surface of the box as twelve triangles. The corners are rounded to nearest, so this
// path gives no guarantee.
void fatten_surface(const Patch& patch, double radius, const ProxyBounds&, Drawables& out) {
  const Solid box = obb_of(patch.points(), radius);
  const auto corner = [&box](int bits) {
    std::array<float, 3> p = {box[0][0], box[0][1], box[0][2]};
    for (int i = 0; i < 3; ++i) {
      const float h = (bits >> i & 1) ? box[1 + i][3] : -box[1 + i][3];
      for (int k = 0; k < 3; ++k) p[k] += box[1 + i][k] * h;
    }
    return p;
  };
  constexpr int kFaces[6][4] = {{0, 2, 6, 4}, {1, 3, 7, 5}, {0, 1, 5, 4},
                                {2, 3, 7, 6}, {0, 1, 3, 2}, {4, 5, 7, 6}};
  for (const auto& face : kFaces) {
    for (int half = 0; half < 2; ++half) {
      std::array<float, 12> t{};
      const int pick[3] = {face[0], face[1 + half], face[2 + half]};
      for (int k = 0; k < 3; ++k) {
        const std::array<float, 3> p = corner(pick[k]);
        std::copy_n(p.data(), 3, &t[4 * k]);
      }
      out.triangles.push_back(t);
    }
  }
}

}  // namespace

Fattener obb_fattener() {
  const SolidProgram solid{"obb",
                           std::string(embedded::slab_glsl) + embedded::obb_glsl,
                           kernel_interval<glsl::obb::solid_interval>,
                           kernel_interval_worst<glsl_worst::obb::solid_interval>,
                           draw_obb_native,
                           follow_obb_native};
  return {"obb", DepthMode::fragment, solid, fatten_proxy, fatten_obb_inside};
}

Fattener obb_surface_fattener() { return {"obb-surface", DepthMode::fixed, {}, fatten_surface}; }

// ---- the exact offset ----

namespace glsl::minkowski {
#include "offsets/slab.glsl"

#include "offsets/minkowski.glsl"
}  // namespace glsl::minkowski
namespace glsl_worst::minkowski {
#define float Worst
#include "offsets/slab.glsl"

#include "offsets/minkowski.glsl"
#undef float
}  // namespace glsl_worst::minkowski

namespace {

void fatten_minkowski(const Patch& patch, double radius, const ProxyBounds& bounds,
                      Drawables& out) {
  for (int i = 2; i < std::max(patch.count, 3); ++i) {
    const auto corner = [&patch](int k) -> const Vec3& {
      return patch.corners[std::min(k, patch.count - 1)];
    };
    const std::array<Vec3, 3> t = {corner(0), corner(i - 1), corner(i)};
    out.proxies.push_back(
        {proxy_rectangle(t, radius, bounds), minkowski_solid(t[0], t[1], t[2], radius)});
  }
}

// Computes the interval with float and with the number type Worst, and returns the intersection.
// GLSL permits the rounding of both. Worst alone may give a wider interval, since Worst may choose
// other normals.
bool interval_worst(float cx, float cy, const Solid& s, float& entry, float& exit) {
  float first = 0, last = 0;
  if (!kernel_interval<glsl::minkowski::solid_interval>(cx, cy, s, first, last) ||
      !kernel_interval_worst<glsl_worst::minkowski::solid_interval>(cx, cy, s, entry, exit)) {
    return false;
  }
  entry = std::max(entry, first);
  exit = std::min(exit, last);
  return entry <= exit;
}

}  // namespace

Fattener minkowski_fattener() {
  const SolidProgram solid{"exact",
                           std::string(embedded::slab_glsl) + embedded::minkowski_glsl,
                           kernel_interval<glsl::minkowski::solid_interval>,
                           interval_worst,
                           draw_minkowski_native,
                           follow_minkowski_native};
  return {"exact", DepthMode::fragment, solid, fatten_minkowski, fatten_minkowski_inside};
}

}  // namespace farcull
