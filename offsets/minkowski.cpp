// The kernel of minkowski.glsl as scalar C++ and on the worst device, and the solids it reads.
#include "offsets/minkowski.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "embedded/minkowski_glsl.h"
#include "embedded/slab_glsl.h"
#include "offsets/kernel.h"
#include "offsets/round.h"

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

Solid minkowski_solid(const Vec3& a, const Vec3& b, const Vec3& c, double radius) {
  const std::array<Vec3, 3> corners = {a, b, c};
  const Vec3 lo = a.cwiseMin(b).cwiseMin(c), hi = a.cwiseMax(b).cwiseMax(c);
  const Vec3 middle = 0.5 * lo + 0.5 * hi;
  Solid solid{};
  for (int k = 0; k < 3; ++k) solid[0][k] = nearest(middle[k]);
  solid[0][3] = outward_lower(lo[2], radius);
  double displaced = 0;
  for (int i = 0; i < 3; ++i) {
    Vec3 d, lost;
    for (int k = 0; k < 3; ++k) {
      d[k] = corners[i][k] - double(solid[0][k]);
      solid[1 + i][k] = nearest(d[k]);
      lost[k] = d[k] - double(solid[1 + i][k]);
    }
    // The subtraction rounds too: 2^-53 of |d| per axis, within the second term. Components below
    // 2^-511 square to less than a normal double: the third.
    displaced = std::max(displaced, lost.norm() + 0x1p-50 * d.norm() + 0x1p-500);
  }
  solid[1][3] = round_up((radius + displaced) * (1 + 0x1p-48));
  solid[2][3] = outward_upper(hi[2], radius);
  return solid;
}

Fattener minkowski_fattener() {
  const SolidProgram solid{"exact", std::string(embedded::slab_glsl) + embedded::minkowski_glsl,
                           kernel_interval<glsl::minkowski::solid_interval>, interval_worst};
  return {"exact", DepthMode::fragment, solid, fatten_minkowski};
}

}  // namespace farcull
