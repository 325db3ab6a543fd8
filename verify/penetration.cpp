// The expanding polytope algorithm gives directions, of which the best one is the upper bound, and
// a polytope in the Minkowski difference, which is the lower bound for nearly convex objects. A
// search by steps along the axes gives the point of the balls. All this is in plain doubles; what
// it finds is then proved with exact predicates, or with bounds of all roundings.
#include "verify/penetration.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <optional>
#include <vector>

#include "core/base/floating_point.h"
#include "verify/closest.h"
#include "verify/filter_scalars.h"
#include "verify/inside.h"
#include "verify/rational.h"
#include "verify/separation.h"

namespace farcull {
namespace {

using Corners = std::array<Vec3, 3>;
using rational::Q;
using separation::kU;

constexpr double kInf = std::numeric_limits<double>::infinity();

double down(double x) { return std::nextafter(x, -kInf); }

std::vector<Corners> triangles_of(const Scene& scene, std::uint32_t object) {
  const Object& o = scene.objects[object];
  std::vector<Corners> out(o.triangle_count);
  for (std::uint32_t k = 0; k < o.triangle_count; ++k) out[k] = scene.corners(o.first_triangle + k);
  return out;
}

/// Each corner once.
std::vector<Vec3> corners_of(const std::vector<Corners>& triangles) {
  std::vector<std::array<double, 3>> places;
  for (const Corners& t : triangles) {
    for (const Vec3& p : t) places.push_back({p.x(), p.y(), p.z()});
  }
  std::ranges::sort(places);
  places.erase(std::unique(places.begin(), places.end()), places.end());
  std::vector<Vec3> out;
  for (const auto& p : places) out.emplace_back(p[0], p[1], p[2]);
  return out;
}

/// The largest direction . p over the points, exactly.
Q largest_along(std::span<const Vec3> points, const Vec3& direction) {
  // The computed value of each has three products and two sums.
  const auto bound = [&](const Vec3& p) {
    return 8 * kU * direction.cwiseAbs().dot(p.cwiseAbs()) + 0x1p-1000;
  };
  double least = -kInf;
  for (const Vec3& p : points) least = std::max(least, direction.dot(p) - bound(p));
  Q most;
  bool any = false;
  for (const Vec3& p : points) {
    if (direction.dot(p) + bound(p) < least) continue;
    const Q value = rational::dot(rational::exact(direction), rational::exact(p));
    if (!any || value > most) most = value;
    any = true;
  }
  return most;
}

bool separates_points(std::span<const Vec3> a, std::span<const Vec3> b, const Vec3& direction,
                      const Vec3& translation) {
  if (direction.isZero(0) || !direction.allFinite() || !translation.allFinite()) return false;
  const Q moved = rational::dot(rational::exact(direction), rational::exact(translation));
  return largest_along(a, direction) + largest_along(b, -direction) + moved <= 0;
}

// ---- the expanding polytope ----

struct Solid {
  std::vector<Corners> triangles;
  std::vector<Vec3> points;
  Vec3 farthest(const Vec3& direction) const {
    double most = -kInf;
    std::size_t at = 0;
    for (std::size_t k = 0; k < points.size(); ++k) {
      const double value = direction.dot(points[k]);
      if (value > most) most = value, at = k;
    }
    return points[at];
  }
};

class Polytope {
 public:
  Polytope(const Solid& a, const Solid& b) : a_(a), b_(b) {}

  /// Expands until no direction is better by more than a small part, or for so many steps. Returns
  /// whether the origin is inside the polytope, as far as doubles tell.
  bool expand(int steps) {
    if (!begin()) return false;
    for (int step = 0; step < steps; ++step) {
      const auto nearest = std::ranges::min_element(faces_, {}, &Face::distance);
      if (nearest == faces_.end()) return false;
      const double distance = nearest->distance;
      const Vec3 normal = nearest->normal;
      const Vec3 next = support(normal);
      if (normal.dot(next) - distance <= 1e-12 * scale_ || !add(next)) break;
    }
    return std::ranges::all_of(faces_, [](const Face& face) { return face.distance > 0; });
  }

