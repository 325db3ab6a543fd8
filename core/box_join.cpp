#include "core/box_join.h"

#include <algorithm>
#include <cmath>

namespace farcull {
namespace {

// The axis along which the boxes are shortest compared with the extent of all: fewest are open at a
// time.
int sweep_axis(std::span<const Box> boxes, std::span<const std::uint32_t> items) {
  Box all = Box::empty();
  Vec3 lengths = Vec3::Zero();
  for (const std::uint32_t i : items) {
    all.add(boxes[i]);
    lengths += boxes[i].hi - boxes[i].lo;
  }
  int best = 0;
  double smallest = HUGE_VAL;
  for (int axis = 0; axis < 3; ++axis) {
    const double ratio = lengths[axis] / (all.hi[axis] - all.lo[axis]);
    if (ratio < smallest) {
      smallest = ratio;
      best = axis;
    }
  }
  return best;
}

}  // namespace

std::vector<TrianglePair> box_join(std::span<const Box> boxes,
                                   std::span<const std::uint32_t> owners,
                                   std::span<const std::uint32_t> items) {
  std::vector<TrianglePair> pairs;
  std::vector<std::uint32_t> order;
  for (const std::uint32_t i : items) {
    if (!boxes[i].is_empty()) order.push_back(i);
  }
  if (order.size() < 2) return pairs;
  const int axis = sweep_axis(boxes, order);
  std::sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) {
    return std::pair(boxes[a].lo[axis], a) < std::pair(boxes[b].lo[axis], b);
  });
  std::vector<std::uint32_t> open;  // boxes that started and may still reach the next start
  for (const std::uint32_t next : order) {
    const Box& box = boxes[next];
    std::size_t kept = 0;
    for (const std::uint32_t i : open) {
      if (boxes[i].hi[axis] < box.lo[axis]) continue;
      open[kept++] = i;
      if (owners[i] != owners[next] && overlap(boxes[i], box))
        pairs.push_back({std::min(i, next), std::max(i, next)});
    }
    open.resize(kept);
    open.push_back(next);
  }
  std::sort(pairs.begin(), pairs.end());
  return pairs;
}

}  // namespace farcull
