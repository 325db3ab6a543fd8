// Builds trees of boxes over triangles, and enumerates the pairs of triangles whose boxes meet.
#include "verify/certificate/box_pairs.h"

#include <algorithm>
#include <numeric>

namespace farcull {

BoundsTree::Bounds BoundsTree::bounds_of(const std::array<Vec3, 3>& corners) {
  Bounds out;
  for (int k = 0; k < 3; ++k) {
    out.lo[k] = std::min({corners[0][k], corners[1][k], corners[2][k]});
    out.hi[k] = std::max({corners[0][k], corners[1][k], corners[2][k]});
  }
  return out;
}

BoundsTree::BoundsTree(std::span<const std::array<Vec3, 3>> triangles) : order(triangles.size()) {
  for (const std::array<Vec3, 3>& t : triangles) bounds.push_back(bounds_of(t));
  std::iota(order.begin(), order.end(), 0u);
}

BoundsTree::BoundsTree(const Scene& scene) : order(scene.triangles.size()) {
  bounds.reserve(order.size());
  for (std::uint32_t t = 0; t < order.size(); ++t) bounds.push_back(bounds_of(scene.corners(t)));
  std::iota(order.begin(), order.end(), 0u);
}

// Divides at the median of the centres, along the axis in which the centres spread most. Other
// divisions would change only the time of a query, not its result: a query visits the children of
// every node whose box overlaps the query's box.
void BoundsTree::add(std::uint32_t first, std::uint32_t count) {
  constexpr std::uint32_t kLeaf = 4;
  const auto from = order.begin() + first;
  const auto to = from + count;
  Node node{.bounds = bounds[*from], .first = first, .count = count};
  Bounds centres;  // box of the centres; centre() halves first, since lo + hi may overflow
  const auto centre = [&](std::uint32_t t, int k) {
    return bounds[t].lo[k] / 2 + bounds[t].hi[k] / 2;
  };
  for (int k = 0; k < 3; ++k) {
    centres.lo[k] = centres.hi[k] = centre(*from, k);
    for (auto t = from; t != to; ++t) {
      node.bounds.lo[k] = std::min(node.bounds.lo[k], bounds[*t].lo[k]);
      node.bounds.hi[k] = std::max(node.bounds.hi[k], bounds[*t].hi[k]);
      centres.lo[k] = std::min(centres.lo[k], centre(*t, k));
      centres.hi[k] = std::max(centres.hi[k], centre(*t, k));
    }
  }
  const auto [least, last] = std::minmax_element(from, to);
  node.first_triangle = *least;
  node.last_triangle = *last;
  const std::size_t index = nodes.size();
  nodes.push_back(node);
  if (count > kLeaf) {
    int widest = 0;
    const auto spread = [&](int k) { return centres.hi[k] / 2 - centres.lo[k] / 2; };
    for (int k = 1; k < 3; ++k) {
      if (spread(k) > spread(widest)) widest = k;
    }
    std::ranges::nth_element(from, from + count / 2, to, {},
                             [&](std::uint32_t t) { return centre(t, widest); });
    add(first, count / 2);
    add(first + count / 2, count - count / 2);
  }
  nodes[index].after = static_cast<std::uint32_t>(nodes.size());
}

// ---- BoxPairs: one tree over all triangles, and one query of the tree per triangle ----

BoxPairs::BoxPairs(const Scene& scene, double clearance, const Tile& tile)
    : scene_(scene), clearance_(clearance), tile_(tile), tree_(scene) {
  const auto count = static_cast<std::uint32_t>(scene.triangles.size());
  if (count > 0) tree_.add(0, count);
}

// If x and y do not meet, no box inside x meets a box inside y: a gap between inner boxes is at
// least as large, and rounding is monotone.
bool BoxPairs::meet(const BoundsTree::Bounds& x, const BoundsTree::Bounds& y) const {
  for (int k = 0; k < 3; ++k) {
    if (clearance_ == 0) {
      if (x.hi[k] < y.lo[k] || y.hi[k] < x.lo[k]) return false;
    } else if (y.lo[k] - x.hi[k] > clearance_ || x.lo[k] - y.hi[k] > clearance_) {
      return false;
    }
  }
  return true;
}

bool BoxPairs::next(std::vector<TrianglePair>& pairs, std::size_t enough) {
  pairs.clear();
  for (; triangle_ < scene_.triangles.size() && pairs.size() < enough; ++triangle_) {
    const auto end_of = [&](std::uint32_t object) {
      return std::uint64_t{scene_.objects[object].first_triangle} +
             scene_.objects[object].triangle_count;
    };
    while (triangle_ >= end_of(object_)) ++object_;
    // Triangles are sorted by object. So the partners of triangle_ have indices >= `later`.
    const std::uint64_t later =
        scene_.objects[object_].self ? std::uint64_t{triangle_} + 1 : end_of(object_);
    const BoundsTree::Bounds& bounds = tree_.bounds[triangle_];
    const std::size_t before = pairs.size();
    for (std::uint32_t n = 0; n < tree_.nodes.size();) {
      const BoundsTree::Node& node = tree_.nodes[n];
      if (node.last_triangle < later || !meet(node.bounds, bounds)) {
        n = node.after;
        continue;
      }
      if (tree_.is_leaf(n)) {
        for (std::uint32_t i = node.first; i < node.first + node.count; ++i) {
          const std::uint32_t other = tree_.order[i];
          const BoundsTree::Bounds& its = tree_.bounds[other];
          if (other >= later && meet(its, bounds) &&
              owns(tile_, bounds.lo[tile_.axis], its.lo[tile_.axis]))
            pairs.push_back({triangle_, other});
        }
      }
      ++n;
    }
    std::sort(pairs.begin() + static_cast<std::ptrdiff_t>(before), pairs.end());
  }
  return !pairs.empty();
}

}  // namespace farcull