  const Vec3& direction() const { return direction_; }  // of the least overlap
  double overlap() const { return overlap_; }

  /// The polytope as an object of a scene.
  Scene scene() const {
    Scene out;
    out.vertices = corners_;
    for (const Face& face : faces_) out.triangles.push_back(face.corners);
    out.source_face.resize(faces_.size());
    const auto count = static_cast<std::uint32_t>(faces_.size());
    out.objects.push_back({.name = "difference", .first_triangle = 0, .triangle_count = count});
    return out;
  }

 private:
  struct Face {
    std::array<std::uint32_t, 3> corners;
    Vec3 normal;  // of length 1, outward
    double distance;
  };

  // A point of the difference a - b that is farthest in the direction. Every direction is a
  // candidate for the translation.
  Vec3 support(const Vec3& direction) {
    const Vec3 out = a_.farthest(direction) - b_.farthest(-direction);
    const double overlap = direction.dot(out);
    if (overlap < overlap_ && (direction.array() != 0).any())
      overlap_ = overlap, direction_ = direction;
    return out;
  }

  bool add_face(std::uint32_t i, std::uint32_t j, std::uint32_t k) {
    const Vec3 normal = (corners_[j] - corners_[i]).cross(corners_[k] - corners_[i]);
    const double length = normal.norm();
    if (!(length > 0 && length < kInf)) return false;
    faces_.push_back({{i, j, k}, normal / length, normal.dot(corners_[i]) / length});
    return true;
  }

  // Finds four points that span a tetrahedron.
  bool begin() {
    std::vector<Vec3> found;
    for (int axis = 0; axis < 3; ++axis) {
      for (const double sign : {1.0, -1.0}) found.push_back(support(sign * Vec3::Unit(axis)));
    }
    for (const double x : {1.0, -1.0}) {
      for (const double y : {1.0, -1.0}) {
        for (const double z : {1.0, -1.0}) found.push_back(support(Vec3(x, y, z).normalized()));
      }
    }
    const auto farthest = [&](const auto& measure) {
      return *std::ranges::max_element(found, {}, measure);
    };
    const Vec3 p = found[0];
    const Vec3 q = farthest([&](const Vec3& x) { return (x - p).norm(); });
    scale_ = (q - p).norm();
    const Vec3 r = farthest([&](const Vec3& x) { return (x - p).cross(q - p).norm(); });
    const Vec3 n = (q - p).cross(r - p);
    const Vec3 s = farthest([&](const Vec3& x) { return std::abs((x - p).dot(n)); });
    corners_ = {p, q, r, s};
    if ((s - p).dot(n) > 0) std::swap(corners_[1], corners_[2]);
    if (!(add_face(0, 1, 2) && add_face(0, 3, 1) && add_face(1, 3, 2) && add_face(2, 3, 0)))
      return false;
    for (const Vec3& x : found) add(x);
    return true;
  }

  // Replaces the faces that see the point by faces to it. False if none does, or a new one is flat.
  bool add(const Vec3& point) {
    std::map<std::array<std::uint32_t, 2>, int> edges;  // of faces that see the point, directed
    std::vector<Face> kept;
    for (const Face& face : faces_) {
      if (face.normal.dot(point - corners_[face.corners[0]]) <= 1e-14 * scale_) {
        kept.push_back(face);
        continue;
      }
      for (int i = 0; i < 3; ++i) ++edges[{face.corners[i], face.corners[(i + 1) % 3]}];
    }
    if (kept.size() == faces_.size()) return false;
    std::vector<Face> before = std::exchange(faces_, std::move(kept));
    corners_.push_back(point);
    const auto last = static_cast<std::uint32_t>(corners_.size() - 1);
    for (const auto& [edge, count] : edges) {
      if (edges.contains({edge[1], edge[0]})) continue;
      if (add_face(edge[0], edge[1], last)) continue;
      faces_ = std::move(before);
      return false;
    }
    return true;
  }

