// Distances by FCL, as its users ask for them: OBBRSS hierarchies, and its dynamic tree of boxes
// where the nearest of many objects is asked for.
#include <fcl/broadphase/broadphase_dynamic_AABB_tree.h>
#include <fcl/math/bv/OBBRSS.h>
#include <fcl/narrowphase/collision_object.h>
#include <fcl/narrowphase/detail/traversal/collision_node.h>
#include <fcl/narrowphase/detail/traversal/distance/mesh_distance_traversal_node.h>
#include <fcl/narrowphase/distance_request.h>
#include <fcl/narrowphase/distance_result.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <utility>

#include "core/base/stopwatch.h"
#include "experiments/peers/distance_peers.h"
#include "experiments/peers/fcl_parts.h"
#include "experiments/peers/parts.h"
#include "verify/exact.h"

namespace farcull {
namespace {

template <class Scalar>
using FclObject = fcl::CollisionObject<Scalar>;
template <class Scalar>
using Model = FclModel<fcl::OBBRSS<Scalar>>;

/// The distance that fcl::distance() gives two models; infinity where it finds none below `most`.
/// This calls the function that fcl::distance() calls once it has looked up the kinds of the two,
/// as in fcl_narrow.cpp.
template <class Scalar>
Scalar distance_of(const Model<Scalar>& a, const Model<Scalar>& b, Scalar most) {
  const fcl::DistanceRequest<Scalar> request(true);  // the nearest points too
  fcl::DistanceResult<Scalar> result(most);
  const auto still = fcl::Transform3<Scalar>::Identity();
  fcl::detail::MeshDistanceTraversalNodeOBBRSS<Scalar> node;
  if (!fcl::detail::initialize(node, *a.hierarchy, still, *b.hierarchy, still, request, result)) {
    throw Error(kFclLibrary, "compares no two of its hierarchies", "build farcull without FCL");
  }
  fcl::detail::distance(&node);
  if (result.b1 == fcl::DistanceResult<Scalar>::NONE)
    return std::numeric_limits<Scalar>::infinity();
  return std::max(result.min_distance, Scalar(0));  // below 0: they meet
}

/// FCL finds what is nearer than this: anything that is at most `within`.
template <class Scalar>
Scalar most_of(double within) {
  constexpr auto kMost = std::numeric_limits<Scalar>::max();
  if (!(within < static_cast<double>(kMost))) return kMost;
  return std::nextafter(static_cast<Scalar>(within), kMost);
}

template <class Scalar>
class Objects {
 public:
  Objects(const Scene& scene, unsigned threads) {
    for (std::uint32_t o = 0; o < scene.objects.size(); ++o) {
      if (scene.objects[o].triangle_count > 0) number_.push_back(o);
    }
    models_.resize(number_.size());
    placed_.resize(number_.size());
    for_each_taken(number_.size(), 1, threads, [&](std::size_t i) {
      models_[i] = fcl_model<fcl::OBBRSS<Scalar>>(scene, scene.objects[number_[i]]);
      placed_[i] = std::make_unique<FclObject<Scalar>>(models_[i].hierarchy);
      placed_[i]->setUserData(reinterpret_cast<void*>(i));
    });
  }

  std::vector<PeerDistance> every_two(double within, unsigned threads) const {
    std::vector<std::pair<std::size_t, std::size_t>> tasks;
    for (std::size_t i = 0; i < number_.size(); ++i) {
      for (std::size_t k = i + 1; k < number_.size(); ++k) tasks.emplace_back(i, k);
    }
    const auto most = most_of<Scalar>(within);
    std::vector<PeerDistance> out(tasks.size());
    for_each_taken(tasks.size(), 1, threads, [&](std::size_t t) {
      const auto [i, k] = tasks[t];
      out[t] = {number_[i], number_[k], distance_of(models_[i], models_[k], most)};
    });
    std::erase_if(out, [within](const PeerDistance& d) { return d.distance > within; });
    return out;
  }

  std::vector<PeerDistance> nearest(double within, unsigned threads) {
    if (number_.size() < 2) return {};
    fcl::DynamicAABBTreeCollisionManager<Scalar> manager;
    for (auto& object : placed_) manager.registerObject(object.get());
    manager.setup();
    std::vector<PeerDistance> out(number_.size());
    for_each_taken(number_.size(), 1, threads, [&](std::size_t i) {
      Search search{this, i, i, most_of<Scalar>(within)};
      manager.distance(placed_[i].get(), &search, visit);
      out[i] = {number_[i], number_[search.nearest],
                search.nearest == i ? std::numeric_limits<double>::infinity() : search.least};
    });
    std::erase_if(out, [within](const PeerDistance& d) {
      return d.distance > within || std::isinf(d.distance);
    });
    return out;
  }

 private:
  struct Search {
    const Objects* objects;
    std::size_t of, nearest;
    Scalar least;
  };
  // Called with the object of the search and another one; true ends the search.
  static bool visit(FclObject<Scalar>* a, FclObject<Scalar>* b, void* data, Scalar& least) {
    auto& search = *static_cast<Search*>(data);
    const auto i = reinterpret_cast<std::size_t>(a->getUserData());
    const auto k = reinterpret_cast<std::size_t>(b->getUserData());
    const std::size_t other = i == search.of ? k : i;
    if (other != search.of) {
      const auto& models = search.objects->models_;
      const Scalar found = distance_of(models[search.of], models[other], search.least);
      if (found < search.least) {
        search.least = found;
        search.nearest = other;
      }
    }
    least = search.least;
    return search.least <= 0;
  }

  std::vector<std::uint32_t> number_;  // of the objects that have triangles
  std::vector<Model<Scalar>> models_;
  std::vector<std::unique_ptr<FclObject<Scalar>>> placed_;
};

template <class Scalar>
PeerDistances ask(const Scene& scene, const PeerQuestion& question, unsigned threads) {
  const Stopwatch building;
  Objects<Scalar> objects(scene, threads);
  PeerDistances answer{.build_ms = building.ms()};
  const Stopwatch asking;
  answer.distances = question.task == DistanceTask::objects
                         ? objects.every_two(question.within, threads)
                         : objects.nearest(question.within, threads);
  answer.query_ms = asking.ms();
  return answer;
}

std::string refuses_degenerate(const Scene& scene) {
  return degenerate_triangles(scene) == 0 ? ""
                                          : "oriented boxes of degenerate triangles have no axes";
}

}  // namespace

std::vector<DistancePeer> fcl_distance_peers() {
  return {{.name = "fcl-double",
           .library = kFclLibrary,
           .run = ask<double>,
           .refuses = refuses_degenerate},
          {.name = "fcl-float",
           .library = kFclLibrary,
           .comparable = false,
           .run = ask<float>,
           .refuses = refuses_degenerate}};
}

}  // namespace farcull
