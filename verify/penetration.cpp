// The expanding polytope algorithm on all corners finds the shortest translation that separates the
// convex hulls. This translation gives the first upper bound. Then a search improves both bounds.
// Both steps compute in plain doubles, but the bounds are proved.
#include "verify/penetration.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <queue>
#include <utility>
#include <vector>

#include "core/base/floating_point.h"
#include "core/base/parallel.h"

namespace farcull {
namespace {

using Points = std::vector<Vec3>;
using separation::kU;

constexpr double kInf = std::numeric_limits<double>::infinity();

const Vec3& farthest(const Points& points, const Vec3& direction) {
  double most = -kInf;
  std::size_t at = 0;
  for (std::size_t k = 0; k < points.size(); ++k) {
    const double value = direction.dot(points[k]);
    if (value > most) most = value, at = k;
  }
  return points[at];
}

class Polytope {
 public:
  struct Face {
    std::array<std::uint32_t, 3> corners;
    Vec3 normal;      // of length 1, outward
    double distance;  // from the origin; negative if the origin is above the plane
    bool final;       // true if the face needs no further expansion
  };

  /// flat: a point counts as in a plane if its height, divided by the polytope's size, is at most
  /// `flat`. Corners are rounded, so the plane of a small face is uncertain far from the face.
  Polytope(const Points& a, const Points& b, double flat) : a_(&a), b_(&b), flat_(flat) {}

  /// Adds points above the face that is nearest to the origin. Ends when this face is final (with
  /// `whole`: when all faces are final), or when `steps` points were added.
  void expand(int steps, bool whole) {
    if (!begin()) faces_.clear();
    while (steps > 0 && !faces_.empty()) {
      Face* nearest = nullptr;
      for (Face& face : faces_) {
        if ((!whole || !face.final) && (!nearest || face.distance < nearest->distance))
          nearest = &face;
      }
      if (!nearest || nearest->final) break;
      const double distance = nearest->distance;
      const Vec3 normal = nearest->normal, next = support(normal);
      nearest->final = true;
      if (normal.dot(next) - distance <= 4 * flat_ * scale_) continue;
      if (std::ranges::count(corners_, next) > 0) {
        convex_ = false;
        continue;
      }
      add(next);
      --steps;
      // A convex surface has fewer faces than twice its corners. So rounding broke this surface.
      if (faces_.size() > 2 * corners_.size()) faces_.clear();
    }
  }

  const Vec3& direction() const { return direction_; }  // direction of the least overlap
  double overlap() const { return overlap_; }
  const std::vector<Face>& faces() const { return faces_; }
  /// False if rounding of thin faces left a corner above a face, or kept a corner from being added.
  bool convex() const { return convex_; }
  const Points& corners() const { return corners_; }

 private:
  // Returns the point of the Minkowski difference b - a that is farthest in the direction.
  // `overlap` is the distance by which a must move in this direction so that a begins where b ends.
  Vec3 support(const Vec3& direction) {
    const Vec3 out = farthest(*b_, direction) - farthest(*a_, -direction);
    const double overlap = direction.dot(out);
    if (overlap < overlap_) overlap_ = overlap, direction_ = direction;
    return out;
  }

  bool add_face(std::uint32_t i, std::uint32_t j, std::uint32_t k) {
    const Vec3 normal = (corners_[j] - corners_[i]).cross(corners_[k] - corners_[i]);
    const double length = normal.norm();
    if (!(length > 0 && length < kInf)) return false;
    faces_.push_back({{i, j, k}, normal / length, normal.dot(corners_[i]) / length, false});
    return true;
  }

