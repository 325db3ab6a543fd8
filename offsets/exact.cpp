#include "offsets/exact.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "embedded/exact_glsl.h"
#include "embedded/slab_glsl.h"
#include "offsets/kernel.h"
#include "offsets/round.h"

namespace farcull {
namespace glsl::exact {
#include "offsets/slab.glsl"

#include "offsets/exact.glsl"
}  // namespace glsl::exact
namespace glsl_worst::exact {
#define float Worst
#include "offsets/slab.glsl"

#include "offsets/exact.glsl"
#undef float
}  // namespace glsl_worst::exact

namespace {

void fatten_exact(const Patch& patch, double radius, const ProxyBounds& bounds, Drawables& out) {
  for (int i = 2; i < std::max(patch.count, 3); ++i) {
    const auto corner = [&patch](int k) -> const Vec3& {
      return patch.corners[std::min(k, patch.count - 1)];
    };
    const std::array<Vec3, 3> t = {corner(0), corner(i - 1), corner(i)};
    out.proxies.push_back({proxy_rectangle(t, radius, bounds), exact_of(t[0], t[1], t[2], radius)});
  }
}

}  // namespace

Solid exact_of(const Vec3& a, const Vec3& b, const Vec3& c, double radius) {
  const std::array<Vec3, 3> corners = {a, b, c};
  const Vec3 lo = a.cwiseMin(b).cwiseMin(c), hi = a.cwiseMax(b).cwiseMax(c);
  const Eigen::Vector3f centre = (0.5 * lo + 0.5 * hi).cast<float>();
  Solid solid{};
  double displaced = 0;
  for (int i = 0; i < 3; ++i) {
    const Vec3 d = corners[i] - centre.cast<double>();
    const Eigen::Vector3f rounded = d.cast<float>();
    // The subtraction rounds too: 2^-53 of |d| per axis, within the second term.
    displaced = std::max(displaced, (d - rounded.cast<double>()).norm() + 0x1p-50 * d.norm());
    solid[1 + i] = {rounded[0], rounded[1], rounded[2], 0};
  }
  solid[0] = {centre[0], centre[1], centre[2], outward_lower(lo[2], radius)};
  solid[1][3] = round_up((radius + displaced) * (1 + 0x1p-48));
  solid[2][3] = outward_upper(hi[2], radius);
  return solid;
}

Fattener exact_fattener() {
  const SolidProgram solid{"exact", std::string(embedded::slab_glsl) + embedded::exact_glsl,
                           kernel_interval<glsl::exact::solid_interval>,
                           kernel_interval_worst<glsl_worst::exact::solid_interval>};
  return {"exact", DepthMode::fragment, solid, fatten_exact};
}

}  // namespace farcull
