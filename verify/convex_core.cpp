// A core (convex_core.h) starts as a box around a point, the seed. The triangles are visited in the
// order of their distance from the seed. A plane cuts the core at each triangle that still meets
// the core. The plane is the triangle's own, or it is perpendicular to the shortest segment from
// the seed to the triangle (like Deits and Tedrake, Computing Large Convex Regions of Obstacle-Free
// Space through Semidefinite Programming, 2015, for ellipsoids).
#include "verify/convex_core.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "core/base/floating_point.h"
#include "verify/overlap.h"
#include "verify/within.h"

namespace farcull {
namespace {

using Corners = ClosedObject::Corners;
using separation::kU;

constexpr double kInf = std::numeric_limits<double>::infinity();
constexpr std::size_t kMostCuts = 64;  // a core has at most this many planes

/// Returns the point of a triangle that is nearest to p, in plain doubles (Ericson, Real-Time
/// Collision Detection, 2005, section 5.1.5).
Vec3 nearest_on(const Corners& t, const Vec3& p) {
  const Vec3 ab = t[1] - t[0], ac = t[2] - t[0], ap = p - t[0];
  const double d1 = ab.dot(ap), d2 = ac.dot(ap);
  if (d1 <= 0 && d2 <= 0) return t[0];
  const Vec3 bp = p - t[1];
  const double d3 = ab.dot(bp), d4 = ac.dot(bp);
  if (d3 >= 0 && d4 <= d3) return t[1];
  const Vec3 cp = p - t[2];
  const double d5 = ab.dot(cp), d6 = ac.dot(cp);
  if (d6 >= 0 && d5 <= d6) return t[2];
  const double vc = d1 * d4 - d3 * d2;
  if (vc <= 0 && d1 >= 0 && d3 <= 0) return t[0] + d1 / (d1 - d3) * ab;
  const double vb = d5 * d2 - d1 * d6;
  if (vb <= 0 && d2 >= 0 && d6 <= 0) return t[0] + d2 / (d2 - d6) * ac;
  const double va = d3 * d6 - d5 * d4;
  if (va <= 0 && d4 - d3 >= 0 && d5 - d6 >= 0)
    return t[1] + (d4 - d3) / ((d4 - d3) + (d5 - d6)) * (t[2] - t[1]);
  return t[0] + (vb * ab + vc * ac) / (va + vb + vc);
}

/// The points p with normal . (p - seed) <= reach. The normal has length 1.
struct HalfSpace {
  Vec3 normal;
  double reach;
};

/// True only if normal . (p - seed) > most for all p of t. `most` is a computed product of the same
/// form, for points at most `size` from the seed on each axis. Each product has 5 roundings,
/// relative to the magnitudes of its terms. 16 u covers the roundings of both.
bool beyond(const Corners& t, const Vec3& seed, const Vec3& normal, double most, double size) {
  double least = kInf, magnitude = size;
  for (const Vec3& v : t) {
    const Vec3 w = v - seed;
    least = std::min(least, normal.dot(w));
    magnitude = std::max(magnitude, w.cwiseAbs().maxCoeff());
  }
  return least - most > 16 * kU * normal.cwiseAbs().sum() * magnitude + 0x1p-1000;
}

/// True only if the hull of the points is proved to be a core, as described in convex_core.h. near:
/// all triangles that may meet the hull. To divide a triangle from the hull, the normals of
/// `planes` are tried first, then the triangle's normal, then other directions.
bool is_core(const ClosedObject& solid, const std::vector<Corners>& near, const Vec3& seed,
             std::span<const HalfSpace> planes, const std::vector<Vec3>& points) {
  double size = 0;
  for (const Vec3& p : points) size = std::max(size, (p - seed).cwiseAbs().maxCoeff());
  const auto most_along = [&](const Vec3& normal) {
    double most = -kInf;
    for (const Vec3& p : points) most = std::max(most, normal.dot(p - seed));
    return most;
  };
  std::vector<double> most;
  for (const HalfSpace& plane : planes) most.push_back(most_along(plane.normal));
  for (const Corners& t : near) {
    bool apart = false;
    for (std::size_t k = 0; k < planes.size() && !apart; ++k)
      apart = beyond(t, seed, planes[k].normal, most[k], size);
    if (apart) continue;
    Vec3 normal = (t[1] - t[0]).cross(t[2] - t[0]).normalized();
    if (normal.dot(t[0] - seed) < 0) normal = -normal;
    if (normal.allFinite() && beyond(t, seed, normal, most_along(normal), size)) continue;
    if (planes.empty() || !separation::farther_by_planes(points, t, 0)) return false;
  }
  return solid.has(points.front());
}

/// Returns the part of a triangle in all half spaces, as a polygon relative to the seed.
std::vector<Vec3> clipped(const Corners& t, const Vec3& seed, std::span<const HalfSpace> planes) {
  std::vector<Vec3> polygon = {t[0] - seed, t[1] - seed, t[2] - seed}, next;
  for (const auto& [normal, reach] : planes) {
    next.clear();
    for (std::size_t k = 0; k < polygon.size(); ++k) {
      const Vec3 &p = polygon[k], &q = polygon[(k + 1) % polygon.size()];
      const double of_p = normal.dot(p) - reach, of_q = normal.dot(q) - reach;
      if (of_p < 0) next.push_back(p);
      if ((of_p < 0) != (of_q < 0)) next.push_back(p + of_p / (of_p - of_q) * (q - p));
    }
    std::swap(polygon, next);
  }
  return polygon;
}

/// Returns half spaces, relative to the seed, for the sides of a box moved inward by `inward`.
std::vector<HalfSpace> sides_of(const Box& box, const Vec3& seed, double inward) {
  std::vector<HalfSpace> out;
  for (int axis = 0; axis < 3; ++axis) {
    out.push_back({Vec3::Unit(axis), box.hi[axis] - seed[axis] - inward});
    out.push_back({-Vec3::Unit(axis), seed[axis] - box.lo[axis] - inward});
  }
  return out;
}

/// Returns the corners of the intersection of the half spaces, relative to the seed.
std::vector<Vec3> corners_of(std::span<const HalfSpace> planes, double size) {
  std::vector<Vec3> out;
  const std::size_t count = planes.size();
  for (std::size_t i = 0; i < count; ++i) {
    for (std::size_t j = i + 1; j < count; ++j) {
      const Vec3 along = planes[i].normal.cross(planes[j].normal);
      if (along.norm() < 1e-5) continue;
      for (std::size_t k = j + 1; k < count; ++k) {
        const double det = along.dot(planes[k].normal);
        if (std::abs(det) < 1e-5) continue;
        const Vec3 p =
            (planes[i].reach * planes[j].normal.cross(planes[k].normal) +
             planes[j].reach * planes[k].normal.cross(planes[i].normal) + planes[k].reach * along) /
            det;
        const double slack = 1e-12 * size;
        const auto outside = [&](const HalfSpace& h) { return h.normal.dot(p) > h.reach + slack; };
        const auto same = [&](const Vec3& q) { return (p - q).cwiseAbs().maxCoeff() < slack; };
        if (std::ranges::none_of(planes, outside) && std::ranges::none_of(out, same))
          out.push_back(p);
      }
    }
  }
  return out;
}

struct Grown {
  Vec3 seed;
  std::vector<HalfSpace> planes;
  std::vector<Vec3> points;
  bool has(const Vec3& p) const {
    return std::ranges::all_of(
        planes, [&](const HalfSpace& h) { return h.normal.dot(p - seed) <= h.reach; });
  }
};

/// Returns the core around a seed; empty if none is found. near: all triangles that meet the
/// region, the nearest to the seed first. Each plane is moved towards the seed by the fraction
/// `pull` of its distance, so that one plane cuts off many triangles of a curved surface.
std::optional<Grown> grow(const ClosedObject& solid, const std::vector<Corners>& near,
                          const Box& region, const Vec3& seed, double pull) {
  const double size = (region.hi - region.lo).norm();
  const double inward = kCoreInward * size + 256 * kU * solid.largest();
  Grown out{.seed = seed, .planes = sides_of(region, seed, inward), .points = {}};
  for (const Corners& t : near) {
    const auto divides = [&](const HalfSpace& h) {
      return std::ranges::all_of(
          t, [&](const Vec3& v) { return h.normal.dot(v - seed) >= h.reach + 0.25 * inward; });
    };
    if (std::ranges::any_of(out.planes, divides) || clipped(t, seed, out.planes).empty()) continue;
    Vec3 normal = nearest_on(t, seed) - seed;
    double reach = normal.norm();
    normal /= reach;
    const Vec3 across = (t[1] - t[0]).cross(t[2] - t[0]).normalized();
    const double height = across.dot(t[0] - seed);
    if (std::abs(height) > 0.5 * reach)
      normal = height < 0 ? Vec3(-across) : across, reach = std::abs(height);
    reach = (1 - pull) * reach - inward;
    if (!(reach > 0) || out.planes.size() >= kMostCuts) return std::nullopt;
    out.planes.push_back({normal, reach});
  }
  for (const Vec3& p : corners_of(out.planes, size)) {
    out.points.push_back(seed + p);
    if (!((out.points.back() - region.lo).minCoeff() >= 0 &&
          (region.hi - out.points.back()).minCoeff() >= 0))
      return std::nullopt;
  }
  if (out.points.size() < 4 || !is_core(solid, near, seed, out.planes, out.points))
    return std::nullopt;
  return out;
}

/// True only if a plane perpendicular to t separates the corners of a, moved by t, from those of b.
/// The projection of a moved corner has 6 roundings, relative to `magnitude`. The origin is moved
/// along each axis on which the coordinates have one sign and none is more than twice another.
/// Differences from the new origin are exact (Sterbenz, Floating-Point Computation, 1974).
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

/// True if the surface of b and the surface of a, moved by t, are more than `margin` apart.
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

ClosedObject::ClosedObject(const Scene& scene, std::uint32_t object, Surface surface,
                           std::span<const Vec3> pieces)
    : scene_(scene), object_(object), surface_(surface), pieces_(pieces.begin(), pieces.end()) {
  const Object& o = scene.objects[object];
  std::vector<std::array<double, 3>> places;
  for (std::uint32_t k = 0; k < o.triangle_count; ++k) {
    triangles_.push_back(scene.corners(o.first_triangle + k));
    for (const Vec3& p : triangles_.back()) places.push_back({p.x(), p.y(), p.z()}), box_.add(p);
  }
  std::ranges::sort(places);
  places.erase(std::unique(places.begin(), places.end()), places.end());
  for (const auto& p : places) corners_.emplace_back(p[0], p[1], p[2]);
  largest_ = std::max(box_.lo.cwiseAbs().maxCoeff(), box_.hi.cwiseAbs().maxCoeff());
  tree_ = BoundsTree(triangles_);
  tree_.add(0, o.triangle_count);
  std::vector<Corners> ordered;
  for (const std::uint32_t t : tree_.order) ordered.push_back(triangles_[t]);
  triangles_ = std::move(ordered);
  constexpr double kMostTests = 3e7;
  if (double(triangles_.size()) * double(corners_.size()) > kMostTests) return;
  Vec3 middle = Vec3::Zero();
  for (const Vec3& p : corners_) middle += p / double(corners_.size());
  // Moves the corners inward. Thin objects need larger moves because of rounding.
  for (const double inward : {1e-12, 1e-9, 1e-6}) {
    convex_.clear();
    for (const Vec3& p : corners_) convex_.push_back(middle + (1 - inward) * (p - middle));
    if (is_core(*this, triangles_, middle, {}, convex_)) return;
  }
  convex_.clear();
}

bool ClosedObject::has(const Vec3& point) const {
  return inside(scene_, object_, point, surface_) == Inside::yes;
}

Vec3 ClosedObject::nearest(const Vec3& point) const {
  const auto squared_to = [&](std::uint32_t node) {
    const BoundsTree::Bounds& box = tree_.nodes[node].bounds;
    double out = 0;
    for (int k = 0; k < 3; ++k) {
      const double gap = std::max({box.lo[k] - point[k], point[k] - box.hi[k], 0.0});
      out += gap * gap;
    }
    return out;
  };
  double least = kInf;
  Vec3 out = triangles_[0][0];
  std::vector<std::pair<double, std::uint32_t>> stack = {{0, 0}};
  while (!stack.empty()) {
    const auto [squared, at] = stack.back();
    stack.pop_back();
    if (squared >= least) continue;
    if (tree_.is_leaf(at)) {
      const BoundsTree::Node& node = tree_.nodes[at];
      for (std::uint32_t k = 0; k < node.count; ++k) {
        const Vec3 p = nearest_on(triangles_[node.first + k], point);
        if (const double to = (p - point).squaredNorm(); to < least) least = to, out = p;
      }
      continue;
    }
    for (const std::uint32_t child : {tree_.left(at), tree_.right(at)})
      stack.emplace_back(squared_to(child), child);
    if (stack.back() > stack[stack.size() - 2]) std::swap(stack.back(), stack[stack.size() - 2]);
  }
  return out;
}

bool ClosedObject::has_not(const Vec3& point) const {
  if ((point.array() < box_.lo.array()).any() || (point.array() > box_.hi.array()).any())
    return true;
  return overlap_at(scene_, object_, point, surface_) == Overlap::no;
}

std::vector<std::vector<Vec3>> cores_of(const ClosedObject& solid, const Box& region,
                                        std::span<const Vec3> seeds, std::size_t most) {
  if (!solid.convex().empty()) return {solid.convex()};
  constexpr std::array kPulls = {0.0, 0.05, 0.15, 0.3};
  constexpr double kWork = 1e6;  // about this many triangles are examined
  std::vector<Corners> near;
  const BoundsTree& tree = solid.tree();
  const auto meets_region = [&](const BoundsTree::Bounds& box) {
    for (int k = 0; k < 3; ++k) {
      if (box.lo[k] > region.hi[k] || box.hi[k] < region.lo[k]) return false;
    }
    return true;
  };
  for (std::uint32_t at = 0; at < tree.nodes.size();) {
    const BoundsTree::Node& node = tree.nodes[at];
    if (!meets_region(node.bounds)) {
      at = node.after;
      continue;
    }
    for (std::uint32_t k = 0; tree.is_leaf(at) && k < node.count; ++k) {
      const Corners& t = solid.triangles()[node.first + k];
      if (meets_region(BoundsTree::bounds_of(t))) near.push_back(t);
    }
    ++at;
  }
  std::vector<Vec3> tried(seeds.begin(), seeds.end());
  // Adds seeds on both sides of up to 96 triangles, at two small heights above the middle of the
  // triangle's part in the region. The smaller height is for thin walls.
  const Vec3 middle = 0.5 * (region.lo + region.hi);
  const std::vector<HalfSpace> sides = sides_of(region, middle, 0);
  const std::size_t stride = near.size() / 96 + 1;
  for (std::size_t k = 0; k < near.size(); k += stride) {
    const std::vector<Vec3> polygon = clipped(near[k], middle, sides);
    Vec3 sum = Vec3::Zero(), across = Vec3::Zero();
    double longest = 0;
    for (std::size_t i = 0; i < polygon.size(); ++i) {
      const Vec3& next = polygon[(i + 1) % polygon.size()];
      sum += polygon[i];
      across += (polygon[i] - polygon[0]).cross(next - polygon[0]);
      longest = std::max(longest, (next - polygon[i]).norm());
    }
    if (!(across.norm() > 0)) continue;
    for (const double part : {-2e-3, 2e-3, -2e-5, 2e-5})
      tried.push_back(middle + sum / double(polygon.size()) + part / longest * across);
  }
  std::vector<Grown> grown;
  double work = kWork;
  std::vector<std::pair<double, std::uint32_t>> order(near.size());
  std::vector<Corners> sorted(near.size());
  for (const Vec3& seed : tried) {
    if (grown.size() >= most || work < 0) break;
    if (!((seed - region.lo).minCoeff() > 0 && (region.hi - seed).minCoeff() > 0)) continue;
    if (std::ranges::any_of(grown, [&](const Grown& g) { return g.has(seed); })) continue;
    work -= 0.05 * double(solid.triangles().size());
    if (!solid.has(seed)) continue;
    for (std::uint32_t k = 0; k < near.size(); ++k)
      order[k] = {(nearest_on(near[k], seed) - seed).squaredNorm(), k};
    std::ranges::sort(order);
    for (std::size_t k = 0; k < near.size(); ++k) sorted[k] = near[order[k].second];
    work -= double(near.size());
    for (const double pull : kPulls) {
      std::optional<Grown> one = grow(solid, sorted, region, seed, pull);
      if (!one) continue;
      grown.push_back(std::move(*one));
      break;
    }
  }
  std::vector<std::vector<Vec3>> out;
  for (Grown& one : grown) out.push_back(std::move(one.points));
  return out;
}

// Suppose that the surfaces are apart, but the insides have a common point. Then a connected piece
// of one surface is entirely inside the other object. So it is enough to test one corner of each
// piece. Moving a coordinate in doubles is off by at most 2^-53 of its magnitude. The margin
// between the surfaces is larger than all such errors. So the rounded corner and the exact corner
// lie on the same side of the other surface.
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
