// The box is fitted in doubles, and its extents are measured and rounded outward. The kernel of
// obb.glsl is compiled as scalar C++ and for the worst device.
#include "offsets/obb.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <string>

#include "embedded/obb_glsl.h"
#include "embedded/slab_glsl.h"
#include "offsets/kernel.h"
#include "offsets/round.h"

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

// Directions of the box: the longest edge, the farthest point's distance from it, and their normal.
// Any directions are sound, since the extents are measured afterwards; these make the box tight.
Eigen::Matrix3d directions(std::span<const Vec3> points) {
  Vec3 along = Vec3::UnitX();
  double longest = 1e-100;  // shorter edges square to nothing
  std::size_t base = 0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Vec3 edge = points[(i + 1) % points.size()] - points[i];
    const double length = edge.norm();
    if (length > longest) {
      longest = length;
      along = edge / length;
      base = i;
    }
  }
  Vec3 across = Vec3::Zero();
  double farthest = 1e-100;
  for (const Vec3& p : points) {
    const Vec3 d = p - points[base];
    const Vec3 off = d - along * along.dot(d);
    const double distance = off.norm();
    if (distance > farthest) {
      farthest = distance;
      across = off / distance;
    }
  }
  const Vec3 residue = across - along * along.dot(across);
  if (farthest < 0x1p-40 * longest || residue.norm() < 0.5) {
    int smallest = 0;
    along.cwiseAbs().minCoeff(&smallest);
    across = along.cross(Vec3::Unit(smallest));
  } else {
    across = residue;
  }
  across.normalize();
  Eigen::Matrix3d rows;
  rows << along.transpose(), across.transpose(), along.cross(across).transpose();
  return rows;
}

// The box as three float slabs about a float centre, see obb.glsl.
struct Slabs {
  Eigen::Vector3f centre;
  Eigen::Matrix3f normals;  // rows
  Eigen::Vector3d half;     // >= |normal . (p - centre)| + radius |normal| for every point, before
                            // rounding to float
};

Slabs slabs_of(std::span<const Vec3> points, double radius) {
  const Eigen::Matrix3d rows = directions(points);
  Slabs out;
  Vec3 middle = Vec3::Zero();
  for (int i = 0; i < 3; ++i) {
    double lo = HUGE_VAL, hi = -HUGE_VAL;
    for (const Vec3& p : points) {
      const double s = rows.row(i) * p;
      lo = std::min(lo, s);
      hi = std::max(hi, s);
    }
    middle += rows.row(i).transpose() * (0.5 * lo + 0.5 * hi);
  }
  for (int i = 0; i < 3; ++i) {
    out.centre[i] = nearest(middle[i]);
    for (int k = 0; k < 3; ++k) out.normals(i, k) = nearest(rows(i, k));
  }
  for (int i = 0; i < 3; ++i) {
    const Vec3 normal = out.normals.row(i).cast<double>();
    double reach = 0, size = 0;
    for (const Vec3& p : points) {
      const Vec3 d = p - out.centre.cast<double>();
      reach = std::max(reach, std::abs(normal.dot(d)));
      size = std::max(size, normal.cwiseAbs().dot(d.cwiseAbs()));
    }
    // A difference, a product and two sums: under 5 * 2^-53 of `size`; the same for |normal|. 2^-48
    // is beyond both.
    out.half[i] = reach + 0x1p-48 * size + radius * normal.norm() * (1 + 0x1p-48);
  }
  return out;
}

void fatten_proxy(const Patch& patch, double radius, const ProxyBounds& bounds, Drawables& out) {
  out.proxies.push_back(
      {proxy_rectangle(patch.points(), radius, bounds), obb_of(patch.points(), radius)});
}

// The twelve triangles of the closed box. Corners are rounded to nearest: this path promises
// nothing.
void fatten_surface(const Patch& patch, double radius, const ProxyBounds&, Drawables& out) {
  const Slabs slabs = slabs_of(patch.points(), radius);
  const auto corner = [&slabs](int bits) {
    Eigen::Vector3f p = slabs.centre;
    for (int i = 0; i < 3; ++i) {
      const float h = static_cast<float>(slabs.half[i]);
      p += slabs.normals.row(i).transpose() * ((bits >> i & 1) ? h : -h);
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
        const Eigen::Vector3f p = corner(pick[k]);
        std::copy_n(p.data(), 3, &t[4 * k]);
      }
      out.triangles.push_back(t);
    }
  }
}

}  // namespace

Solid obb_of(std::span<const Vec3> points, double radius) {
  const Slabs slabs = slabs_of(points, radius);
  double lo = HUGE_VAL, hi = -HUGE_VAL;
  for (const Vec3& p : points) {
    lo = std::min(lo, p[2]);
    hi = std::max(hi, p[2]);
  }
  Solid solid{};
  solid[0] = {slabs.centre[0], slabs.centre[1], slabs.centre[2], outward_lower(lo, radius)};
  for (int i = 0; i < 3; ++i) {
    solid[1 + i] = {slabs.normals(i, 0), slabs.normals(i, 1), slabs.normals(i, 2),
                    round_up(slabs.half[i])};
  }
  solid[4][0] = outward_upper(hi, radius);
  return solid;
}

Fattener obb_fattener() {
  const SolidProgram solid{"obb", std::string(embedded::slab_glsl) + embedded::obb_glsl,
                           kernel_interval<glsl::obb::solid_interval>,
                           kernel_interval_worst<glsl_worst::obb::solid_interval>};
  return {"obb", DepthMode::fragment, solid, fatten_proxy};
}

Fattener obb_surface_fattener() { return {"obb-surface", DepthMode::fixed, {}, fatten_surface}; }

}  // namespace farcull
