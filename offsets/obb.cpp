// The kernel of obb.glsl as scalar C++ and on the worst device, and the primitives that carry it.
#include "offsets/obb.h"

#include <algorithm>
#include <string>

#include "embedded/obb_glsl.h"
#include "embedded/slab_glsl.h"
#include "offsets/fit.h"
#include "offsets/kernel.h"
#include "offsets/lanes.h"

namespace farcull {
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

// The twelve triangles of the closed box. Corners are rounded to nearest: this path promises
// nothing.
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

}  // namespace farcull
