// Trees of boxes over triangles, and two enumerations by them.
#include "verify/certificate/box_pairs.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

namespace farcull {

// The tree divides at the median of the centres, along the axis in which they spread most.

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

// The places where the tree divides change only the time of a query, not its answer, since a query
// looks below every node whose box it meets.
void BoundsTree::add(std::uint32_t first, std::uint32_t count) {
  constexpr std::uint32_t kLeaf = 4;
  const auto from = order.begin() + first;
  const auto to = from + count;
  Node node{.bounds = bounds[*from], .first = first, .count = count};
  Bounds centres;  // box of the centres; halves are added, since a sum may overflow
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

// ---- a tree over all triangles; each triangle asks it for later ones whose boxes it meets ----

BoxPairs::BoxPairs(const Scene& scene, double clearance, const Tile& tile)
    : scene_(scene), clearance_(clearance), tile_(tile), tree_(scene) {
  const auto count = static_cast<std::uint32_t>(scene.triangles.size());
  if (count > 0) tree_.add(0, count);
}

// Rounding is monotone: boxes inside x and y never have a smaller rounded difference than x and y.
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

// ---- near boxes: descends into the trees of both objects at once, the larger box first ----

namespace {

// ---- rounding ----
// With u = 2^-53: a gap of two boxes along an axis is a difference of doubles, off by a factor
// within 1 +- u, and exact if it is subnormal. The gap is scaled (1 +- u) and squared (the two
// errors twice, and 1 +- u), and the three squares are added (1 +- u, twice). These are 7 factors
// within 1 +- u, so the exact sum is at least the computed one times 1 - 8 u. Each of the three
// squares is off by less than 2^-1074 more if it underflows, which is negligible beside a length
// whose scaled square is at least 2^-104. The length's scaled square is rounded twice, (1 +- u)^2.
// So a margin of 32 u is enough: (1 - 8 u) (1 - u)^2 (1 + 32 u) > 1 + 20 u.
constexpr double kMargin = 0x1p-48;

}  // namespace

FarBoxes::FarBoxes(double length) : length_(length) {
  if (length == 0 || std::isinf(length)) return;
  // The scaled length is in [1, 2), or in [2^-52, 1) if the length is subnormal.
  const int exponent = std::max(std::ilogb(length), std::numeric_limits<double>::min_exponent - 1);
  scale_ = std::ldexp(1.0, -exponent);
  const double scaled = length * scale_;
  squared_ = scaled * scaled * (1 + kMargin);
}

// If a difference overflows, it is more than any finite length. If a gap overflows when it is
// scaled by 2^-e, it is at least 2^(e + 1024), while the length is less than 2^(e + 1).
bool FarBoxes::proved(const BoundsTree::Bounds& x, const BoundsTree::Bounds& y) const {
  double sum = 0;
  for (int k = 0; k < 3; ++k) {
    const double gap = std::max({y.lo[k] - x.hi[k], x.lo[k] - y.hi[k], 0.0});
    // Rounding is monotone: if the rounded difference is above a double, so is the exact one.
    if (gap > length_) return true;
    const double scaled = gap * scale_;
    sum += scaled * scaled;
  }
  return length_ > 0 && std::isfinite(length_) && sum >= squared_;
}

NearBoxes::NearBoxes(const Scene& scene) : scene_(scene), tree_(scene) {
  for (const Object& object : scene.objects) {
    roots_.push_back(static_cast<std::uint32_t>(tree_.nodes.size()));
    if (object.triangle_count > 0) tree_.add(object.first_triangle, object.triangle_count);
  }
}

void NearBoxes::ask(std::uint32_t a, std::uint32_t b, double length) {
  far_ = FarBoxes(length);
  open_.clear();
  if (scene_.objects[a].triangle_count == 0 || scene_.objects[b].triangle_count == 0) return;
  open_.push_back({roots_[a], roots_[b]});
}

bool NearBoxes::next(std::vector<TrianglePair>& pairs, std::size_t enough) {
  const auto extent = [](const BoundsTree::Bounds& box) {
    double most = 0;
    for (int k = 0; k < 3; ++k) most = std::max(most, box.hi[k] / 2 - box.lo[k] / 2);
    return most;
  };
  while (!open_.empty() && pairs.size() < enough) {
    const auto [a, b] = open_.back();
    open_.pop_back();
    const BoundsTree::Node& x = tree_.nodes[a];
    const BoundsTree::Node& y = tree_.nodes[b];
    if (far_.proved(x.bounds, y.bounds)) continue;
    if (tree_.is_leaf(a) && tree_.is_leaf(b)) {
      for (std::uint32_t i = x.first; i < x.first + x.count; ++i) {
        for (std::uint32_t j = a == b ? i + 1 : y.first; j < y.first + y.count; ++j) {
          const auto [s, t] = std::minmax(tree_.order[i], tree_.order[j]);
          if (!far_.proved(tree_.bounds[s], tree_.bounds[t])) pairs.push_back({s, t});
        }
      }
      continue;
    }
    if (a == b) {
      const std::uint32_t right = tree_.nodes[a + 1].after;
      open_.insert(open_.end(), {{a + 1, a + 1}, {right, right}, {a + 1, right}});
      continue;
    }
    if (!tree_.is_leaf(a) && (tree_.is_leaf(b) || extent(x.bounds) >= extent(y.bounds))) {
      open_.push_back({a + 1, b});
      open_.push_back({tree_.nodes[a + 1].after, b});
    } else {
      open_.push_back({a, b + 1});
      open_.push_back({a, tree_.nodes[b + 1].after});
    }
  }
  return !open_.empty();
}

}  // namespace farcull
