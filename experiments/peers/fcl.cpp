// FCL, in four ways.
// - broad: FCL's hierarchies, followed by exact decisions.
// - narrow: FCL as its users run it, with FCL's own test of two triangles, which rounds.
// - poses: the same as narrow, but the hierarchies are kept while objects move.
// - distances: FCL's distances between objects.
// The compiled library has FCL's templates only in double. The templates in float are instantiated
// here.
#include <fcl/broadphase/broadphase_dynamic_AABB_tree.h>
#include <fcl/config.h>
#include <fcl/geometry/bvh/BVH_model.h>
#include <fcl/math/bv/OBB.h>
#include <fcl/math/bv/OBBRSS.h>
#include <fcl/narrowphase/collision_object.h>
#include <fcl/narrowphase/collision_request.h>
#include <fcl/narrowphase/collision_result.h>
#include <fcl/narrowphase/detail/traversal/collision/mesh_collision_traversal_node.h>
#include <fcl/narrowphase/detail/traversal/collision_node.h>
#include <fcl/narrowphase/detail/traversal/distance/mesh_distance_traversal_node.h>
#include <fcl/narrowphase/distance_request.h>
#include <fcl/narrowphase/distance_result.h>

#include <algorithm>
#include <cmath>

#include "core/base/error.h"
#include "experiments/peers/peer.h"
#include "verify/exact.h"

namespace farcull {
namespace {

constexpr const char* kLibrary = "FCL " FCL_VERSION;

/// The hierarchy of one object, with the interface for search_trees(). Primitive i is triangle
/// first + i. size() makes search_trees() divide the larger of two nodes first, as FCL does.
template <class Volume>
struct Model {
  std::shared_ptr<fcl::BVHModel<Volume>> hierarchy;
  std::uint32_t first = 0;

  bool is_leaf(int node) const { return hierarchy->getBV(node).isLeaf(); }
  int left(int node) const { return hierarchy->getBV(node).leftChild(); }
  int right(int node) const { return hierarchy->getBV(node).rightChild(); }
  double size(int node) const { return hierarchy->getBV(node).bv.size(); }
  std::uint32_t triangle(int leaf) const {
    return first + static_cast<std::uint32_t>(hierarchy->getBV(leaf).primitiveId());
  }
  bool meets(int node, const Model& other, int other_node) const {
    return hierarchy->getBV(node).overlap(other.hierarchy->getBV(other_node));
  }
};

/// Builds the hierarchy of an object. Rounds each coordinate to the nearest value of the volume's
/// scalar type. Precondition: the object has triangles. Throws Error if FCL cannot build the
/// hierarchy.
template <class Volume>
Model<Volume> model_of(const Scene& scene, const Object& object) {
  const auto triangles =
      std::span(scene.triangles).subspan(object.first_triangle, object.triangle_count);
  const auto [least, most] = vertices_of(scene, object);
  std::vector<fcl::Vector3<typename Volume::S>> points;
  points.reserve(most - least + 1);
  for (std::uint32_t v = least; v <= most; ++v) {
    points.push_back(scene.vertices[v].template cast<typename Volume::S>());
  }
  std::vector<fcl::Triangle> faces;
  faces.reserve(triangles.size());
  for (const auto& [a, b, c] : triangles) faces.emplace_back(a - least, b - least, c - least);
  Model<Volume> model{std::make_shared<fcl::BVHModel<Volume>>(), object.first_triangle};
  const auto count = static_cast<int>(faces.size());
  if (model.hierarchy->beginModel(count, static_cast<int>(points.size())) != fcl::BVH_OK ||
      model.hierarchy->addSubModel(points, faces) != fcl::BVH_OK ||
      model.hierarchy->endModel() != fcl::BVH_OK) {
    throw Error(kLibrary, "builds no hierarchy of this object", "leave it out with --peers");
  }
  return model;
}

using IndexPair = std::pair<std::size_t, std::size_t>;

/// The objects of a scene that have triangles, with FCL's broad phase for these objects.
template <class Volume>
struct Objects {
  using Scalar = typename Volume::S;
  using Placed = fcl::CollisionObject<Scalar>;
  using Manager = fcl::DynamicAABBTreeCollisionManager<Scalar>;

