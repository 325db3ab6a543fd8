#include "core/pairs/run_pairs.h"

#include <algorithm>
#include <limits>

namespace farcull {
namespace {

constexpr float kInf = std::numeric_limits<float>::infinity();
constexpr std::array<float, 6> kNowhere = {kInf, kInf, kInf, -kInf, -kInf, -kInf};

void set(BoxBlock& block, std::size_t lane, const std::array<float, 6>& box) {
  for (std::size_t k = 0; k < 6; ++k) block.column[k][lane] = box[k];
}

// Rounded to float, but finite, so that no box meets a missing one.
Eigen::Vector3f relative(const Vec3& p, const Vec3& origin) {
  constexpr float kLargest = std::numeric_limits<float>::max();
  return (p - origin).cast<float>().cwiseMin(kLargest).cwiseMax(-kLargest);
}

std::array<float, 6> relative(const Box& box, const Vec3& origin) {
  if (box.is_empty()) return kNowhere;
  const Eigen::Vector3f lo = relative(box.lo, origin), hi = relative(box.hi, origin);
  return {lo.x(), lo.y(), lo.z(), hi.x(), hi.y(), hi.z()};
}

std::array<float, 6> bound_of(const BoxBlock& block) {
  std::array<float, 6> out;
  for (std::size_t k = 0; k < 3; ++k) out[k] = std::ranges::min(block.column[k]);
  for (std::size_t k = 3; k < 6; ++k) out[k] = std::ranges::max(block.column[k]);
  return out;
}

}  // namespace

RunTrees::RunTrees(const Runs& runs, std::span<const Box> regions)
    : runs_(&runs), trees_(runs.objects.size()) {
  Box all = Box::empty();
  for (std::size_t o = 0; o < trees_.size(); ++o) {
    if (!regions[o].is_empty()) all.add(runs.objects[o]);
  }
  // A box that grew beyond the range of doubles is infinite; the origin must not be, since a box
  // relative to it would be no number and meet nothing.
  constexpr double kLargest = std::numeric_limits<double>::max();
  if (all.is_empty()) all = {Vec3::Zero(), Vec3::Zero()};
  origin_ = 0.5 * all.lo.cwiseMax(-kLargest) + 0.5 * all.hi.cwiseMin(kLargest);
  for (std::uint32_t o = 0; o < trees_.size(); ++o) {
    const std::uint32_t count = regions[o].is_empty() ? 0 : runs.count(o);
    Tree& tree = trees_[o];
    std::size_t below = 0, boxes = count;  // of the level: its first block below, its boxes
    while (boxes > 0) {
      const std::size_t first = blocks_.size(), size = (boxes + 15) / 16;
      blocks_.resize(first + size);
      for (std::size_t k = 0; k < 16 * size; ++k) {
        const std::array<float, 6> box = k >= boxes ? kNowhere
                                         : tree.levels == 0
                                             ? relative(runs.boxes[runs.first[o] + k], origin_)
                                             : bound_of(blocks_[below + k]);
        set(blocks_[first + k / 16], k % 16, box);
      }
      tree.first[static_cast<std::size_t>(tree.levels++)] = first;
      if (size == 1) break;
      below = first;
      boxes = size;
    }
  }
}

void fill_block(const Scene& scene, std::span<const std::uint32_t> triangles, const Vec3& origin,
                double clearance, RunBlock& out, VertexBlock* vertices) {
  out.bound = kNowhere;
  for (std::uint32_t k = 0; k < 16; ++k) {
    if (k >= triangles.size()) {
      set(out.boxes, k, kNowhere);
      out.triangles[k] = 0;
      if (vertices) vertices->corner[0][k] = vertices->corner[1][k] = vertices->corner[2][k] = 0;
      continue;
    }
    const std::uint32_t t = triangles[k];
    std::array<float, 6> box;
    const auto& [p, q, r] = scene.triangles[t];
    if (clearance > 0) {
      box = relative(grown_box(scene, t, clearance), origin);
    } else {
      const Eigen::Vector3f a = relative(scene.vertices[p], origin);
      const Eigen::Vector3f b = relative(scene.vertices[q], origin);
      const Eigen::Vector3f c = relative(scene.vertices[r], origin);
      const Eigen::Vector3f lo = a.cwiseMin(b).cwiseMin(c), hi = a.cwiseMax(b).cwiseMax(c);
      box = {lo.x(), lo.y(), lo.z(), hi.x(), hi.y(), hi.z()};
    }
    set(out.boxes, k, box);
    out.triangles[k] = t;
    if (vertices) {
      vertices->corner[0][k] = p;
      vertices->corner[1][k] = q;
      vertices->corner[2][k] = r;
    }
    for (std::size_t i = 0; i < 3; ++i) {
      out.bound[i] = std::min(out.bound[i], box[i]);
      out.bound[i + 3] = std::max(out.bound[i + 3], box[i + 3]);
    }
  }
}

}  // namespace farcull