  // Finds four points that span a tetrahedron.
  bool begin() {
    Points found;
    for (int axis = 0; axis < 3; ++axis) {
      for (const double sign : {1.0, -1.0}) found.push_back(support(sign * Vec3::Unit(axis)));
    }
    for (const double x : {1.0, -1.0}) {
      for (const double y : {1.0, -1.0}) {
        for (const double z : {1.0, -1.0}) found.push_back(support(Vec3(x, y, z).normalized()));
      }
    }
    const auto most = [&](const auto& measure) {
      return *std::ranges::max_element(found, {}, measure);
    };
    const Vec3 p = found[0];
    const Vec3 q = most([&](const Vec3& x) { return (x - p).norm(); });
    scale_ = (q - p).norm();
    const Vec3 r = most([&](const Vec3& x) { return (x - p).cross(q - p).norm(); });
    const Vec3 n = (q - p).cross(r - p);
    const Vec3 s = most([&](const Vec3& x) { return std::abs((x - p).dot(n)); });
    corners_ = {p, q, r, s};
    if ((s - p).dot(n) > 0) std::swap(corners_[1], corners_[2]);
    if (!(add_face(0, 1, 2) && add_face(0, 3, 1) && add_face(1, 3, 2) && add_face(2, 3, 0)))
      return false;
    for (const Vec3& x : found) add(x);
    return true;
  }

  // Replaces the faces that see the point by faces from the rim of these faces to the point. If a
  // new face would be degenerate, restores the old faces.
  void add(const Vec3& point) {
    std::vector<std::array<std::uint32_t, 2>> edges;  // directed edges of faces that see the point
    std::vector<Face> kept;
    for (const Face& face : faces_) {
      if (face.normal.dot(point - corners_[face.corners[0]]) <= flat_ * scale_) {
        kept.push_back(face);
        continue;
      }
      for (int i = 0; i < 3; ++i) edges.push_back({face.corners[i], face.corners[(i + 1) % 3]});
    }
    if (edges.empty()) return;
    std::vector<Face> before = std::exchange(faces_, std::move(kept));
    corners_.push_back(point);
    const auto last = static_cast<std::uint32_t>(corners_.size() - 1);
    // The common edge of two removed faces cancels, so only edges at the rim get a new face.
    std::ranges::sort(edges);
    for (auto at = edges.begin(); at != edges.end();) {
      const auto [from, to] = *at;
      const auto passed = std::ranges::equal_range(edges, *at);
      auto more =
          std::ssize(passed) - std::ssize(std::ranges::equal_range(edges, std::array{to, from}));
      for (; more > 0; --more) {
        if (add_face(from, to, last)) continue;
        faces_ = std::move(before);
        return;
      }
      at = passed.end();
    }
  }

