// The kernel of minkowski.glsl as scalar C++ and on the worst device, and the solids it reads.
#include "offsets/minkowski.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "embedded/minkowski_glsl.h"
#include "embedded/slab_glsl.h"
#include "offsets/fit.h"
#include "offsets/kernel.h"
#include "offsets/lanes.h"

namespace farcull {
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

// The normals that the kernel is free to choose come out better on the worst device now and then.
// This machine's floats are among those that GLSL allows, so they bound it too.
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
