// The join of all boxes sorts them along one axis and sweeps them in strips across another one;
// each pair is reported in one strip. The join in order asks a tree of boxes about one triangle
// after the other, some side by side: the pairs of a triangle a are those with b > a, so that pairs
// in the order of a are in order.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "core/boxes/join.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "core/base/parallel.h"
#include "core/boxes/join.h"
#include "core/boxes/lanes-inl.h"

HWY_BEFORE_NAMESPACE();
namespace farcull::HWY_NAMESPACE {

std::uint64_t find_leaves_here(const BoxTree<double>& tree, const WideBoxes<double>* blocks,
                               const Box& box, std::vector<std::uint32_t>& leaves) {
  return boxes::for_overlapping_leaves(tree, blocks, boxes::OneBox<double>(box), 0,
                                       [&](std::uint32_t leaf) { leaves.push_back(leaf); });
}

}  // namespace farcull::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace farcull {

HWY_EXPORT(find_leaves_here);

namespace {

std::uint64_t find_leaves(const BoxTree<double>& tree, const WideBoxes<double>* blocks,
                          const Box& box, std::vector<std::uint32_t>& leaves) {
  return HWY_DYNAMIC_DISPATCH(find_leaves_here)(tree, blocks, box, leaves);
}

// Axes by the mean length of the boxes compared with the extent of all: along the first one the
// fewest boxes are open at a time.
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

OrderedPairs::OrderedPairs(const Scene& scene, double clearance,
                           std::span<const ObjectPair> ignored, unsigned threads)
    : ignored_(scene, ignored),
      threads_(threads),
      owner_(join_owners(scene)),
      boxes_(scene.triangles.size()),
      order_(scene.triangles.size()),
      blocks_(blocks_of_tree(scene.triangles.size())) {
  for (std::uint32_t t = 0; t < boxes_.size(); ++t) boxes_[t] = grown_box(scene, t, clearance);
  spatial_order(boxes_, order_);
  std::vector<Box> leaves(boxes_.size());
  for (std::size_t k = 0; k < leaves.size(); ++k) leaves[k] = boxes_[order_[k]];
  tree_ = make_tree<double>(leaves, blocks_, 0);
}

// Returns how many blocks were compared.
std::uint64_t OrderedPairs::append(std::uint32_t a, std::vector<std::uint32_t>& leaves,
                                   std::vector<TrianglePair>& out) const {
  leaves.clear();
  const std::uint64_t compared = find_leaves(tree_, blocks_.data(), boxes_[a], leaves);
  const auto begin = static_cast<std::ptrdiff_t>(out.size());
  for (const std::uint32_t leaf : leaves) {
    const std::uint32_t b = order_[leaf];
    if (b > a && owner_[a] != owner_[b] && !ignored_({a, b})) out.push_back({a, b});
  }
  std::sort(out.begin() + begin, out.end());
  return compared;
}

void OrderedPairs::next(std::size_t most, std::vector<TrianglePair>& out) {
  out.clear();
  if (at_end()) return;
  const auto left = static_cast<std::uint32_t>(boxes_.size()) - next_;
  const std::uint32_t asked = std::min(triangles_, left);
  struct Part {
    std::vector<TrianglePair> pairs;
    std::uint32_t done = 0;  // triangles whose pairs these are
    std::uint64_t compared = 0;
    bool complete = false;
  };
  std::vector<Part> parts(chunks_for(asked, 16, threads_));
  const std::size_t most_of_part = std::max<std::size_t>(most / parts.size(), 1);
  for_chunks(asked, parts.size(), [&](std::size_t chunk, std::size_t begin, std::size_t end) {
    Part& part = parts[chunk];
    std::vector<std::uint32_t> leaves;
    for (std::size_t k = begin; k < end && part.pairs.size() < most_of_part; ++k, ++part.done)
      part.compared += append(next_ + static_cast<std::uint32_t>(k), leaves, part.pairs);
    part.complete = part.done == end - begin;
  });
  // A part that is not complete would leave a gap before the next one, which is asked again.
  bool full = false;
  for (const Part& part : parts) {
    out.insert(out.end(), part.pairs.begin(), part.pairs.end());
    next_ += part.done;
    compared_ += part.compared;
    full = !part.complete;
    if (full) break;
  }
  if (full) {
    triangles_ = std::max<std::uint32_t>(triangles_ / 2, 1);
  } else if (out.size() < most / 4) {
    triangles_ = std::min<std::uint32_t>(triangles_ * 2, 1 << 16);
  }
}

}  // namespace farcull
#endif