  const Points *a_, *b_;
  Points corners_;
  std::vector<Face> faces_;
  double flat_, scale_ = 0;
  double overlap_ = kInf;
  Vec3 direction_ = Vec3::UnitX();
  bool convex_ = true;
};

/// A set of translations of a after which the objects certainly overlap.
struct Cover {
  struct Side {
    Vec3 normal;      // of length 1
    double distance;  // a translation t is in the cover if normal . t < distance for all sides
    double error;     // bound of the error of normal . t - distance, relative to the magnitudes
    Vec3 support;     // |normal . axis| for each axis of the search's boxes
  };
  std::vector<Side> sides;
  double largest = 0;  // the largest |coordinate| of the polytope's corners
};

// Roundings. A component of a normal e x f has 4 roundings, relative to products of components of e
// and f. These products are divided by the normal's length; `thin` bounds the quotient. Products
// with a translation and with a corner, the corner's own rounding, sums and axes have 24 more,
// relative to 1. The factor 40 covers all of them.
Cover cover_of(const Polytope& polytope, const std::array<Vec3, 3>& axes) {
  Cover out;
  const Points& at = polytope.corners();
  for (const Vec3& p : at) out.largest = std::max(out.largest, p.cwiseAbs().maxCoeff());
  for (const Polytope::Face& face : polytope.faces()) {
    const Vec3 &p = at[face.corners[0]], e = at[face.corners[1]] - p, f = at[face.corners[2]] - p;
    const double thin = e.cwiseAbs().sum() * f.cwiseAbs().sum() / e.cross(f).norm();
    Cover::Side side{face.normal, face.normal.dot(p), 40 * kU * (3 + thin), {}};
    for (int k = 0; k < 3; ++k) side.support[k] = std::abs(face.normal.dot(axes[k]));
    out.sides.push_back(side);
  }
  return out;
}

/// Returns how far a ray from the origin stays inside the union of the covers, in plain doubles.
double held_along(const std::vector<Cover>& covers, const Vec3& direction) {
  std::vector<std::array<double, 2>> parts;  // the part of the ray in each cover
  for (const Cover& cover : covers) {
    auto& [from, to] = parts.emplace_back(std::array{-kInf, kInf});
    for (const Cover::Side& side : cover.sides) {
      const double slope = side.normal.dot(direction);
      if (slope > 1e-14) to = std::min(to, side.distance / slope);
      if (slope < -1e-14) from = std::max(from, side.distance / slope);
      if (std::abs(slope) > 1e-14 || side.distance >= 0) continue;
      from = to = 0;
      break;
    }
  }
  std::ranges::sort(parts);
  double out = 0;
  for (const auto& [from, to] : parts) {
    if (from <= out * (1 + 1e-9)) out = std::max(out, to);
  }
  return out;
}

/// Returns three directions, perpendicular except for rounding. The first is the normal with the
/// most area. The second is chosen likewise among normals perpendicular to the first.
std::array<Vec3, 3> axes_of(const ClosedObject& a, const ClosedObject& b) {
  std::vector<std::pair<double, Vec3>> normals;
  for (const ClosedObject* solid : {&a, &b}) {
    const std::size_t stride = solid->triangles().size() / 256 + 1;
    for (std::size_t k = 0; k < solid->triangles().size(); k += stride) {
      const ClosedObject::Corners& t = solid->triangles()[k];
      const Vec3 n = (t[1] - t[0]).cross(t[2] - t[0]);
      // Squares of shorter normals may be subnormal.
      if (const double length = n.norm(); length > 0x1p-500)
        normals.emplace_back(length, n / length);
    }
  }
  const auto best = [&](const auto& allowed, Vec3 out) {
    double most = 0;
    for (const auto& [weight, n] : normals) {
      if (!allowed(n)) continue;
      double sum = 0;
      for (const auto& [other, m] : normals) sum += std::abs(n.dot(m)) > 1 - 1e-9 ? other : 0;
      if (sum > most) most = sum, out = n;
    }
    return out;
  };
  const Vec3 x = best([](const Vec3&) { return true; }, Vec3::UnitX());
  Vec3 y = best([&](const Vec3& n) { return std::abs(n.dot(x)) < 1e-9; }, x.unitOrthogonal());
  y = (y - y.dot(x) * x).normalized();
  return {x, y, x.cross(y).normalized()};
}

class Search {
 public:
  Search(const ClosedObject& a, const ClosedObject& b, std::vector<Cover> covers,
         std::array<Vec3, 3> axes, Penetration& out)
      : a_(a), b_(b), covers_(std::move(covers)), axes_(axes), out_(out) {
    const double triangles = double(a.triangles().size() + b.triangles().size());
    failures_ = triangles < 1000 ? 64 : 16;
    room_ =
        4 * kCoreInward * ((a.box().hi - a.box().lo).norm() + (b.box().hi - b.box().lo).norm()) +
        64 * kU * (a.largest() + b.largest());
  }

  /// Lowers the upper bound if the translation, made a little longer, separates the objects.
  bool try_translation(const Vec3& t) {
    if (failures_ == 0 || !t.allFinite()) return false;
    const double length = t.norm();
    const Vec3 longer = t * (1 + 64 * kU + room_ / length);
    const double hi = longer.norm() * (1 + 8 * kU);
    if (!(hi < out_.hi)) return false;
    if (!separates(a_, b_, longer)) {
      --failures_;
      return false;
    }
    out_.hi = hi;
    out_.translation = longer;
    return true;
  }