  Objects(const Scene& scene, unsigned threads)
      : numbers(objects_with_triangles(scene)), models(numbers.size()), placed(numbers.size()) {
    for_each_shared(numbers.size(), threads, [&](std::size_t i) {
      models[i] = model_of<Volume>(scene, scene.objects[numbers[i]]);
      placed[i] = std::make_unique<Placed>(models[i].hierarchy);
      placed[i]->setUserData(reinterpret_cast<void*>(i));
    });
  }

  static std::size_t index_of(const Placed* object) {
    return reinterpret_cast<std::size_t>(object->getUserData());
  }
  void register_in(Manager& manager) const {
    for (const auto& object : placed) manager.registerObject(object.get());
    manager.setup();
  }
  /// Returns the pairs of objects whose boxes overlap.
  std::vector<IndexPair> meeting() const {
    if (placed.size() < 2) return {};
    Manager manager;
    register_in(manager);
    return meeting_in(manager);
  }
  static std::vector<IndexPair> meeting_in(const Manager& manager) {
    std::vector<IndexPair> pairs;
    manager.collide(&pairs, [](Placed* a, Placed* b, void* data) {
      static_cast<std::vector<IndexPair>*>(data)->emplace_back(index_of(a), index_of(b));
      return false;  // true would end the search
    });
    return pairs;
  }

