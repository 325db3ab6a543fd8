// The truth about distances in scenes of full size, in integers and rational numbers alone. It
// shares nothing with core/proximity and verify.
//
// Every pair of triangles is compared, or left out by a proof in integers. All coordinates are
// rounded outwards to a grid, and each triangle, and each group of triangles, has a box of grid
// cells. Two boxes whose gap is longer than the distance of some pair hold no nearest pair. Of
// pairs that are left, the projections of both triangles onto some direction may be farther apart
// than that, which is decided in cells as well. For the rest the distance is computed, as a
// quotient of integers of any length (tests/core/proximity/near_lab.h).
// tests/experiments/method/distances_test.cpp compares all this with code that leaves out
// nothing but triangles with boxes too far apart.
#pragma once

#include "tests/lab/distances.h"

namespace farcull::distance_truth {

using distance_lab::Corners, distance_lab::Q, distance_lab::Z;
using Squared = near_lab::Fraction<Z>;  // of a distance, times the square of the scale
using Cell = std::int64_t;
using near_lab::Integer;

/// A box of grid cells that contains triangles.
struct CellBox {
  std::array<Cell, 3> lo, hi;

  void add(const CellBox& other) {
    for (std::size_t k = 0; k < 3; ++k) {
      lo[k] = std::min(lo[k], other.lo[k]);
      hi[k] = std::max(hi[k], other.hi[k]);
    }
  }
};

/// The square of the gap of two boxes: no two points of them are nearer.
inline Integer least_square(const CellBox& a, const CellBox& b) {
  Integer out = 0;
  for (std::size_t k = 0; k < 3; ++k) {
    const Integer gap = std::max({a.lo[k] - b.hi[k], b.lo[k] - a.hi[k], Cell{0}});
    out += gap * gap;
  }
  return out;
}
struct Nearest {
  ObjectPair objects;
  Q squared;
  /// All pairs at that distance, sorted; where objects meet, the first one alone.
  std::vector<TrianglePair> pairs;
};

class Truth {
 public:
  explicit Truth(const Scene& scene)
      : scene_(scene), owner_(owners(scene)), scale_(distance_lab::scale_of(scene.vertices)) {
    // Cells: coordinates times 2^shift_ are below 2^38, so that squares of distances are below
    // 2^80.
    double most = 0;
    for (const Vec3& p : scene.vertices) {
      most = std::max(most, p.cwiseAbs().maxCoeff());
      near_lab::Triple<Z> x;
      for (int k = 0; k < 3; ++k) x[static_cast<std::size_t>(k)] = Z(Q(Q(p[k]) * scale_));
      points_.push_back(std::move(x));
    }
    if (most > 0) shift_ = 37 - std::ilogb(most);
    for (const Vec3& p : scene.vertices) {
      std::array<Cell, 3> cell{};
      for (std::size_t k = 0; k < 3; ++k)
        cell[k] =
            static_cast<Cell>(std::floor(std::ldexp(p[static_cast<Eigen::Index>(k)], shift_)));
      cells_.push_back(cell);
    }
    for (std::uint32_t t = 0; t < scene.triangles.size(); ++t) boxes_.push_back(cells_of(t));
    std::vector<std::uint32_t> roots;
    for (std::uint32_t o = 0; o < scene.objects.size(); ++o) {
      std::vector<std::uint32_t> triangles(scene.objects[o].triangle_count);
      for (std::uint32_t k = 0; k < triangles.size(); ++k)
        triangles[k] = scene.objects[o].first_triangle + k;
      root_.push_back(triangles.empty() ? kNone : group(std::move(triangles), o));
      if (root_.back() != kNone) roots.push_back(root_.back());
    }
    all_ = roots.empty() ? kNone : group_of_groups(std::move(roots));
  }

  /// Of two objects, or of one and itself: its triangles that share no vertex position.
  std::optional<Nearest> nearest(const ObjectPair& objects) {
    const std::optional<Squared> least = least_of(objects.a, root_[objects.b], objects.a);
    if (!least) return std::nullopt;
    return Nearest{objects, value(*least), pairs_at(objects, *least)};
  }

