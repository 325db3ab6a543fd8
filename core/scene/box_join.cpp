// Boxes are sorted along one axis and swept in strips across another one; each pair is reported in
// one strip.
#include "core/scene/box_join.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace farcull {
namespace {

// Axes by the mean length of the boxes compared with the extent of all: along the first, fewest are
// open at a time.
struct Axes {
  int sweep;
  int strips;
  double from;   // of all boxes along the strips' axis
  double scale;  // strips per unit
  int count;     // of strips
};

Axes choose_axes(std::span<const Box> boxes, std::span<const std::uint32_t> items) {
  Box all = Box::empty();
  Vec3 lengths = Vec3::Zero();
  const double n = static_cast<double>(items.size());
  for (const std::uint32_t i : items) {
    all.add(boxes[i]);
    lengths += (boxes[i].hi - boxes[i].lo) / n;
  }
  std::array<double, 3> ratio;
  for (int axis = 0; axis < 3; ++axis) {
    const double r = lengths[axis] / (all.hi[axis] - all.lo[axis]);
    ratio[axis] = std::isfinite(r) ? r : 1;  // flat in this axis, or beyond double: of no use
  }
  std::array<int, 3> order = {0, 1, 2};
  std::sort(order.begin(), order.end(),
            [&](int a, int b) { return std::pair(ratio[a], a) < std::pair(ratio[b], b); });
  Axes out{order[0], order[1], all.lo[order[1]], 0, 1};
  // As many strips as keep the number of entries below about twice that of the boxes.
  const double strips = std::min(std::sqrt(n), 1 / std::max(ratio[order[1]], 1e-9));
  const double scale = strips / (all.hi[order[1]] - all.lo[order[1]]);
  if (strips >= 2 && std::isfinite(scale) && scale > 0) {
    out.scale = scale;
    out.count = static_cast<int>(strips);
  }
  return out;
}

}  // namespace

std::vector<TrianglePair> box_join(std::span<const Box> boxes,
                                   std::span<const std::uint32_t> owners,
                                   std::span<const std::uint32_t> items, std::size_t most) {
  std::vector<TrianglePair> pairs;
  std::vector<std::uint32_t> order;
  for (const std::uint32_t i : items) {
    if (!boxes[i].is_empty()) order.push_back(i);
  }
  if (order.size() < 2) return pairs;
  const Axes axes = choose_axes(boxes, order);
  std::sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) {
    return std::pair(boxes[a].lo[axes.sweep], a) < std::pair(boxes[b].lo[axes.sweep], b);
  });
  // Never decreasing in x, so the strips of two overlapping boxes have that of the larger lower end
  // in common: there, and only there, the pair is reported.
  const auto strip = [&axes](double x) {
    if (axes.count == 1) return 0;
    return static_cast<int>(std::clamp((x - axes.from) * axes.scale, 0.0, axes.count - 1.0));
  };
  std::vector<std::vector<std::uint32_t>> open(
      axes.count);  // boxes that started and may still reach the next start
  for (const std::uint32_t next : order) {
    const Box& box = boxes[next];
    const int first = strip(box.lo[axes.strips]), last = strip(box.hi[axes.strips]);
    for (int s = first; s <= last; ++s) {
      std::size_t kept = 0;
      for (const std::uint32_t i : open[s]) {
        const Box& other = boxes[i];
        if (other.hi[axes.sweep] < box.lo[axes.sweep]) continue;
        open[s][kept++] = i;
        if (owners[i] == owners[next] || !overlap(other, box)) continue;
        if (strip(std::max(other.lo[axes.strips], box.lo[axes.strips])) != s) continue;
        pairs.push_back({std::min(i, next), std::max(i, next)});
        if (pairs.size() > most) return pairs;
      }
      open[s].resize(kept);
      open[s].push_back(next);
    }
  }
  std::sort(pairs.begin(), pairs.end());
  return pairs;
}

std::vector<std::uint32_t> join_owners(const Scene& scene) {
  std::vector<std::uint32_t> out = owners(scene);
  const auto objects = static_cast<std::uint32_t>(scene.objects.size());
  for (std::uint32_t t = 0; t < out.size(); ++t) {
    if (scene.objects[out[t]].self) out[t] = objects + t;
  }
  return out;
}

}  // namespace farcull
