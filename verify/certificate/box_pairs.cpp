// A tree of boxes over all triangles; each triangle asks it for later ones whose boxes it meets.
#include "verify/certificate/box_pairs.h"

#include <algorithm>
#include <numeric>

namespace farcull {

BoxPairs::BoxPairs(const Scene& scene, double clearance) : scene_(scene), clearance_(clearance) {
  const auto count = static_cast<std::uint32_t>(scene.triangles.size());
  bounds_.reserve(count);
  for (std::uint32_t t = 0; t < count; ++t) {
    const std::array<Vec3, 3> p = scene.corners(t);
    Bounds bounds;
    for (int k = 0; k < 3; ++k) {
      bounds.lo[k] = std::min({p[0][k], p[1][k], p[2][k]});
      bounds.hi[k] = std::max({p[0][k], p[1][k], p[2][k]});
    }
    bounds_.push_back(bounds);
  }
  order_.resize(count);
  std::iota(order_.begin(), order_.end(), 0u);
  if (count > 0) build(0, count);
}

// Rounding is monotone: no two boxes inside x and y have a smaller rounded difference.
bool BoxPairs::meet(const Bounds& x, const Bounds& y) const {
  for (int k = 0; k < 3; ++k) {
    if (clearance_ == 0) {
      if (x.hi[k] < y.lo[k] || y.hi[k] < x.lo[k]) return false;
    } else if (y.lo[k] - x.hi[k] > clearance_ || x.lo[k] - y.hi[k] > clearance_) {
      return false;
    }
  }
  return true;
}

// Where the tree divides decides how fast it answers, not what: every query looks below every node
// whose box it meets.
void BoxPairs::build(std::uint32_t first, std::uint32_t count) {
  constexpr std::uint32_t kLeaf = 4;
  const auto from = order_.begin() + first;
  const auto to = from + count;
  Node node{.bounds = bounds_[*from], .first = first, .count = count};
  Bounds centres;  // of the boxes, halved before they are added, since a sum may overflow
  for (int k = 0; k < 3; ++k) {
    const auto centre = [&](std::uint32_t t) {
      return bounds_[t].lo[k] / 2 + bounds_[t].hi[k] / 2;
    };
    centres.lo[k] = centres.hi[k] = centre(*from);
    for (auto t = from; t != to; ++t) {
      node.bounds.lo[k] = std::min(node.bounds.lo[k], bounds_[*t].lo[k]);
      node.bounds.hi[k] = std::max(node.bounds.hi[k], bounds_[*t].hi[k]);
      centres.lo[k] = std::min(centres.lo[k], centre(*t));
      centres.hi[k] = std::max(centres.hi[k], centre(*t));
    }
  }
  node.last_triangle = *std::max_element(from, to);
  const std::size_t index = nodes_.size();
  nodes_.push_back(node);
  if (count > kLeaf) {
    int widest = 0;
    const auto spread = [&](int k) { return centres.hi[k] / 2 - centres.lo[k] / 2; };
    for (int k = 1; k < 3; ++k) {
      if (spread(k) > spread(widest)) widest = k;
    }
    const auto centre = [&](std::uint32_t t) {
      return bounds_[t].lo[widest] / 2 + bounds_[t].hi[widest] / 2;
    };
    std::nth_element(from, from + count / 2, to,
                     [&](std::uint32_t s, std::uint32_t t) { return centre(s) < centre(t); });
    build(first, count / 2);
    build(first + count / 2, count - count / 2);
  }
  nodes_[index].after = static_cast<std::uint32_t>(nodes_.size());
}

bool BoxPairs::next(std::vector<TrianglePair>& pairs, std::size_t enough) {
  pairs.clear();
  for (; triangle_ < scene_.triangles.size() && pairs.size() < enough; ++triangle_) {
    const auto end_of = [&](std::uint32_t object) {
      return std::uint64_t{scene_.objects[object].first_triangle} +
             scene_.objects[object].triangle_count;
    };
    while (triangle_ >= end_of(object_)) ++object_;
    // Objects are contiguous and ascending: the later triangles that make a pair start here.
    const std::uint64_t later =
        scene_.objects[object_].self ? std::uint64_t{triangle_} + 1 : end_of(object_);
    const Bounds& bounds = bounds_[triangle_];
    const std::size_t before = pairs.size();
    for (std::uint32_t n = 0; n < nodes_.size();) {
      const Node& node = nodes_[n];
      if (node.last_triangle < later || !meet(node.bounds, bounds)) {
        n = node.after;
        continue;
      }
      if (node.after == n + 1) {  // a leaf
        for (std::uint32_t i = node.first; i < node.first + node.count; ++i) {
          const std::uint32_t other = order_[i];
          if (other >= later && meet(bounds_[other], bounds)) pairs.push_back({triangle_, other});
        }
      }
      ++n;
    }
    std::sort(pairs.begin() + static_cast<std::ptrdiff_t>(before), pairs.end());
  }
  return !pairs.empty();
}

}  // namespace farcull