  const Solid &a_, &b_;
  std::vector<Vec3> corners_;
  std::vector<Face> faces_;
  double scale_ = 0;
  double overlap_ = kInf;
  Vec3 direction_ = Vec3::UnitX();
};

// ---- from above ----

/// A translation of a along -direction that separates, with room for the rounding of coordinates.
void bound_above(const Solid& a, const Solid& b, const Vec3& direction, Penetration& out) {
  const Q overlap = largest_along(a.points, direction) + largest_along(b.points, -direction);
  double largest = 0;
  for (const Solid* solid : {&a, &b}) {
    for (const Vec3& p : solid->points) largest = std::max(largest, p.cwiseAbs().maxCoeff());
  }
  // Corners that are moved in doubles are rounded by this at most, so that they are apart as well.
  double length = overlap.get_d() + 8 * kU * (largest + std::abs(overlap.get_d()));
  for (int k = 0; k < 64; ++k) {
    out.translation = -length / direction.squaredNorm() * direction;
    out.direction = direction;
    if (separates_points(a.points, b.points, direction, out.translation)) break;
    length += std::ldexp(kU, k) * std::abs(length);
  }
  out.hi = out.translation.stableNorm() * (1 + 8 * kU);
  if (out.hi > 0) out.hi = std::nextafter(out.hi, kInf);  // also among subnormal numbers
  if (!separates_points(a.points, b.points, direction, out.translation)) out.hi = kInf;
}

// ---- from below, nearly convex ----

/// How far corners of the solid are above planes of its faces, with all roundings; infinite if a
/// face has no certain plane, or if there are too many faces.
double height_above_faces(const Solid& solid) {
  constexpr double kMostTests = 3e8;
  if (static_cast<double>(solid.triangles.size()) * static_cast<double>(solid.points.size()) >
      kMostTests)
    return kInf;
  double most = 0;
  for (const Corners& t : solid.triangles) {
    const filters::Normal n =
        filters::normal_of(filters::difference(t[1], t[0]), filters::difference(t[2], t[0]));
    // A component of the normal has two products of differences: 4 roundings each.
    const double length = std::sqrt(filters::dot(n.n, n.n)) * (1 - 8 * kU) -
                          8 * kU * (n.m.x + n.m.y + n.m.z) - 0x1p-500;
    if (!(length > 0 && length < kInf)) return kInf;
    double above = 0, below = 0;  // the normal may face outward or inward
    for (const Vec3& p : solid.points) {
      const auto w = filters::difference(p, t[0]);
      const double value = filters::dot(n.n, w);
      const double bound = filters::side_bound<FilterBounds>(n, filters::magnitudes(w));
      if (!(std::abs(value) + bound < kInf)) return kInf;
      above = std::max(above, (value + bound) / length);
      below = std::max(below, (bound - value) / length);
    }
    most = std::max(most, std::min(above, below));
  }
  return most * (1 + 8 * kU);
}

/// How much a corner of the convex hull can be outside a convex part of the solid; infinite if
/// there is no proof.
double hull_error(const Scene& scene, std::uint32_t object, const Solid& solid) {
  Vec3 centre = Vec3::Zero();
  for (const Vec3& p : solid.points) centre += p / static_cast<double>(solid.points.size());
  if (inside(scene, object, centre) != Inside::yes) return kInf;
  const double rho = distance_below(scene, object, centre);
  const double epsilon = height_above_faces(solid);
  if (!(rho > 2 * epsilon)) return kInf;
  double radius = 0;
  for (const Vec3& p : solid.points) radius = std::max(radius, (p - centre).norm());
  return epsilon / rho * radius * (1 + 32 * kU);
}

double bound_by_polytope(const Scene& scene, ObjectPair objects, const Solid& a, const Solid& b,
                         const Polytope& polytope) {
  const Scene difference = polytope.scene();
  const Vec3 origin = Vec3::Zero();
  if (inside(difference, 0, origin) != Inside::yes) return 0;
  double largest = 0;
  for (const Vec3& p : difference.vertices) largest = std::max(largest, p.norm());
  const double error = hull_error(scene, objects.a, a) + hull_error(scene, objects.b, b) +
                       4 * kU * largest;  // corners are rounded differences
  const double radius = distance_below(difference, 0, origin);
  const double out = down(radius - error * (1 + 8 * kU));
  return std::isfinite(out) ? std::max(out, 0.0) : 0;
}

// ---- from below, by balls ----

/// The squared distance of a point and a triangle in plain doubles (Ericson, Real-Time Collision
/// Detection, 2005, section 5.1.5).
double squared_to(const Corners& t, const Vec3& p) {
  const Vec3 ab = t[1] - t[0], ac = t[2] - t[0], ap = p - t[0];
  const double d1 = ab.dot(ap), d2 = ac.dot(ap);
  if (d1 <= 0 && d2 <= 0) return ap.squaredNorm();
  const Vec3 bp = p - t[1];
  const double d3 = ab.dot(bp), d4 = ac.dot(bp);
  if (d3 >= 0 && d4 <= d3) return bp.squaredNorm();
  const Vec3 cp = p - t[2];
  const double d5 = ab.dot(cp), d6 = ac.dot(cp);
  if (d6 >= 0 && d5 <= d6) return cp.squaredNorm();
  const double vc = d1 * d4 - d3 * d2;
  if (vc <= 0 && d1 >= 0 && d3 <= 0) return (ap - d1 / (d1 - d3) * ab).squaredNorm();
  const double vb = d5 * d2 - d1 * d6;
  if (vb <= 0 && d2 >= 0 && d6 <= 0) return (ap - d2 / (d2 - d6) * ac).squaredNorm();
  const double va = d3 * d6 - d5 * d4;
  if (va <= 0 && d4 - d3 >= 0 && d5 - d6 >= 0) {
    const double w = (d4 - d3) / ((d4 - d3) + (d5 - d6));
    return (bp - w * (t[2] - t[1])).squaredNorm();
  }
  const Vec3 n = ab.cross(ac);
  const double height = n.dot(ap);
  return height * height / n.squaredNorm();
}

/// The distance to the surface, negative outside, in plain doubles.
double depth_in(const Solid& solid, const Vec3& p) {
  double squared = kInf;
  bool odd = false;
  for (const Corners& t : solid.triangles) {
    squared = std::min(squared, squared_to(t, p));
    // The ray along the first axis. One that meets an edge is moved a little along y, and by far
    // less along z: the middle of a box often has the diagonals of its faces before it.
    std::array<double, 3> side{};
    int left = 0, right = 0;
    for (int i = 0; i < 3; ++i) {
      const Vec3 u = t[i] - p, v = t[(i + 1) % 3] - p;
      side[i] = u.y() * v.z() - u.z() * v.y();
      const double moved = side[i] != 0 ? side[i] : u.z() != v.z() ? u.z() - v.z() : v.y() - u.y();
      left += moved > 0;
      right += moved < 0;
    }
    if (left != 3 && right != 3) continue;
    const double height =
        side[1] * (t[0].x() - p.x()) + side[2] * (t[1].x() - p.x()) + side[0] * (t[2].x() - p.x());
    if (left == 3 ? height > 0 : height < 0) odd = !odd;
  }
  return (odd ? 1 : -1) * std::sqrt(squared);
}

/// A point deep inside both, by steps along the axes that become shorter.
Vec3 deep_point(const Solid& a, const Solid& b, std::vector<Vec3> starts, double step) {
  const double work = 3e7 / static_cast<double>(a.triangles.size() + b.triangles.size());
  int left = static_cast<int>(std::clamp(work, 80.0, 1500.0));
  const auto value = [&](const Vec3& p) {
    --left;
    const double of_a = depth_in(a, p), of_b = depth_in(b, p);
    return of_a > 0 && of_b > 0 ? of_a + of_b : std::min({of_a, of_b, 0.0}) - 1e-300;
  };
  Vec3 best = starts.front();
  double most = -kInf;
  for (const Vec3& p : starts) {
    const double v = value(p);
    if (v > most) most = v, best = p;
    if (left <= 40) break;
  }
  for (const double least = 1e-4 * step; step > least && left > 0; step /= 2) {
    for (bool better = true; better && left > 0;) {
      better = false;
      for (int k = 0; k < 6; ++k) {
        const Vec3 p = best + (k % 2 == 0 ? step : -step) * Vec3::Unit(k / 2);
        const double v = value(p);
        if (v > most) most = v, best = p, better = true;
      }
    }
  }
  return best;
}

double bound_by_balls(const Scene& scene, ObjectPair objects, const Vec3& p) {
  for (const std::uint32_t object : {objects.a, objects.b}) {
    if (inside(scene, object, p) != Inside::yes) return 0;
  }
  return down(distance_below(scene, objects.a, p) + distance_below(scene, objects.b, p));
}

}  // namespace

bool separates(const Scene& scene, ObjectPair objects, const Vec3& direction,
               const Vec3& translation) {
  const FloatingPointGuard guard;
  return separates_points(corners_of(triangles_of(scene, objects.a)),
                          corners_of(triangles_of(scene, objects.b)), direction, translation);
}

double distance_below(const Scene& scene, std::uint32_t object, const Vec3& point) {
  const FloatingPointGuard guard;
  const std::vector<Corners> triangles = triangles_of(scene, object);
  double squared = kInf;
  for (const Corners& t : triangles) squared = std::min(squared, squared_to(t, point));
  // A little less can be proved of most triangles without exact arithmetic.
  double limit = std::sqrt(squared) * (1 - 1e-9);
  if (!(limit >= 0 && limit < kInf)) limit = 0;
  const Corners at = {point, point, point};
  for (const Corners& t : triangles) {
    if (separation::farther_by_planes(at, t, limit)) continue;
    limit = std::min(limit, std::max(down(closest_points(at, t).distance), 0.0));
  }
  return limit;
}

Penetration penetration(const Scene& scene, ObjectPair objects, std::span<const Vec3> starts) {
  constexpr int kSteps = 200;
  const FloatingPointGuard guard;
  std::array<Solid, 2> solids;
  for (const int side : {0, 1}) {
    solids[side].triangles = triangles_of(scene, side == 0 ? objects.a : objects.b);
    solids[side].points = corners_of(solids[side].triangles);
  }
  const auto& [a, b] = solids;
  Penetration out;
  Polytope polytope(a, b);
  const bool holds_origin = polytope.expand(kSteps);
  bound_above(a, b, polytope.direction(), out);
  if (holds_origin) out.lo = bound_by_polytope(scene, objects, a, b, polytope);
  if (out.lo * 1.01 >= out.hi) return out;
  const Vec3 d = polytope.direction();
  std::vector<Vec3> points = {0.5 * (a.farthest(d) + b.farthest(-d))};
  points.insert(points.end(), starts.begin(), starts.end());
  for (const Vec3& p : starts) {
    for (const double part : {-0.25, 0.25}) points.push_back(p + part * out.translation);
  }
  Vec3 middle = Vec3::Zero();
  for (const Vec3& p : starts) middle += p / static_cast<double>(starts.size());
  points.push_back(middle);
  const double step = std::isfinite(out.hi) ? 0.25 * out.hi : 1;
  out.lo = std::max(out.lo, bound_by_balls(scene, objects, deep_point(a, b, points, step)));
  return out;
}

}  // namespace farcull