  std::vector<std::uint32_t> numbers;  // numbers of these objects in the scene
  std::vector<Model<Volume>> models;
  std::vector<std::unique_ptr<Placed>> placed;
};

/// Finds candidates: pairs of leaves of FCL's hierarchies that overlap by FCL's tests of volumes.
/// FCL's own traversal is not used, since it has one thread and does not test a model with itself.
template <class Volume>
BenchAnswer candidates_of(const Scene& scene, unsigned threads) {
  const Stopwatch building;
  const Objects<Volume> objects(scene, threads);
  const double build_ms = building.ms();

  PeerCandidates candidates(scene, threads, threads > 1);
  const std::vector<Model<Volume>>& trees = objects.models;
  std::vector<TreeTask<Model<Volume>>> tasks;
  for (std::size_t i = 0; i < trees.size(); ++i) {
    if (scene.objects[objects.numbers[i]].self) tasks.push_back({&trees[i], &trees[i], 0, 0, true});
  }
  const std::vector<IndexPair> meeting =
      trees.size() == 2 ? std::vector<IndexPair>{{0, 1}} : objects.meeting();
  for (const auto& [i, j] : meeting) tasks.push_back({&trees[i], &trees[j]});
  search_trees(scene, std::move(tasks), threads, candidates);
  return candidates.finish(build_ms);
}

/// Sets up FCL's traversal of the hierarchies of two objects at their current poses.
template <class Node, class Volume, class Request, class Result>
void initialize(Node& node, const Objects<Volume>& objects, std::size_t a, std::size_t b,
                const Request& request, Result& result) {
  if (!fcl::detail::initialize(node, *objects.models[a].hierarchy,
                               objects.placed[a]->getTransform(), *objects.models[b].hierarchy,
                               objects.placed[b]->getTransform(), request, result)) {
    throw Error(kLibrary, "compares no two of its hierarchies", "build farcull without FCL");
  }
}

/// Adds the pairs of triangles that FCL finds between two objects. Calls the inner function that
/// fcl::collide() would call. Debian's library has no code for float, so a call of fcl::collide()
/// in float would compile code for all kinds of shapes.
template <class Scalar>
void collide_two(const Objects<fcl::OBBRSS<Scalar>>& objects, std::size_t a, std::size_t b,
                 std::vector<TrianglePair>& pairs) {
  const fcl::CollisionRequest<Scalar> request(std::numeric_limits<std::size_t>::max(), false);
  fcl::CollisionResult<Scalar> result;
  fcl::detail::MeshCollisionTraversalNodeOBBRSS<Scalar> node;
  initialize(node, objects, a, b, request, result);
  fcl::detail::collide(&node);
  std::vector<fcl::Contact<Scalar>> contacts;
  result.getContacts(contacts);
  pairs.reserve(pairs.size() + contacts.size());
  for (const fcl::Contact<Scalar>& contact : contacts) {
    pairs.push_back({objects.models[a].first + static_cast<std::uint32_t>(contact.b1),
                     objects.models[b].first + static_cast<std::uint32_t>(contact.b2)});
  }
}

/// Returns all pairs that the tasks found, sorted. In each pair the lower index is first.
std::vector<TrianglePair> sorted(const std::vector<std::vector<TrianglePair>>& found) {
  std::vector<TrianglePair> out;
  for (const std::vector<TrianglePair>& some : found) {
    for (const TrianglePair& pair : some)
      out.push_back({std::min(pair.a, pair.b), std::max(pair.a, pair.b)});
  }
  std::sort(out.begin(), out.end());
  return out;
}

/// Finds pairs by FCL's own broad phase, hierarchies and triangle test.
template <class Scalar>
BenchAnswer collide(const Scene& scene, unsigned threads) {
  const Stopwatch building;
  const Objects<fcl::OBBRSS<Scalar>> objects(scene, threads);
  BenchAnswer answer;
  answer.build_ms = building.ms();
  const Stopwatch finding;
  std::vector<IndexPair> tasks = objects.meeting();
  for (std::size_t i = 0; i < objects.numbers.size(); ++i) {
    if (scene.objects[objects.numbers[i]].self) tasks.emplace_back(i, i);
  }
  std::vector<std::vector<TrianglePair>> found(tasks.size());
  for_each_shared(tasks.size(), threads, [&](std::size_t i) {
    const auto [a, b] = tasks[i];
    collide_two(objects, a, b, found[i]);
    if (a != b) return;
    // For a model against itself, FCL reports every pair as (a, b) and as (b, a). It also reports
    // each triangle with itself and with its neighbours.
    std::erase_if(found[i], [&scene](const TrianglePair& pair) {
      return pair.a >= pair.b || share_position(scene.corners(pair.a), scene.corners(pair.b));
    });
  });
  answer.pairs = sorted(found);
  answer.candidates_ms = finding.ms();
  answer.candidate_pairs = answer.pairs.size();
  return answer;
}

/// Builds the hierarchies and the broad phase. Returns a function that keeps both and moves the
/// objects in each call.
PoseRun set_up_poses(const Scene& scene, unsigned threads) {
  using All = Objects<fcl::OBBRSS<double>>;
  struct Kept {
    All objects;
    All::Manager manager;
  };
  const std::shared_ptr<Kept> kept(new Kept{All(scene, threads), {}});
  kept->objects.register_in(kept->manager);
  return [kept, threads](std::span<const RigidMotion> motions) {
    const All& objects = kept->objects;
    for (std::size_t i = 0; i < objects.placed.size(); ++i) {
      const auto& [r, t] = motions[objects.numbers[i]];
      fcl::Transform3<double> to = fcl::Transform3<double>::Identity();
      to.linear() << r[0], r[1], r[2], r[3], r[4], r[5], r[6], r[7], r[8];
      to.translation() << t[0], t[1], t[2];
      objects.placed[i]->setTransform(to);
      objects.placed[i]->computeAABB();
    }
    kept->manager.update();
    const std::vector<IndexPair> tasks = All::meeting_in(kept->manager);
    std::vector<std::vector<TrianglePair>> found(tasks.size());
    for_each_shared(tasks.size(), threads, [&](std::size_t i) {
      collide_two(objects, tasks[i].first, tasks[i].second, found[i]);
    });
    return sorted(found);
  };
}

/// Returns FCL's distance of two objects, or infinity if the distance is not below `most`. Calls an
/// inner function of FCL, for the same reason as collide_two().
template <class Scalar>
Scalar distance_of(const Objects<fcl::OBBRSS<Scalar>>& objects, std::size_t a, std::size_t b,
                   Scalar most) {
  const fcl::DistanceRequest<Scalar> request(true);  // also computes the nearest points
  fcl::DistanceResult<Scalar> result(most);
  fcl::detail::MeshDistanceTraversalNodeOBBRSS<Scalar> node;
  initialize(node, objects, a, b, request, result);
  fcl::detail::distance(&node);
  if (result.b1 == fcl::DistanceResult<Scalar>::NONE)
    return std::numeric_limits<Scalar>::infinity();
  return std::max(result.min_distance, Scalar(0));  // negative if the models intersect
}

/// Returns a limit for FCL that includes distances up to `within`. FCL finds only distances below
/// the limit, so the limit is the next larger value.
template <class Scalar>
Scalar most_of(double within) {
  constexpr auto kMost = std::numeric_limits<Scalar>::max();
  if (!(within < static_cast<double>(kMost))) return kMost;
  return std::nextafter(static_cast<Scalar>(within), kMost);
}

/// Finds the nearest other object of one object, by FCL's dynamic tree of boxes.
template <class Scalar>
struct Search {
  using Of = Objects<fcl::OBBRSS<Scalar>>;
  const Of* objects;
  std::size_t of, nearest;
  Scalar least;

