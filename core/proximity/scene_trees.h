// Trees over the triangles of each object, and one over the objects. The leaves are runs of at most
// sixteen triangles that lie together.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/base/uninitialized.h"
#include "core/pairs/box_tree.h"
#include "core/pairs/runs.h"
#include "core/scene/scene.h"

namespace farcull {

/// All coordinates are multiplied by `scale`, a power of two by which the largest magnitude of the
/// scene lies in [1, 4), or below where it is less than 2^-1000. Products are exact, or off by at
/// most 2^-1075 where they are subnormal: a multiplication by a power of two changes no other
/// digit. So nothing that is computed from them overflows. Scaled triangles are those with these
/// corners.
class SceneTrees {
 public:
  SceneTrees(const Scene& scene, unsigned threads);

  const Scene& scene() const { return *scene_; }
  double scale() const { return scale_; }
  const WideBoxes* blocks() const { return blocks_.data(); }
  /// Its leaves are the runs of the object, counted from 0.
  const BoxTree& tree(std::uint32_t object) const { return trees_[object]; }
  std::uint32_t run_count(std::uint32_t object) const {
    return runs_.first[object + 1] - runs_.first[object];
  }
  /// The number of a leaf among those of all objects.
  std::uint32_t run(std::uint32_t object, std::uint32_t leaf) const {
    return runs_.first[object] + leaf;
  }
  std::uint32_t count(std::uint32_t run) const { return runs_.runs[place_[run]].count; }
  std::uint32_t triangle(std::uint32_t run, std::uint32_t k) const {
    return runs_.triangle(runs_.runs[place_[run]].first + k);
  }
  Vec3 corner(std::uint32_t triangle, std::size_t k) const {
    return scene_->vertices[scene_->triangles[triangle][k]] * scale_;
  }
  Box box(std::uint32_t object) const { return trees_[object].box; }
  /// The least triangle below a node of an object's tree.
  std::uint32_t least(std::uint32_t object, std::size_t height, std::uint32_t k) const {
    const BoxTree& tree = trees_[object];
    if (height == static_cast<std::size_t>(tree.levels))
      return scene_->objects[object].first_triangle;
    return least_[tree.first[height] + k / kWide][k % kWide];
  }

  /// The tree over the objects that have triangles, and which object each leaf is.
  const BoxTree& objects() const { return objects_; }
  std::uint32_t object(std::uint32_t leaf) const { return object_of_leaf_[leaf]; }

 private:
  void choose_scale();
  void make_trees(unsigned threads);
  void find_least(std::uint32_t object);
  void make_object_tree();

  const Scene* scene_;
  double scale_ = 1;
  Runs runs_;
  std::vector<std::uint32_t> place_;  // of each run, in the order of leaves, into runs_.runs
  std::vector<BoxTree> trees_;
  BoxTree objects_;
  std::vector<std::uint32_t> object_of_leaf_;
  UninitializedVector<WideBoxes> blocks_;
  std::vector<std::array<std::uint32_t, kWide>> least_;  // of each box of blocks_
};

}  // namespace farcull
