// FCL in double: its bounding volume hierarchies and overlap tests. FCL's own test of two triangles
// is inexact, so its leaves are candidates here. FCL's traversal has one thread and takes no model
// with itself, so that of trees.h takes its place.
#include <fcl/broadphase/broadphase_dynamic_AABB_tree.h>
#include <fcl/math/bv/AABB.h>
#include <fcl/math/bv/OBB.h>
#include <fcl/math/bv/OBBRSS.h>
#include <fcl/narrowphase/collision_object.h>

#include <algorithm>
#include <memory>
#include <utility>

#include "experiments/peers/fcl_parts.h"
#include "experiments/peers/parts.h"
#include "experiments/peers/trees.h"
#include "verify/exact.h"

namespace farcull {
namespace {

/// The hierarchy of an object, as search_trees() takes it. The larger node is divided first, as in
/// FCL.
template <class Volume>
class FclTree {
 public:
  explicit FclTree(const FclModel<Volume>& model)
      : hierarchy_(model.hierarchy.get()), first_(model.first) {}

  bool is_leaf(int node) const { return hierarchy_->getBV(node).isLeaf(); }
  int left(int node) const { return hierarchy_->getBV(node).leftChild(); }
  int right(int node) const { return hierarchy_->getBV(node).rightChild(); }
  double size(int node) const { return hierarchy_->getBV(node).bv.size(); }
  std::uint32_t triangle(int leaf) const {
    return first_ + static_cast<std::uint32_t>(hierarchy_->getBV(leaf).primitiveId());
  }
  bool meets(int node, const FclTree& other, int other_node) const {
    return hierarchy_->getBV(node).overlap(other.hierarchy_->getBV(other_node));
  }

 private:
  const fcl::BVHModel<Volume>* hierarchy_;
  std::uint32_t first_;
};

/// The objects whose boxes meet, by FCL's own broad phase where there are more than two.
std::vector<std::pair<std::size_t, std::size_t>> meeting(
    std::vector<std::unique_ptr<fcl::CollisionObjectd>>& objects) {
  std::vector<std::pair<std::size_t, std::size_t>> pairs;
  if (objects.size() == 2) return {{0, 1}};
  if (objects.size() < 2) return {};
  fcl::DynamicAABBTreeCollisionManagerd manager;
  for (auto& object : objects) manager.registerObject(object.get());
  manager.setup();
  manager.collide(&pairs, [](fcl::CollisionObjectd* a, fcl::CollisionObjectd* b, void* data) {
    static_cast<decltype(pairs)*>(data)->emplace_back(
        reinterpret_cast<std::size_t>(a->getUserData()),
        reinterpret_cast<std::size_t>(b->getUserData()));
    return false;  // there may be more
  });
  return pairs;
}

template <class Volume>
BenchAnswer collide(const Scene& scene, unsigned threads) {
  const Stopwatch building;
  std::vector<const Object*> objects;
  for (const Object& object : scene.objects) {
    if (object.triangle_count > 0) objects.push_back(&object);
  }
  std::vector<FclModel<Volume>> models(objects.size());
  std::vector<std::unique_ptr<fcl::CollisionObjectd>> placed(objects.size());
  for_each_taken(objects.size(), 1, threads, [&](std::size_t i) {
    models[i] = fcl_model<Volume>(scene, *objects[i]);
    placed[i] = std::make_unique<fcl::CollisionObjectd>(models[i].hierarchy);
    placed[i]->setUserData(reinterpret_cast<void*>(i));
  });
  const double build_ms = building.ms();

  PeerCandidates candidates(scene, threads, threads > 1);
  std::vector<FclTree<Volume>> trees(models.begin(), models.end());
  std::vector<TreeTask<FclTree<Volume>>> tasks;
  for (std::size_t i = 0; i < objects.size(); ++i) {
    if (objects[i]->self) tasks.push_back({&trees[i], &trees[i], 0, 0, true});
  }
  for (const auto& [i, j] : meeting(placed)) tasks.push_back({&trees[i], &trees[j]});
  search_trees(scene, std::move(tasks), threads, candidates);
  BenchAnswer answer = candidates.finish();
  answer.build_ms = build_ms;
  return answer;
}

template <class Volume>
Peer peer(const std::string& name) {
  return {name, kFclLibrary, "", [](unsigned threads) -> BenchRun {
            return [=](const Scene& scene) { return collide<Volume>(scene, threads); };
          }};
}

/// The oriented box of a segment or a point has no axes.
std::string refuses_degenerate(const Scene& scene) {
  return degenerate_triangles(scene) == 0 ? ""
                                          : "oriented boxes of degenerate triangles have no axes";
}

}  // namespace

std::vector<Peer> fcl_peers() {
  std::vector<Peer> peers = {peer<fcl::OBBRSSd>("fcl-obbrss"), peer<fcl::OBBd>("fcl-obb"),
                             peer<fcl::AABBd>("fcl-aabb")};
  peers[0].refuses = peers[1].refuses = refuses_degenerate;
  return peers;
}

}  // namespace farcull
