// Collects the faces of a mesh. Polygons are cut into triangles by ear clipping.
#include "experiments/scenes/mesh/builder.h"

#include <fmt/format.h>

#include <cmath>
#include <limits>
#include <utility>

#include "core/base/error.h"
#include "experiments/scenes/mesh/text.h"

namespace farcull {
namespace {

constexpr std::uint64_t kMaxCount = std::numeric_limits<std::uint32_t>::max();
constexpr std::size_t kMaxEarCorners = 8192;
constexpr const char* kCorrectIndex = "correct the index, or see whether the file is damaged";

using Point = Eigen::Vector2d;

// Twice the signed area of a triangle: positive for a left turn at b.
double turn(const Point& a, const Point& b, const Point& c) {
  return (b.x() - a.x()) * (c.y() - a.y()) - (b.y() - a.y()) * (c.x() - a.x());
}

// The corners in units of their largest coordinate, a power of two, so that no product below
// overflows or vanishes.
std::vector<Vec3> normalized(std::span<const Vec3> corners) {
  std::vector<Vec3> points(corners.begin(), corners.end());
  const auto rescale = [&points] {
    double largest = 0;
    for (const Vec3& p : points) largest = std::max(largest, p.cwiseAbs().maxCoeff());
    if (largest == 0) return;
    const int exponent = std::ilogb(largest) + 2;
    for (Vec3& p : points) {
      for (double& x : p) x = std::ldexp(x, -exponent);
    }
  };
  rescale();
  const Vec3 first = points.front();
  for (Vec3& p : points) p -= first;
  rescale();
  return points;
}

// The polygon seen along the axis closest to its normal, counterclockwise (Newell's normal).
std::vector<Point> projected(std::span<const Vec3> corners) {
  const std::vector<Vec3> points = normalized(corners);
  Vec3 normal = Vec3::Zero();
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Vec3& a = points[i];
    const Vec3& b = points[i + 1 == points.size() ? 0 : i + 1];
    normal += Vec3(a.y() * b.z() - a.z() * b.y(), a.z() * b.x() - a.x() * b.z(),
                   a.x() * b.y() - a.y() * b.x());
  }
  int axis = 0;
  normal.cwiseAbs().maxCoeff(&axis);
  int u = (axis + 1) % 3;
  int v = (axis + 2) % 3;
  if (normal[axis] < 0) std::swap(u, v);
  std::vector<Point> plane;
  plane.reserve(points.size());
  for (const Vec3& p : points) plane.emplace_back(p[u], p[v]);
  return plane;
}

// The rest of a polygon while its ears are cut off: a ring linked through next and previous.
struct Ring {
  explicit Ring(std::span<const Point> points)
      : at(points), next(size()), previous(size()), reflex(size()) {
    for (std::uint32_t i = 0; i < size(); ++i) {
      next[i] = i + 1 == size() ? 0 : i + 1;
      previous[i] = i == 0 ? size() - 1 : i - 1;
    }
    for (std::uint32_t i = 0; i < size(); ++i) classify(i);
  }

  std::uint32_t size() const { return static_cast<std::uint32_t>(at.size()); }
  double turn_at(std::uint32_t i) const { return turn(at[previous[i]], at[i], at[next[i]]); }
  void classify(std::uint32_t i) { reflex[i] = turn_at(i) < 0; }

  // A convex corner whose triangle holds no reflex corner (only those can reach into it). Corners
  // at the position of one of the three do not count: they are the seam of a polygon with a hole.
  bool is_ear(std::uint32_t i, std::uint64_t& steps) const {
    if (!(turn_at(i) > 0)) return false;
    const Point& a = at[previous[i]];
    const Point& b = at[i];
    const Point& c = at[next[i]];
    for (std::uint32_t k = next[next[i]]; k != previous[i]; k = next[k]) {
      ++steps;
      const Point& p = at[k];
      if (!reflex[k] || p == a || p == b || p == c) continue;
      if (turn(a, b, p) >= 0 && turn(b, c, p) >= 0 && turn(c, a, p) >= 0) return false;
    }
    return true;
  }

