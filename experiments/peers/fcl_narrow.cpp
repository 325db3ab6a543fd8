// FCL as its users run it: its own broad phase, hierarchies and test of two triangles, which
// rounds.
#include <fcl/broadphase/broadphase_dynamic_AABB_tree.h>
#include <fcl/math/bv/OBBRSS.h>
#include <fcl/narrowphase/collision_object.h>
#include <fcl/narrowphase/collision_request.h>
#include <fcl/narrowphase/collision_result.h>
#include <fcl/narrowphase/detail/traversal/collision/mesh_collision_traversal_node.h>
#include <fcl/narrowphase/detail/traversal/collision_node.h>

#include <algorithm>
#include <limits>
#include <utility>

#include "experiments/peers/fcl_parts.h"
#include "experiments/peers/parts.h"
#include "verify/exact.h"

namespace farcull {
namespace {

template <class Scalar>
using FclObject = fcl::CollisionObject<Scalar>;

/// The pairs of triangles that fcl::collide() finds between two models. This calls the function
/// that fcl::collide() calls once it has looked up the kinds of the two; calling fcl::collide()
/// would compile its table for all kinds of shapes in float, which Debian's library is without.
template <class Scalar, class Model>
void collide_two(const Model& a, const Model& b, std::vector<TrianglePair>& pairs) {
  const fcl::CollisionRequest<Scalar> request(std::numeric_limits<std::size_t>::max(), false);
  fcl::CollisionResult<Scalar> result;
  const auto still = fcl::Transform3<Scalar>::Identity();
  fcl::detail::MeshCollisionTraversalNodeOBBRSS<Scalar> node;
  if (!fcl::detail::initialize(node, *a.hierarchy, still, *b.hierarchy, still, request, result)) {
    throw Error(kFclLibrary, "compares no two of its hierarchies", "build farcull without FCL");
  }
  fcl::detail::collide(&node);
  std::vector<fcl::Contact<Scalar>> contacts;
  result.getContacts(contacts);
  pairs.reserve(pairs.size() + contacts.size());
  for (const fcl::Contact<Scalar>& contact : contacts) {
    pairs.push_back({a.first + static_cast<std::uint32_t>(contact.b1),
                     b.first + static_cast<std::uint32_t>(contact.b2)});
  }
}

/// The objects whose boxes meet, by FCL's broad phase.
template <class Scalar>
std::vector<std::pair<std::size_t, std::size_t>> meeting(
    std::vector<std::unique_ptr<FclObject<Scalar>>>& objects) {
  std::vector<std::pair<std::size_t, std::size_t>> pairs;
  if (objects.size() < 2) return pairs;
  fcl::DynamicAABBTreeCollisionManager<Scalar> manager;
  for (auto& object : objects) manager.registerObject(object.get());
  manager.setup();
  manager.collide(&pairs, [](FclObject<Scalar>* a, FclObject<Scalar>* b, void* data) {
    static_cast<decltype(pairs)*>(data)->emplace_back(
        reinterpret_cast<std::size_t>(a->getUserData()),
        reinterpret_cast<std::size_t>(b->getUserData()));
    return false;  // there may be more
  });
  return pairs;
}

template <class Scalar>
BenchAnswer collide(const Scene& scene, unsigned threads) {
  using Model = FclModel<fcl::OBBRSS<Scalar>>;
  const Stopwatch building;
  std::vector<const Object*> objects;
  for (const Object& object : scene.objects) {
    if (object.triangle_count > 0) objects.push_back(&object);
  }
  std::vector<Model> models(objects.size());
  std::vector<std::unique_ptr<FclObject<Scalar>>> placed(objects.size());
  for_each_taken(objects.size(), 1, threads, [&](std::size_t i) {
    models[i] = fcl_model<fcl::OBBRSS<Scalar>>(scene, *objects[i]);
    placed[i] = std::make_unique<FclObject<Scalar>>(models[i].hierarchy);
    placed[i]->setUserData(reinterpret_cast<void*>(i));
  });

  BenchAnswer answer;
  answer.build_ms = building.ms();
  const Stopwatch finding;
  std::vector<std::pair<std::size_t, std::size_t>> tasks = meeting<Scalar>(placed);
  for (std::size_t i = 0; i < objects.size(); ++i) {
    if (objects[i]->self) tasks.emplace_back(i, i);
  }
  std::vector<std::vector<TrianglePair>> found(tasks.size());
  for_each_taken(tasks.size(), 1, threads, [&](std::size_t i) {
    const auto [a, b] = tasks[i];
    collide_two<Scalar>(models[a], models[b], found[i]);
    if (a != b) return;
    // A model with itself: every pair in both orders, every triangle with itself and with its
    // neighbours.
    std::erase_if(found[i], [&scene](const TrianglePair& pair) {
      return pair.a >= pair.b || share_position(scene.corners(pair.a), scene.corners(pair.b));
    });
  });
  for (const std::vector<TrianglePair>& some : found) {
    for (const TrianglePair& pair : some) {
      answer.pairs.push_back({std::min(pair.a, pair.b), std::max(pair.a, pair.b)});
    }
  }
  std::sort(answer.pairs.begin(), answer.pairs.end());
  answer.candidates_ms = finding.ms();
  answer.candidate_pairs = answer.pairs.size();
  return answer;
}

template <class Scalar>
Peer peer(const std::string& name) {
  return {name, kFclLibrary, "", [](unsigned threads) -> BenchRun {
            return [=](const Scene& scene) { return collide<Scalar>(scene, threads); };
          }};
}

}  // namespace

std::vector<Peer> fcl_narrow_peers() {
  return {peer<float>("fcl-float"), peer<double>("fcl-double")};
}

}  // namespace farcull
