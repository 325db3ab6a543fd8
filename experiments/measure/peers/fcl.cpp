// FCL in double: its bounding volume hierarchies and overlap tests. FCL's own test of two triangles
// is inexact, so its leaves are candidates here; and its traversal, which has one thread, is
// written anew so that it can be divided and can take a model with itself.
#include <fcl/broadphase/broadphase_dynamic_AABB_tree.h>
#include <fcl/math/bv/AABB.h>
#include <fcl/math/bv/OBB.h>
#include <fcl/math/bv/OBBRSS.h>
#include <fcl/narrowphase/collision_object.h>

#include <algorithm>
#include <memory>
#include <utility>

#include "experiments/measure/peers/fcl_parts.h"
#include "experiments/measure/peers/parts.h"
#include "verify/exact.h"

namespace farcull {
namespace {

/// Two nodes whose leaves are to be compared; a model with itself where one of them is all.
template <class Volume>
struct Task {
  const FclModel<Volume>* first;
  const FclModel<Volume>* second;
  int a;
  int b;
  bool inner = false;  // the leaves below a with each other
};

/// Where a task goes on: with the larger node divided, as FCL does it, or at leaves (found) and
/// disjoint volumes nowhere.
template <class Volume, class Found, class Next>
void step(const Task<Volume>& task, const Found& found, const Next& next) {
  const auto& a = task.first->hierarchy->getBV(task.a);
  const auto& b = task.second->hierarchy->getBV(task.b);
  const auto with = [&](int left, int right, bool inner = false) {
    next({task.first, task.second, left, right, inner});
  };
  if (task.inner) {
    if (a.isLeaf()) return;
    with(a.leftChild(), a.leftChild(), true);
    with(a.rightChild(), a.rightChild(), true);
    with(a.leftChild(), a.rightChild());
    return;
  }
  if (!a.overlap(b)) return;
  if (a.isLeaf() && b.isLeaf()) {
    found(task.first->first + static_cast<std::uint32_t>(a.primitiveId()),
          task.second->first + static_cast<std::uint32_t>(b.primitiveId()));
  } else if (b.isLeaf() || (!a.isLeaf() && a.bv.size() > b.bv.size())) {
    with(a.leftChild(), task.b);
    with(a.rightChild(), task.b);
  } else {
    with(task.a, b.leftChild());
    with(task.a, b.rightChild());
  }
}

template <class Volume, class Found>
void descend(const Task<Volume>& task, const Found& found) {
  step(task, found, [&found](const Task<Volume>& next) { descend(next, found); });
}

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
  std::vector<Task<Volume>> tasks;
  for (std::size_t i = 0; i < objects.size(); ++i) {
    if (objects[i]->self) tasks.push_back({&models[i], &models[i], 0, 0, true});
  }
  for (const auto& [i, j] : meeting(placed)) tasks.push_back({&models[i], &models[j], 0, 0});
  // Divided until there is enough for all threads.
  const auto found = [&](std::uint32_t a, std::uint32_t b) { candidates.part().add(a, b); };
  const std::size_t enough = threads > 1 ? 64 * threads : 1;
  while (!tasks.empty() && tasks.size() < enough) {
    std::vector<Task<Volume>> finer;
    for (const Task<Volume>& task : tasks) {
      step(task, found, [&finer](const Task<Volume>& next) { finer.push_back(next); });
    }
    tasks = std::move(finer);
  }
  for_each_taken(tasks.size(), 1, threads, [&](std::size_t i) {
    PeerCandidates::Part& part = candidates.part();
    if (tasks[i].first == tasks[i].second) {
      descend(tasks[i], [&](std::uint32_t a, std::uint32_t b) {
        if (!share_vertex(scene, a, b)) part.add(a, b);
      });
    } else {
      descend(tasks[i], [&part](std::uint32_t a, std::uint32_t b) { part.add(a, b); });
    }
  });
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