  /// Of each object with triangles and all others; of others as near the first one.
  std::vector<Nearest> nearest_of_each() {
    std::vector<Nearest> out;
    const auto count = static_cast<std::uint32_t>(scene_.objects.size());
    for (std::uint32_t a = 0; a < count; ++a) {
      if (root_[a] == kNone) continue;
      const std::optional<Squared> least = least_of(a, all_, kNone);
      if (!least) continue;
      const Integer limit = cells_of(*least);
      for (std::uint32_t b = 0; b < count; ++b) {
        if (b == a || root_[b] == kNone ||
            least_square(nodes_[root_[a]].box, nodes_[root_[b]].box) > limit)
          continue;
        const ObjectPair objects = {std::min(a, b), std::max(a, b)};
        std::vector<TrianglePair> pairs = pairs_at(objects, *least);
        if (pairs.empty()) continue;
        out.push_back({{a, b}, value(*least), std::move(pairs)});
        break;
      }
    }
    return out;
  }

  /// Pairs of triangles whose distances were computed.
  std::uint64_t computed() const { return computed_; }

 private:
  static constexpr std::uint32_t kNone = UINT32_MAX;
  /// Two nodes below, or a triangle. object: of all its triangles, or none.
  struct Node {
    CellBox box;
    std::uint32_t left = kNone, right = kNone;
    std::uint32_t triangle = kNone, object = kNone;
  };

  // A power of two changes no digit, except far below 1: so a point lies in its cell or beside it,
  // less than two from the cell's lower corner.
  CellBox cells_of(std::uint32_t triangle) const {
    CellBox out;
    out.lo.fill(INT64_MAX);
    out.hi.fill(INT64_MIN);
    for (const std::uint32_t v : scene_.triangles[triangle]) {
      for (std::size_t k = 0; k < 3; ++k) {
        out.lo[k] = std::min(out.lo[k], cells_[v][k] - 1);
        out.hi[k] = std::max(out.hi[k], cells_[v][k] + 2);
      }
    }
    return out;
  }
  /// In square cells, rounded up.
  Integer cells_of(const Squared& squared) const {
    Q cells = value(squared);
    if (shift_ > 0) cells <<= static_cast<unsigned long>(2 * shift_);
    if (shift_ < 0) cells >>= static_cast<unsigned long>(-2 * shift_);
    const Z up = cells.get_num() / cells.get_den() + 1;
    const Z high = up >> 60, low = up - (high << 60);
    return (Integer{high.get_si()} << 60) + low.get_si();
  }
  Q value(const Squared& squared) const {
    Q out(squared.numerator, Z(squared.denominator * scale_ * scale_));
    out.canonicalize();
    return out;
  }

  // Halves along the longest side of their middles' box.
  std::uint32_t group(std::vector<std::uint32_t> triangles, std::uint32_t object) {
    Node node{.box = boxes_[triangles[0]], .object = object};
    for (const std::uint32_t t : triangles) node.box.add(boxes_[t]);
    if (triangles.size() == 1) {
      node.triangle = triangles[0];
    } else {
      const auto half = divide(triangles, [&](std::uint32_t t) { return boxes_[t]; });
      node.left = group({triangles.begin(), half}, object);
      node.right = group({half, triangles.end()}, object);
    }
    nodes_.push_back(node);
    return static_cast<std::uint32_t>(nodes_.size() - 1);
  }
  std::uint32_t group_of_groups(std::vector<std::uint32_t> groups) {
    if (groups.size() == 1) return groups[0];
    const auto half = divide(groups, [&](std::uint32_t n) { return nodes_[n].box; });
    Node node;
    node.left = group_of_groups({groups.begin(), half});
    node.right = group_of_groups({half, groups.end()});
    node.box = nodes_[node.left].box;
    node.box.add(nodes_[node.right].box);
    nodes_.push_back(node);
    return static_cast<std::uint32_t>(nodes_.size() - 1);
  }
  template <class BoxOf>
  static std::vector<std::uint32_t>::iterator divide(std::vector<std::uint32_t>& items,
                                                     const BoxOf& box_of) {
    const auto middle = [&](std::uint32_t item, std::size_t k) {
      const CellBox box = box_of(item);
      return box.lo[k] + box.hi[k];
    };
    std::size_t axis = 0;
    Cell longest = -1;
    for (std::size_t k = 0; k < 3; ++k) {
      Cell lo = INT64_MAX, hi = INT64_MIN;
      for (const std::uint32_t item : items) {
        lo = std::min(lo, middle(item, k));
        hi = std::max(hi, middle(item, k));
      }
      if (hi - lo <= longest) continue;
      longest = hi - lo;
      axis = k;
    }
    const auto half = items.begin() + static_cast<std::ptrdiff_t>(items.size() / 2);
    std::nth_element(items.begin(), half, items.end(), [&](std::uint32_t x, std::uint32_t y) {
      return middle(x, axis) < middle(y, axis);
    });
    return half;
  }