  /// Divides the ball of translations shorter than the upper bound into parts, the nearest part
  /// first. The lower bound rises to the distance of the nearest part that is not settled.
  void search() {
    constexpr double kWork = 2e6;  // about this many sides of covers are examined
    constexpr double kClose = 0.98;
    std::priority_queue<Part, std::vector<Part>, std::greater<>> parts;
    parts.push({0, Vec3::Zero(), Vec3::Constant(out_.hi * (1 + 1e-9))});
    const double least = 1e-7 * out_.hi;
    while (!parts.empty()) {
      const Part part = parts.top();
      // Rounding makes the axes not exactly perpendicular. The factor covers this.
      out_.lo = std::max(out_.lo, std::min(part.distance * (1 - 1e-12), out_.hi));
      if (out_.lo >= kClose * out_.hi || work_ > kWork) return;
      parts.pop();
      const int axis = axis_to_divide(part);
      if (axis < 0) continue;
      if (part.half[axis] < least) return;
      const Vec3 middle = point_at(part.middle);
      if (middle.norm() < 0.97 * out_.hi && none_holds(middle) && try_translation(middle))
        try_translation(middle.normalized() * held_along(covers_, middle.normalized()));
      for (const double sign : {-1.0, 1.0}) {
        Part child = part;
        child.half[axis] /= 2;
        child.middle[axis] += sign * child.half[axis];
        child.distance = (child.middle.cwiseAbs() - child.half).cwiseMax(0).norm();
        if (child.distance < out_.hi) parts.push(child);
      }
    }
    out_.lo = out_.hi * (1 - 1e-11);  // all parts are settled
  }

 private:
  struct Part {
    double distance;    // distance from the origin to the nearest point of the part
    Vec3 middle, half;  // middle and half lengths of the part's box
    bool operator>(const Part& other) const { return distance > other.distance; }
  };

  Vec3 point_at(const Vec3& p) const { return p[0] * axes_[0] + p[1] * axes_[1] + p[2] * axes_[2]; }

  bool none_holds(const Vec3& t) {
    return std::ranges::none_of(covers_, [&](const Cover& cover) {
      return std::ranges::all_of(cover.sides, [&](const Cover::Side& side) {
        ++work_;
        return side.normal.dot(t) < side.distance;
      });
    });
  }

  /// Returns -1 if a cover contains the whole part. Otherwise chooses the cover beyond which the
  /// part extends least, and returns the axis to divide so that this excess shrinks most.
  int axis_to_divide(const Part& part) {
    const Vec3 middle = point_at(part.middle);
    const double reach = middle.cwiseAbs().maxCoeff() + part.half.sum();
    double least = kInf;
    const Cover::Side* of_least = nullptr;
    for (const Cover& cover : covers_) {
      double most = -kInf;
      const Cover::Side* at = nullptr;
      for (const Cover::Side& side : cover.sides) {
        ++work_;
        const double above = side.normal.dot(middle) + side.support.dot(part.half) - side.distance +
                             side.error * (reach + cover.largest);
        if (above > most) most = above, at = &side;
        if (most >= least) break;
      }
      if (most < 0) return -1;
      if (most < least) least = most, of_least = at;
    }
    int axis = 0;
    part.half.maxCoeff(&axis);
    if (!of_least) return axis;
    int best = 0;
    of_least->support.cwiseProduct(part.half).maxCoeff(&best);
    return part.half[best] > part.half[axis] / 4096 ? best : axis;
  }

