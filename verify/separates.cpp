// Translations after which two closed objects are apart.
#include "verify/separates.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <vector>

#include "core/base/floating_point.h"
#include "verify/within.h"

namespace farcull {
namespace {

using separation::kU;

constexpr double kInf = std::numeric_limits<double>::infinity();

/// Whether all corners of a, moved, lie on one side of a plane across the direction, and all of b
/// on the other. A corner that is moved and projected has 6 roundings, relative to the magnitude.
/// Far from the origin, corners are taken relative to a corner of the box of both: along an axis on
/// which no coordinate is more than twice another, their differences are exact (Sterbenz,
/// Floating-Point Computation, 1974).
bool plane_separates(const ClosedObject& a, const ClosedObject& b, const Vec3& t) {
  Vec3 origin = Vec3::Zero();
  double magnitude = t.cwiseAbs().maxCoeff();
  for (int k = 0; k < 3; ++k) {
    const double lo = std::min(a.box().lo[k], b.box().lo[k]);
    const double hi = std::max(a.box().hi[k], b.box().hi[k]);
    if (lo > 0 && hi <= 2 * lo) origin[k] = lo;
    if (hi < 0 && lo >= 2 * hi) origin[k] = hi;
    magnitude = std::max({magnitude, std::abs(lo - origin[k]), std::abs(hi - origin[k])});
  }
  magnitude += t.cwiseAbs().maxCoeff();
  double most = -kInf, least = kInf;
  for (const Vec3& p : a.corners()) most = std::max(most, t.dot(p - origin + t));
  for (const Vec3& p : b.corners()) least = std::min(least, t.dot(p - origin));
  return least - most > 16 * kU * t.cwiseAbs().sum() * magnitude + 0x1p-1000;
}

/// Whether the surfaces are apart by more than `margin`, if a is moved.
bool surfaces_apart(const ClosedObject& a, const ClosedObject& b, const Vec3& t, double margin) {
  const auto moved = [&](BoundsTree::Bounds box) {
    for (int k = 0; k < 3; ++k) box.lo[k] += t[k], box.hi[k] += t[k];
    return box;
  };
  const auto extent = [](const BoundsTree::Bounds& box) {
    return std::max({box.hi[0] - box.lo[0], box.hi[1] - box.lo[1], box.hi[2] - box.lo[2]});
  };
  const BoundsTree &of_a = a.tree(), &of_b = b.tree();
  std::vector<std::array<std::uint32_t, 2>> stack = {{0, 0}};
  while (!stack.empty()) {
    const auto [i, j] = stack.back();
    stack.pop_back();
    const BoundsTree::Node &m = of_a.nodes[i], &n = of_b.nodes[j];
    if (separation::farther(moved(m.bounds), n.bounds, margin)) continue;
    if (!of_a.is_leaf(i) && (of_b.is_leaf(j) || extent(m.bounds) > extent(n.bounds))) {
      stack.push_back({of_a.left(i), j}), stack.push_back({of_a.right(i), j});
      continue;
    }
    if (!of_b.is_leaf(j)) {
      stack.push_back({i, of_b.left(j)}), stack.push_back({i, of_b.right(j)});
      continue;
    }
    for (std::uint32_t p = 0; p < m.count; ++p) {
      ClosedObject::Corners s = a.triangles()[m.first + p];
      for (Vec3& corner : s) corner += t;
      const BoundsTree::Bounds box = BoundsTree::bounds_of(s);
      for (std::uint32_t q = 0; q < n.count; ++q) {
        const ClosedObject::Corners& other = b.triangles()[n.first + q];
        if (!separation::farther(box, BoundsTree::bounds_of(other), margin) &&
            is_within(s, other, margin))
          return false;
      }
    }
  }
  return true;
}

}  // namespace

// If the surfaces are apart, but the insides have a common point, then a point of one surface is
// inside the other object, and with it the whole connected piece of that surface. So one corner of
// each piece decides. A coordinate that is moved in doubles is off by at most 2^-53 of its
// magnitude. The surfaces are farther apart than two such errors, one of a and one of b, so the
// rounded corner and the true one lie on the same side.
bool separates(const ClosedObject& a, const ClosedObject& b, const Vec3& t) {
  const FloatingPointGuard guard;
  const double magnitude = a.largest() + b.largest() + t.cwiseAbs().maxCoeff();
  if (!(magnitude < 0x1p500)) return false;
  if (plane_separates(a, b, t)) return true;
  const auto all_outside = [](const ClosedObject& inner, const ClosedObject& outer,
                              const Vec3& move) {
    return std::ranges::all_of(inner.pieces(),
                               [&](const Vec3& p) { return outer.has_not(p + move); });
  };
  return surfaces_apart(a, b, t, 16 * kU * magnitude) && all_outside(a, b, t) &&
         all_outside(b, a, -t);
}

}  // namespace farcull