  // Two different triangles; of one object those that share no vertex position.
  bool counts(std::uint32_t i, std::uint32_t j) const {
    if (i == j) return false;
    if (owner_[i] != owner_[j]) return true;
    const auto x = scene_.corners(i), y = scene_.corners(j);
    return std::ranges::none_of(x,
                                [&](const Vec3& p) { return std::ranges::find(y, p) != y.end(); });
  }

  // visit(j) for triangles below the node whose boxes are no farther than limit(); what belongs to
  // i's object is left out unless it is `self`. The nearer half comes first.
  template <class Limit, class Visit>
  void walk(std::uint32_t i, std::uint32_t node, std::uint32_t self, const Limit& limit,
            const Visit& visit) const {
    const Node& at = nodes_[node];
    if (at.object != self && at.object == owner_[i]) return;
    if (at.triangle != kNone) {
      if (counts(i, at.triangle)) visit(at.triangle);
      return;
    }
    std::array<std::uint32_t, 2> below = {at.left, at.right};
    std::array<Integer, 2> square = {least_square(boxes_[i], nodes_[below[0]].box),
                                     least_square(boxes_[i], nodes_[below[1]].box)};
    if (square[1] < square[0]) {
      std::swap(square[0], square[1]);
      std::swap(below[0], below[1]);
    }
    for (std::size_t k = 0; k < 2; ++k)
      if (square[k] <= limit()) walk(i, below[k], self, limit, visit);
  }

  // The least squared distance of an object's triangles to those below the node.
  std::optional<Squared> least_of(std::uint32_t object, std::uint32_t node, std::uint32_t self) {
    if (node == kNone || root_[object] == kNone) return std::nullopt;
    // First an upper bound, in cells: what can be nearest is no farther than any two corners.
    constexpr Integer kFar = Integer{1} << 120;
    const Object& of = scene_.objects[object];
    Integer limit = kFar;
    std::vector<std::pair<Integer, std::uint32_t>> order;
    for (std::uint32_t i = of.first_triangle; i < of.first_triangle + of.triangle_count; ++i) {
      Integer own = kFar;
      walk(
          i, node, self, [&] { return limit; },
          [&](std::uint32_t j) {
            const Integer most = most_square(i, j);
            own = std::min(own, most);
            limit = std::min(limit, most);
          });
      if (own < kFar) order.emplace_back(own, i);
    }
    // Then the triangles that the bound leaves, the most promising first.
    std::ranges::sort(order);
    std::optional<Squared> least;
    for (const auto& [own, i] : order) {
      walk(
          i, node, self, [&] { return limit; },
          [&](std::uint32_t j) {
            if (least && least->numerator == 0) return;
            if (farther(i, j, limit)) return;
            Squared squared = squared_distance(i, j);
            if (least && !(squared < *least)) return;
            least = std::move(squared);
            limit = std::min(limit, cells_of(*least));
          });
      if (least && least->numerator == 0) break;
    }
    return least;
  }

