// Blocks come from core/boxes/triangle_blocks.h; those of an object are put in an order of their
// own, so that sixteen that follow one another lie together as well.
#include "core/proximity/scene_trees.h"

#include <algorithm>
#include <cmath>

#include "core/base/parallel.h"

namespace farcull {

SceneTrees::SceneTrees(const Scene& scene, unsigned threads)
    : scene_(&scene), of_(make_ordered_blocks(scene, 0, threads)) {
  choose_scale();
  make_trees(threads);
  make_object_tree();
}

void SceneTrees::choose_scale() {
  double most = 0;
  for (const Box& box : of_.objects) {
    if (box.is_empty()) continue;
    most = std::max({most, box.lo.cwiseAbs().maxCoeff(), box.hi.cwiseAbs().maxCoeff()});
  }
  if (most > 0) scale_ = std::ldexp(1.0, std::clamp(-std::ilogb(most), -1022, 1000));
}

void SceneTrees::make_trees(unsigned threads) {
  const std::size_t objects = scene_->objects.size();
  std::vector<std::size_t> first(objects);
  std::size_t blocks = 0;
  for (std::size_t o = 0; o < objects; ++o) {
    first[o] = blocks;
    blocks += blocks_of_tree(of_.count(static_cast<std::uint32_t>(o)));
  }
  blocks_.resize(blocks + blocks_of_tree(objects));
  least_.resize(blocks);
  trees_.resize(objects);
  place_.resize(of_.ranges.size());
  const auto make = [&](std::size_t o) {
    const std::uint32_t from = of_.first[o], n = of_.count(static_cast<std::uint32_t>(o));
    const auto place = std::span(place_).subspan(from, n);
    spatial_order(std::span(of_.boxes).subspan(from, n), place);
    std::vector<Box> leaves(n);
    for (std::size_t k = 0; k < n; ++k) {
      const Box& box = of_.boxes[place[k] += from];
      leaves[k] = {box.lo * scale_, box.hi * scale_};
    }
    trees_[o] = make_tree<double>(leaves, blocks_, first[o]);
    find_least(static_cast<std::uint32_t>(o));
  };
  for_chunks(objects, chunks_for(objects, 1, threads),
             [&](std::size_t, std::size_t begin, std::size_t end) {
               for (std::size_t o = begin; o < end; ++o) make(o);
             });
}

void SceneTrees::find_least(std::uint32_t object) {
  const BoxTree<double>& tree = trees_[object];
  std::vector<std::uint32_t> least(tree.leaves, UINT32_MAX);
  for (std::uint32_t n = 0; n < least.size(); ++n) {
    const std::uint32_t at = leaf(object, n);
    for (std::uint32_t k = 0; k < count(at); ++k) least[n] = std::min(least[n], triangle(at, k));
  }
  for (std::size_t height = 0; height < static_cast<std::size_t>(tree.levels); ++height) {
    const std::size_t n = (least.size() + kWide - 1) / kWide;
    for (std::size_t block = 0; block < n; ++block) {
      auto& of_block = least_[tree.first[height] + block];
      of_block.fill(UINT32_MAX);
      const std::size_t end = std::min(least.size() - kWide * block, std::size_t{kWide});
      std::copy_n(least.begin() + static_cast<std::ptrdiff_t>(kWide * block), end,
                  of_block.begin());
      least[block] = *std::ranges::min_element(of_block);
    }
    least.resize(n);
  }
}

void SceneTrees::make_object_tree() {
  std::vector<std::uint32_t> objects;
  std::vector<Box> boxes;
  for (std::uint32_t o = 0; o < trees_.size(); ++o) {
    if (trees_[o].levels == 0) continue;
    objects.push_back(o);
    boxes.push_back(trees_[o].box);
  }
  std::vector<std::uint32_t> order(objects.size());
  spatial_order(boxes, order);
  std::vector<Box> leaves(objects.size());
  object_of_leaf_.resize(objects.size());
  for (std::size_t k = 0; k < order.size(); ++k) {
    leaves[k] = boxes[order[k]];
    object_of_leaf_[k] = objects[order[k]];
  }
  objects_ =
      make_tree<double>(leaves, blocks_, blocks_.size() - blocks_of_tree(scene_->objects.size()));
}

namespace {

// Fetches memory into the cache, for a use that follows soon.
void fetch([[maybe_unused]] const void* at) {
#ifdef __GNUC__
  __builtin_prefetch(at);
#endif
}

}  // namespace

void load_leaf(const SceneTrees& trees, std::uint32_t leaf, BlockCorners& out) {
  const Scene& scene = trees.scene();
  out.leaf = leaf;
  out.count = trees.count(leaf);
  out.direction = 0;
  // Triangles and their corners may lie anywhere in memory.
  for (std::uint32_t k = 0; k < kWide; ++k) {
    out.triangle[k] = trees.triangle(leaf, std::min(k, out.count - 1));
    fetch(&scene.triangles[out.triangle[k]]);
  }
  for (const std::uint32_t triangle : out.triangle) prefetch(scene, triangle);
  out.boxes.clear();
  for (std::uint32_t k = 0; k < kWide; ++k) {
    Box box = Box::empty();
    for (std::size_t corner = 0; corner < 3; ++corner) {
      const Vec3 p = trees.corner(out.triangle[k], corner);
      box.add(p);
      for (std::size_t axis = 0; axis < 3; ++axis)
        out.corner[3 * corner + axis][k] = p[static_cast<Eigen::Index>(axis)];
    }
    if (k < out.count) out.boxes.set(k, box);
  }
}

bool share_position(const Scene& scene, std::uint32_t a, std::uint32_t b) {
  const auto &own = scene.triangles[a], &other = scene.triangles[b];
  if (share_index(own, other)) return true;
  for (const std::uint32_t v : own) {
    for (const std::uint32_t w : other) {
      if (scene.vertices[v] == scene.vertices[w]) return true;
    }
  }
  return false;
}

}  // namespace farcull
