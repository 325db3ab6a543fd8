// Bullet's tree of boxes (btGImpactBvh of GImpact) in double. This file computes the boxes. Pairs
// of leaves with overlapping boxes are candidates. Bullet's triangle test rounds and is not used.
//
// Bullet's find_collision() is not called, since it stores all pairs and has one thread. It also
// compares rounded centres and extents with a tolerance, so it can miss small boxes that touch far
// from the origin. Instead search_trees() compares nodes with btAABB::has_collision(), which does
// not round. Bullet's quantized tree is not used, since it may round boxes inward.
#include <BulletCollision/Gimpact/btGImpactBvh.h>

#include <type_traits>

#include "experiments/peers/peer.h"

namespace farcull {
namespace {

static_assert(std::is_same_v<btScalar, double>, "boxes in float would have to be rounded outward");

/// Gives Bullet the boxes while Bullet builds a tree.
class Boxes : public btPrimitiveManagerBase {
 public:
  explicit Boxes(std::span<const Box> boxes) : boxes_(boxes) {}

  bool is_trimesh() const override { return false; }
  int get_primitive_count() const override { return static_cast<int>(boxes_.size()); }
  void get_primitive_box(int index, btAABB& box) const override {
    const Box& from = boxes_[static_cast<std::size_t>(index)];
    box.m_min.setValue(from.lo.x(), from.lo.y(), from.lo.z());
    box.m_max.setValue(from.hi.x(), from.hi.y(), from.hi.z());
  }
  void get_primitive_triangle(int, btPrimitiveTriangle&) const override {}  // narrow phases only

 private:
  std::span<const Box> boxes_;
};

/// A tree of boxes with the interface for search_trees(). Primitive i is triangle first + i.
class BulletTree {
 public:
  /// Precondition: at least one box. `boxes` is used only by the constructor.
  BulletTree(std::span<const Box> boxes, std::uint32_t first)
      : tree_(std::make_unique<btGImpactBvh>()), first_(first) {
    Boxes asked(boxes);
    tree_->setPrimitiveManager(&asked);
    tree_->buildSet();
    tree_->setPrimitiveManager(nullptr);
    nodes_ = tree_->get_node_pointer();
  }

  bool is_leaf(int node) const { return nodes_[node].isLeafNode(); }
  int left(int node) const { return tree_->getLeftNode(node); }
  int right(int node) const { return tree_->getRightNode(node); }
  std::uint32_t triangle(int leaf) const {
    return first_ + static_cast<std::uint32_t>(nodes_[leaf].getDataIndex());
  }
  double size(int node) const {
    const btAABB& box = nodes_[node].m_bound;
    return (box.m_max - box.m_min).length2();
  }
  bool meets(int node, const BulletTree& other, int other_node) const {
    return nodes_[node].m_bound.has_collision(other.nodes_[other_node].m_bound);
  }

 private:
  std::unique_ptr<btGImpactBvh> tree_;
  const GIM_BVH_TREE_NODE* nodes_;
  std::uint32_t first_;
};

BenchAnswer collide(const Scene& scene, unsigned threads) {
  const Stopwatch building;
  const std::vector<Box> boxes = triangle_boxes(scene);
  const std::vector<Box> of_all = object_boxes(scene, boxes);
  const std::vector<std::uint32_t> objects = objects_with_triangles(scene);
  std::vector<Box> of_objects;
  for (const std::uint32_t o : objects) of_objects.push_back(of_all[o]);
  std::vector<std::unique_ptr<BulletTree>> trees(objects.size());
  for_each_shared(objects.size(), threads, [&](std::size_t i) {
    const Object& object = scene.objects[objects[i]];
    const auto mine = std::span(boxes).subspan(object.first_triangle, object.triangle_count);
    trees[i] = std::make_unique<BulletTree>(mine, object.first_triangle);
  });
  const double build_ms = building.ms();

  PeerCandidates candidates(scene, threads, threads > 1);
  std::vector<TreeTask<BulletTree>> tasks;
  for (std::size_t i = 0; i < objects.size(); ++i) {
    if (scene.objects[objects[i]].self)
      tasks.push_back({trees[i].get(), trees[i].get(), 0, 0, true});
  }
  if (objects.size() > 1) {
    const BulletTree tree(of_objects, 0);
    descend(TreeTask<BulletTree>{&tree, &tree, 0, 0, true}, [&](std::uint32_t a, std::uint32_t b) {
      tasks.push_back({trees[a].get(), trees[b].get()});
    });
  }
  search_trees(scene, std::move(tasks), threads, candidates);
  return candidates.finish(build_ms);
}

}  // namespace

LibraryPeers bullet_library() {
  const std::string library = "Bullet " + std::to_string(BT_BULLET_VERSION / 100) + "." +
                              std::to_string(BT_BULLET_VERSION % 100);
  return {.broad = {plain_peer("bullet-gimpact", library, collide)}};
}

}  // namespace farcull
