// Divides at the middle one of the centres along the axis in which they spread most.
#include "verify/certificate/bounds_tree.h"

#include <algorithm>
#include <numeric>

namespace farcull {

BoundsTree::BoundsTree(const Scene& scene) {
  const auto count = static_cast<std::uint32_t>(scene.triangles.size());
  bounds.reserve(count);
  for (std::uint32_t t = 0; t < count; ++t) {
    const std::array<Vec3, 3> p = scene.corners(t);
    Bounds box;
    for (int k = 0; k < 3; ++k) {
      box.lo[k] = std::min({p[0][k], p[1][k], p[2][k]});
      box.hi[k] = std::max({p[0][k], p[1][k], p[2][k]});
    }
    bounds.push_back(box);
  }
  order.resize(count);
  std::iota(order.begin(), order.end(), 0u);
}

// The places where the tree divides change only the time of a query, not its answer: a query looks
// below every node whose box it meets.
void BoundsTree::add(std::uint32_t first, std::uint32_t count) {
  constexpr std::uint32_t kLeaf = 4;
  const auto from = order.begin() + first;
  const auto to = from + count;
  Node node{.bounds = bounds[*from], .first = first, .count = count};
  Bounds centres;  // of the boxes, halved before they are added, since a sum may overflow
  for (int k = 0; k < 3; ++k) {
    const auto centre = [&](std::uint32_t t) { return bounds[t].lo[k] / 2 + bounds[t].hi[k] / 2; };
    centres.lo[k] = centres.hi[k] = centre(*from);
    for (auto t = from; t != to; ++t) {
      node.bounds.lo[k] = std::min(node.bounds.lo[k], bounds[*t].lo[k]);
      node.bounds.hi[k] = std::max(node.bounds.hi[k], bounds[*t].hi[k]);
      centres.lo[k] = std::min(centres.lo[k], centre(*t));
      centres.hi[k] = std::max(centres.hi[k], centre(*t));
    }
  }
  node.last_triangle = *std::max_element(from, to);
  const std::size_t index = nodes.size();
  nodes.push_back(node);
  if (count > kLeaf) {
    int widest = 0;
    const auto spread = [&](int k) { return centres.hi[k] / 2 - centres.lo[k] / 2; };
    for (int k = 1; k < 3; ++k) {
      if (spread(k) > spread(widest)) widest = k;
    }
    const auto centre = [&](std::uint32_t t) {
      return bounds[t].lo[widest] / 2 + bounds[t].hi[widest] / 2;
    };
    std::nth_element(from, from + count / 2, to,
                     [&](std::uint32_t s, std::uint32_t t) { return centre(s) < centre(t); });
    add(first, count / 2);
    add(first + count / 2, count - count / 2);
  }
  nodes[index].after = static_cast<std::uint32_t>(nodes.size());
}

}  // namespace farcull