  /// FCL calls this function with the object of the search and another object. If the function
  /// returned true, the search would end.
  static bool visit(typename Of::Placed* a, typename Of::Placed* b, void* data, Scalar& least) {
    auto& search = *static_cast<Search*>(data);
    const std::size_t i = Of::index_of(a), k = Of::index_of(b);
    const std::size_t other = i == search.of ? k : i;
    if (other != search.of) {
      const Scalar found = distance_of(*search.objects, search.of, other, search.least);
      if (found < search.least) {
        search.least = found;
        search.nearest = other;
      }
    }
    least = search.least;
    return search.least <= 0;
  }
};

template <class Scalar>
std::vector<PeerDistance> nearest(const Objects<fcl::OBBRSS<Scalar>>& objects, Scalar most,
                                  unsigned threads) {
  const std::size_t count = objects.numbers.size();
  if (count < 2) return {};
  typename Objects<fcl::OBBRSS<Scalar>>::Manager manager;
  objects.register_in(manager);
  std::vector<PeerDistance> out(count);
  for_each_shared(count, threads, [&](std::size_t i) {
    Search<Scalar> search{&objects, i, i, most};
    manager.distance(objects.placed[i].get(), &search, Search<Scalar>::visit);
    out[i] = {objects.numbers[i], objects.numbers[search.nearest], search.least};
  });
  std::erase_if(out, [](const PeerDistance& d) { return d.a == d.b; });
  return out;
}

template <class Scalar>
PeerDistances distances(const Scene& scene, const PeerQuestion& question, unsigned threads) {
  const Stopwatch building;
  const Objects<fcl::OBBRSS<Scalar>> objects(scene, threads);
  PeerDistances answer{.build_ms = building.ms()};
  const Stopwatch asking;
  const Scalar most = most_of<Scalar>(question.within);
  if (question.task == DistanceTask::nearest) {
    answer.distances = nearest(objects, most, threads);
  } else {
    answer.distances = distances_of_pairs(
        objects.numbers, threads,
        [&](std::size_t i, std::size_t k) -> double { return distance_of(objects, i, k, most); });
  }
  std::erase_if(answer.distances,
                [&](const PeerDistance& d) { return d.distance > question.within; });
  answer.query_ms = asking.ms();
  return answer;
}

/// Returns why FCL cannot process the scene, or "" if FCL can.
std::string refuses(const Scene& scene) {
  return refuse_degenerate(scene, "oriented boxes of degenerate triangles have no axes");
}

}  // namespace

LibraryPeers fcl_library() {
  return {
      .broad = {plain_peer("fcl-obb", kLibrary, candidates_of<fcl::OBBd>, refuses)},
      .narrow = {plain_peer("fcl-float", kLibrary, collide<float>),
                 plain_peer("fcl-double", kLibrary, collide<double>)},
      .distances = {
          {.name = "fcl-double", .library = kLibrary, .run = distances<double>, .refuses = refuses},
          {.name = "fcl-float",
           .library = kLibrary,
           .comparable = false,
           .run = distances<float>,
           .refuses = refuses}}};
}

PosePeer fcl_poses() {
  return {.name = "fcl-double", .library = kLibrary, .set_up = set_up_poses, .refuses = refuses};
}

}  // namespace farcull
