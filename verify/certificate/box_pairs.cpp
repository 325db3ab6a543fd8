// A tree of boxes over all triangles; each triangle asks it for later ones whose boxes it meets.
#include "verify/certificate/box_pairs.h"

#include <algorithm>

namespace farcull {

BoxPairs::BoxPairs(const Scene& scene, double clearance)
    : scene_(scene), clearance_(clearance), tree_(scene) {
  const auto count = static_cast<std::uint32_t>(scene.triangles.size());
  if (count > 0) tree_.add(0, count);
}

// Rounding is monotone: no two boxes inside x and y have a smaller rounded difference.
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
    // Objects are contiguous and ascending: the later triangles that make a pair start here.
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
          if (other >= later && meet(tree_.bounds[other], bounds))
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
