// Trees of boxes are built from the leaves up: each level is a row of blocks, and the box of a
// block is a box of the next level.
#include "core/pairs/box_tree.h"

#include <algorithm>
#include <array>
#include <limits>
#include <ranges>
#include <vector>

namespace farcull {
namespace {

std::size_t wide(std::size_t n) { return (n + kWide - 1) / kWide; }

}  // namespace

std::size_t blocks_of_tree(std::size_t leaves) {
  if (leaves == 0) return 0;
  std::size_t level = wide(leaves), out = level;
  while (level > 1) {
    level = wide(level);
    out += level;
  }
  return out;
}

BoxTree make_tree(std::span<const Box> leaves, std::span<WideBoxes> blocks, std::size_t at) {
  BoxTree out;
  if (leaves.empty()) return out;
  for (const Box& box : leaves) out.box.add(box);
  std::vector<Box> boxes(leaves.begin(), leaves.end());
  while (boxes.size() > 1 || out.levels == 0) {
    const std::size_t n = wide(boxes.size());
    for (std::size_t block = 0; block < n; ++block) {
      blocks[at + block].clear();
      Box all = Box::empty();
      const std::size_t end = std::min(boxes.size() - kWide * block, std::size_t{kWide});
      for (std::size_t k = 0; k < end; ++k) {
        const Box& box = boxes[kWide * block + k];
        blocks[at + block].set(k, box);
        all.add(box);
      }
      boxes[block] = all;
    }
    boxes.resize(n);
    out.first[static_cast<std::size_t>(out.levels++)] = at;
    at += n;
  }
  return out;
}

namespace {

// A box to be put in order. Halves, since a difference of two doubles may be infinite.
struct Placed {
  std::array<double, 3> middle, half;  // half of its sides
  std::uint32_t box;
};

Placed placed(const Box& box, std::uint32_t k) {
  constexpr double kLargest = std::numeric_limits<double>::max();
  Placed out{{}, {}, k};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const auto half = [&](const Vec3& end) {
      return 0.5 * std::clamp(end[static_cast<Eigen::Index>(axis)], -kLargest, kLargest);
    };
    out.middle[axis] = half(box.lo) + half(box.hi);
    out.half[axis] = half(box.hi) - half(box.lo);
  }
  return out;
}

// The axis along which most middles lie farthest apart, and from where to where.
struct Spread {
  std::size_t axis = 0;
  double lo = 0, hi = 0;
  double half() const { return 0.5 * hi - 0.5 * lo; }
  void widen(const Spread& other) {
    if (other.half() > half()) *this = other;
  }
};

// Of a sample, without the eighths at both ends: a few boxes far away say nothing.
Spread sampled_spread(std::span<const Placed> items) {
  constexpr std::size_t kMost = 32;
  const std::size_t n = std::min(items.size() / 4, kMost), end = n / 8;
  std::array<double, kMost> at;
  Spread out;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    for (std::size_t k = 0; k < n; ++k) at[k] = items[items.size() * k / n].middle[axis];
    std::sort(at.begin(), at.begin() + static_cast<std::ptrdiff_t>(n));
    out.widen({axis, at[end], at[n - 1 - end]});
  }
  return out;
}

Spread whole_spread(std::span<const Placed> items) {
  Spread out;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const auto [lo, hi] = std::ranges::minmax(
        items | std::views::transform([&](const Placed& item) { return item.middle[axis]; }));
    out.widen({axis, lo, hi});
  }
  return out;
}

// Puts the items in order. `at`: the number of the first one among all.
void sort_in_place(std::span<Placed> items, std::size_t at) {
  while (items.size() > kWide) {
    Spread spread = sampled_spread(items);
    if (spread.half() == 0) spread = whole_spread(items);
    if (spread.half() == 0) return;
    // What reaches across would make both parts as long. Each is set apart once, and only where
    // they are not most of the items, so that the depth stays logarithmic.
    const auto rest = std::partition(items.begin(), items.end(), [&](const Placed& item) {
      const double middle = item.middle[spread.axis], half = item.half[spread.axis];
      return middle - half <= spread.lo && middle + half >= spread.hi;
    });
    const auto large = static_cast<std::size_t>(rest - items.begin());
    if (large > 0 && large <= items.size() / 2) {
      sort_in_place(items.first(large), at);
      items = items.subspan(large);
      at += large;
    }
    // In the middle, but at the end of a node as high as there is in the range.
    std::size_t node = 1;
    while (node * kWide < items.size()) node *= kWide;
    const std::size_t split = (at + items.size() / 2 + node / 2) / node * node;
    const std::size_t low = split > at && split < at + items.size() ? split - at : items.size() / 2;
    std::nth_element(items.begin(), items.begin() + static_cast<std::ptrdiff_t>(low), items.end(),
                     [&](const Placed& a, const Placed& b) {
                       return a.middle[spread.axis] < b.middle[spread.axis];
                     });
    sort_in_place(items.first(low), at);
    items = items.subspan(low);
    at += low;
  }
}

}  // namespace

void spatial_order(std::span<const Box> boxes, std::span<std::uint32_t> order) {
  std::vector<Placed> items(boxes.size());
  for (std::size_t k = 0; k < items.size(); ++k)
    items[k] = placed(boxes[k], static_cast<std::uint32_t>(k));
  sort_in_place(items, 0);
  for (std::size_t k = 0; k < items.size(); ++k) order[k] = items[k].box;
}

}  // namespace farcull