  // All pairs of two objects at this distance; where it is 0 the first one.
  std::vector<TrianglePair> pairs_at(const ObjectPair& objects, const Squared& squared) {
    const Integer limit = cells_of(squared);
    std::vector<TrianglePair> out;
    const Object& of = scene_.objects[objects.a];
    for (std::uint32_t i = of.first_triangle; i < of.first_triangle + of.triangle_count; ++i) {
      std::vector<std::uint32_t> others;
      walk(
          i, root_[objects.b], objects.a, [&] { return limit; },
          [&](std::uint32_t j) {
            if (objects.a != objects.b || i < j) others.push_back(j);
          });
      std::ranges::sort(others);
      for (const std::uint32_t j : others) {
        if (farther(i, j, limit)) continue;
        if (!(squared_distance(i, j) == squared)) continue;
        out.push_back({i, j});
        if (squared.numerator == 0) return out;
      }
    }
    return out;
  }

  Corners corners(std::uint32_t t) const {
    const auto& v = scene_.triangles[t];
    return {points_[v[0]], points_[v[1]], points_[v[2]]};
  }
  Squared squared_distance(std::uint32_t i, std::uint32_t j) {
    ++computed_;
    return near_lab::squared_distance(corners(i), corners(j));
  }
  // Two corners are no farther apart than this, in square cells, rounded up.
  Integer most_square(std::uint32_t i, std::uint32_t j) const {
    Integer out = Integer{1} << 120;
    for (const std::uint32_t v : scene_.triangles[i]) {
      for (const std::uint32_t w : scene_.triangles[j]) {
        Integer squared = 0;
        for (std::size_t k = 0; k < 3; ++k) {
          const Integer length = std::abs(cells_[v][k] - cells_[w][k]) + 3;
          squared += length * length;
        }
        out = std::min(out, squared);
      }
    }
    return out;
  }
  // Proves that the pair is farther than the limit, in square cells: the gap of the projections
  // onto a direction is. Any direction proves it. The one with the largest gap is chosen in
  // doubles, and rounded to integers up to 2^20.
  bool farther(std::uint32_t i, std::uint32_t j, Integer limit) const {
    if (limit >= Integer{1} << 80) return false;
    // Relative to a corner, so that doubles are exact.
    const std::array<Cell, 3>& origin = cells_[scene_.triangles[i][0]];
    const auto converted = [&]<class T>(std::uint32_t t, T) {
      near_lab::Corners<T> out;
      for (std::size_t corner = 0; corner < 3; ++corner)
        for (std::size_t k = 0; k < 3; ++k)
          out[corner][k] = static_cast<T>(cells_[scene_.triangles[t][corner]][k] - origin[k]);
      return out;
    };
    const auto a = converted(i, 0.0), b = converted(j, 0.0);
    near_lab::Triple<double> best{};
    double largest = 0;
    reference::any_direction(a, b, [&](const near_lab::Triple<double>& d) {
      const double gap = reference::gap(a, b, d), squared = near_lab::dot(d, d);
      if (gap > 0 && gap * gap > largest * squared) {
        largest = gap * gap / squared;
        best = d;
      }
      return false;
    });
    if (!(largest > static_cast<double>(limit))) return false;
    const double most = std::max({std::abs(best[0]), std::abs(best[1]), std::abs(best[2])});
    near_lab::Triple<Integer> d;
    for (std::size_t k = 0; k < 3; ++k) d[k] = std::llround(best[k] / most * 0x1p20);
    // Each of the two points is less than two cells from its cell's lower corner.
    Integer gap = reference::gap(converted(i, Integer{}), converted(j, Integer{}), d);
    for (const Integer x : d) gap -= 4 * (x < 0 ? -x : x);
    // Below 2^63, so the square is below 2^126.
    return gap > 0 && gap * gap > limit * near_lab::dot(d, d);
  }

  const Scene& scene_;
  std::vector<std::uint32_t> owner_;
  Z scale_;                                  // of all coordinates: they are integers then
  std::vector<near_lab::Triple<Z>> points_;  // of vertices, times the scale
  int shift_ = 0;
  std::vector<std::array<Cell, 3>> cells_;  // of vertices
  std::vector<CellBox> boxes_;              // of triangles
  std::vector<Node> nodes_;
  std::vector<std::uint32_t> root_;  // of each object
  std::uint32_t all_ = kNone;
  std::uint64_t computed_ = 0;
};

}  // namespace farcull::distance_truth