  void cut(std::uint32_t i) {
    next[previous[i]] = next[i];
    previous[next[i]] = previous[i];
    classify(previous[i]);
    classify(next[i]);
  }

  std::span<const Point> at;
  std::vector<std::uint32_t> next;
  std::vector<std::uint32_t> previous;
  std::vector<char> reflex;
};

}  // namespace

bool triangulate(std::span<const Vec3> corners,
                 std::vector<std::array<std::uint32_t, 3>>& triangles) {
  if (corners.size() == 3) {
    triangles.push_back({0, 1, 2});
    return true;
  }
  const std::vector<Point> points = projected(corners);
  Ring ring(points);
  const std::uint32_t n = ring.size();

  bool convex = true;
  for (const char reflex : ring.reflex) convex = convex && !reflex;
  if (!convex && n > kMaxEarCorners) return false;

  const std::uint64_t max_steps = 16 * std::uint64_t{n} * n;
  std::uint64_t steps = 0;
  std::uint32_t left = n;
  std::uint32_t i = 0;
  std::uint32_t refused = 0;
  while (!convex && left > 3 && refused < left) {
    if (steps > max_steps) return false;
    ++steps;
    if (ring.is_ear(i, steps)) {
      triangles.push_back({ring.previous[i], i, ring.next[i]});
      ring.cut(i);
      --left;
      refused = 0;
    } else {
      ++refused;
    }
    i = ring.next[i];
  }
  // The rest is convex or a triangle, or has no ear since it is degenerate or crosses itself: a
  // fan.
  for (std::uint32_t k = ring.next[i]; ring.next[k] != i; k = ring.next[k]) {
    triangles.push_back({i, k, ring.next[k]});
  }
  return true;
}

MeshBuilder::MeshBuilder(std::string name) : name_(std::move(name)) {}

void MeshBuilder::add_vertex(const Vec3& p, long line) {
  if (mesh_.vertices.size() == kMaxCount) {
    throw Error(name_, "more than 4294967295 vertices", "split the mesh", line);
  }
  mesh_.vertices.push_back(p);
}

void MeshBuilder::set_group(std::string_view group_name) {
  const std::string group = group_name.empty() ? "default" : clean_name(group_name);
  const auto [entry, is_new] =
      groups_.try_emplace(group, static_cast<std::uint32_t>(groups_.size()));
  if (is_new) mesh_.group_names.push_back(group);
  group_ = entry->second;
}

void MeshBuilder::add_face(std::span<const std::uint32_t> corners, long line) {
  if (corners.size() < 3) {
    throw Error(name_, fmt::format("face {} is a polygon with {} vertices", faces_, corners.size()),
                "give it 3 or more, or delete it", line);
  }
  std::vector<Vec3> points;
  points.reserve(corners.size());
  for (const std::uint32_t corner : corners) {
    if (corner >= mesh_.vertices.size()) {
      throw Error(name_,
                  fmt::format("face {} names vertex {} (counted from 0) of {}", faces_, corner,
                              mesh_.vertices.size()),
                  kCorrectIndex, line);
    }
    points.push_back(mesh_.vertices[corner]);
  }
  if (corners.size() - 2 > kMaxCount - mesh_.triangles.size()) {
    throw Error(name_, "more than 4294967295 triangles", "split the mesh", line);
  }
  if (mesh_.group_names.empty()) set_group("");

  std::vector<std::array<std::uint32_t, 3>> triangles;
  triangles.reserve(corners.size() - 2);
  if (!triangulate(points, triangles)) {
    throw Error(name_,
                fmt::format("face {} is a polygon with {} vertices that is not convex, too large "
                            "to triangulate here",
                            faces_, corners.size()),
                "triangulate the mesh where it was made", line);
  }
  for (const auto& [a, b, c] : triangles) {
    mesh_.triangles.push_back({corners[a], corners[b], corners[c]});
    mesh_.source_face.push_back(faces_);
    mesh_.group.push_back(group_);
  }
  ++faces_;
}

Mesh MeshBuilder::finish() {
  if (mesh_.triangles.empty()) {
    throw Error(name_, "the mesh has no triangles", "give a mesh with at least one face");
  }
  return std::move(mesh_);
}

}  // namespace farcull