  const ClosedObject &a_, &b_;
  std::vector<Cover> covers_;
  std::array<Vec3, 3> axes_;
  Penetration& out_;
  int failures_;     // this many failed translations are still allowed
  double room_ = 0;  // added to lengths of translations, for roundings and shrunk cores
  double work_ = 0;
};

/// Finds the first upper bound: a translation that moves the convex hulls of all corners apart.
void bound_by_hulls(const ClosedObject& a, const ClosedObject& b, Penetration& out) {
  Polytope hull(a.corners(), b.corners(), 1e-14);
  hull.expand(200, false);
  const Vec3 direction = hull.direction().normalized();
  const double length = std::max(hull.overlap(), 0.0);
  const double magnitude = a.largest() + b.largest() + length;
  out.hi = kInf;
  for (int k = 0; k < 60; ++k) {
    const double more = 1e-12 * length + std::ldexp(64 * kU, k) * magnitude;
    out.translation = (length + more) * direction;
    if (!separates(a, b, out.translation)) continue;
    out.hi = out.translation.stableNorm() * (1 + 8 * kU);
    return;
  }
}

/// Tries translations of the length limit.most along limit.ways, forwards and backwards. If a
/// translation separates the objects, stores it in `out` and tries a quarter of its length. Ends
/// when out.hi <= limit.most.
void bound_by_ways(const ClosedObject& a, const ClosedObject& b, const DepthLimit& limit,
                   Penetration& out) {
  for (const Vec3& way : limit.ways) {
    for (const double sign : {1.0, -1.0}) {
      for (double length = limit.most * (1 - 32 * kU);; length /= 4) {
        const Vec3 t = sign * length * way;
        const double hi = t.stableNorm() * (1 + 8 * kU);
        if (!(hi < out.hi && separates(a, b, t))) break;
        out.hi = hi;
        out.translation = t;
      }
      if (out.hi <= limit.most) return;
    }
  }
}

/// Returns points inside both objects, those far from the surfaces first; then the starts.
Points deep_points(const ClosedObject& a, const ClosedObject& b, std::span<const Vec3> starts,
                   const Vec3& translation) {
  constexpr std::size_t kMost = 6, kStarts = 8;
  struct Deep {
    Vec3 point, nearest;
    double distance() const { return (point - nearest).norm(); }
  };
  const auto deep = [&](const Vec3& p) {
    const Deep of_a{p, a.nearest(p)}, of_b{p, b.nearest(p)};
    return of_a.distance() < of_b.distance() ? of_a : of_b;
  };
  Vec3 middle = Vec3::Zero();
  for (const Vec3& p : starts) middle += p / double(starts.size());
  std::vector<Deep> found;
  for (std::size_t k = 0; k < starts.size(); k += starts.size() / kStarts + 1) {
    for (const double part : {-0.5, -0.25, -0.05, 0.05, 0.25, 0.5}) {
      // The point is also moved towards the middle, since a common point of the surfaces that is
      // moved along the translation alone may stay on one surface.
      const Vec3 p = starts[k] + part * translation + std::abs(part) * (middle - starts[k]);
      if (a.has(p) && b.has(p)) found.push_back(deep(p));
    }
  }
  std::ranges::sort(found, std::greater(), &Deep::distance);
  const std::size_t most = std::min(found.size(), kMost);
  for (std::size_t k = 0; k < most; ++k) {
    Deep& d = found[k];
    // A step away from the nearest surface point cannot leave the object if the step is shorter
    // than the distance to the surface.
    for (int step = 0; step < 20; ++step) {
      const Deep next = deep(d.point + (step % 2 == 0 ? 0.8 : 0.2) * (d.point - d.nearest));
      if (next.distance() > d.distance()) d = next;
    }
  }
  std::ranges::sort(found, std::greater(), &Deep::distance);
  Points out;
  for (const Deep& d : found) out.push_back(d.point);
  out.insert(out.end(), starts.begin(), starts.end());
  return out;
}

}  // namespace

// True if products of four lengths are normal numbers, for lengths down to 2^-50 of the object's
// extent. Normals of length 1 come from roots of such products (squared cross products). If false,
// no lower bound of the depth is computed.
bool has_normal_products(const ClosedObject& solid) {
  const Vec3 extent = solid.box().hi - solid.box().lo;
  return extent.maxCoeff() > 0x1p-200 && solid.largest() < 0x1p200;
}

Penetration penetration(const ClosedObject& a, const ClosedObject& b, std::span<const Vec3> starts,
                        unsigned threads, const std::optional<DepthLimit>& limit) {
  // These are limits of the work. Larger objects get fewer cores, so that the search takes about as
  // long as finding the pairs of triangles that meet.
  const bool small = a.triangles().size() + b.triangles().size() < 1000;
  const std::size_t most_cores = small ? 48 : 10, most_pairs = small ? 256 : 64;
  const int steps = small ? 200 : 60;
  const FloatingPointGuard guard;
  Penetration out;
  bound_by_hulls(a, b, out);
  if (limit && out.hi <= limit->most) return out;
  const Points seeds = out.hi < kInf ? deep_points(a, b, starts, out.translation) : Points();
  if (limit) {
    // A point inside both objects that is farther than `most` from both surfaces stays a common
    // point after each translation by at most `most`. Then trying translations is useless.
    const auto deeper = [&](const ClosedObject& solid, const Vec3& p) {
      return solid.has(p) && (solid.nearest(p) - p).norm() > limit->most;
    };
    if (!seeds.empty() && deeper(a, seeds[0]) && deeper(b, seeds[0])) return out;
    bound_by_ways(a, b, *limit, out);
    if (out.hi <= limit->most) return out;
  }
  if (!(out.hi < kInf) || !has_normal_products(a) || !has_normal_products(b)) return out;
  std::array<std::vector<Points>, 2> cores;
  for_each_shared(2, threads, [&](std::size_t side) {
    const ClosedObject &own = side == 0 ? a : b, &other = side == 0 ? b : a;
    const Vec3 grown = Vec3::Constant(out.hi), own_grown = Vec3::Constant(0.01 * out.hi);
    cores[side] = cores_of(own,
                           {(own.box().lo - own_grown).cwiseMax(other.box().lo - grown),
                            (own.box().hi + own_grown).cwiseMin(other.box().hi + grown)},
                           seeds, most_cores);
  });
  while (cores[0].size() * cores[1].size() > most_pairs)
    cores[cores[0].size() < cores[1].size() ? 1 : 0].pop_back();
  const std::array<Vec3, 3> axes = axes_of(a, b);
  const std::size_t of_b = cores[1].size();
  std::vector<Cover> covers(cores[0].size() * of_b);
  for_each_shared(covers.size(), threads, [&](std::size_t k) {
    for (const double flat : {1e-14, 1e-12, 1e-10, 1e-8}) {
      Polytope difference(cores[0][k / of_b], cores[1][k % of_b], flat);
      difference.expand(steps, true);
      covers[k] = cover_of(difference, axes);
      const auto certain = [](const Cover::Side& side) { return side.error < 1e-10; };
      if (!covers[k].sides.empty() && difference.convex() &&
          std::ranges::all_of(covers[k].sides, certain))
        break;
    }
  });
  std::erase_if(covers, [&](const Cover& cover) {
    return cover.sides.empty() || std::ranges::any_of(cover.sides, [&](const Cover::Side& side) {
             return side.distance < -out.hi;
           });
  });
  for (const Cover& cover : covers) {
    double least = out.hi;
    for (const Cover::Side& side : cover.sides) {
      // Every translation shorter than `least` is below this plane.
      least = std::min(least, side.distance - side.error * (cover.largest + out.hi));
    }
    out.lo = std::max(out.lo, least);
  }
  if (covers.empty() || out.lo * 1.001 >= out.hi) return out;
  if (limit && out.lo > limit->most) return out;
  // With a limit, only translations shorter than `most` matter, so only these are searched.
  Penetration found = out;
  if (limit) found.hi = limit->most;
  Search search(a, b, std::move(covers), axes, found);
  search.search();
  return limit && found.hi == limit->most ? Penetration{found.lo, out.hi, out.translation} : found;
}

}  // namespace farcull
