// Peers are other libraries that a user could use instead of farcull. `farcull bench` and the
// studies compare farcull with peers in one process. One source file adapts each library.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <limits>
#include <memory>
#include <mutex>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "core/base/parallel.h"
#include "core/base/stopwatch.h"
#include "core/boxes/rigid.h"
#include "core/scene/scene.h"

namespace farcull {

struct BenchAnswer {
  double build_ms = 0;                   // time to build hierarchies; 0 without a hierarchy
  double candidates_ms = 0;              // time to find the candidates
  double exact_ms = 0;                   // time to decide the candidates, mean over the threads
  std::uint64_t candidate_pairs = 0;     // number of candidates
  std::vector<TrianglePair> pairs = {};  // sorted, without duplicates
};

/// Computes the colliding pairs of triangles of a scene. Throws Error if a pair might be missed.
using BenchRun = std::function<BenchAnswer(const Scene&)>;

/// A library that finds all colliding pairs of triangles, except neighbours (verify/exact.h). The
/// two triangles are in different objects, or in one object marked `self`.
struct Peer {
  std::string name;     // as in --peers
  std::string library;  // with its version, such as "CGAL 5.5.1"
  std::string missing;  // why the peer cannot run in this build; empty: it can run
  std::function<BenchRun(unsigned threads)> set_up = {};  // creates devices and thread pools
  std::function<std::string(const Scene&)> refuses = {};  // why the peer cannot process the scene;
                                                          // "": it can; null: processes all scenes
};

/// objects: each pair of objects with triangles. nearest: each object and its nearest other object.
enum class DistanceTask : std::uint8_t { objects, nearest };

struct PeerQuestion {
  DistanceTask task = DistanceTask::objects;
  double within = std::numeric_limits<double>::infinity();  // largest distance, in world units
};

/// A distance of two objects. Task `objects`: a < b. Task `nearest`: b is the object nearest to a.
struct PeerDistance {
  std::uint32_t a = 0, b = 0;
  double distance = 0;  // from the library; 0 if the library says that the objects meet
  bool operator==(const PeerDistance&) const = default;
};

struct PeerDistances {
  double build_ms = 0;                       // time to build hierarchies
  double query_ms = 0;                       // time of everything after building
  std::vector<PeerDistance> distances = {};  // sorted by a, then b
};

/// A library that computes distances between the objects of a scene. All libraries round;
/// `farcull bench --distances` measures the errors. The pairs of objects are divided over the
/// threads. One thread computes the distance of a pair. Other members are as in Peer.
struct DistancePeer {
  std::string name, library, missing = {};
  bool comparable = true;  // false: the library computes in float, so times are not comparable
  std::function<PeerDistances(const Scene&, const PeerQuestion&, unsigned threads)> run = {};
  std::function<std::string(const Scene&)> refuses = {};
};

/// Moves each object. Then returns the colliding pairs of triangles of different objects, sorted.
using PoseRun = std::function<std::vector<TrianglePair>(std::span<const RigidMotion> motions)>;

/// A library that keeps models of the objects of a scene while the objects move (farcull bench
/// --poses). The library rounds, like narrow_peers(). Members without a comment are as in Peer.
struct PosePeer {
  std::string name, library = {}, missing = {};
  std::function<PoseRun(const Scene&, unsigned threads)> set_up = {};  // creates the models
  std::function<std::string(const Scene&)> refuses = {};
};

/// Returns why a peer cannot process the scene, or "" if it can.
template <class AnyPeer>
std::string why_left_out(const AnyPeer& peer, const Scene& scene) {
  return peer.missing.empty() && peer.refuses ? peer.refuses(scene) : peer.missing;
}

/// Returns broad phases of libraries, each at its best settings. The predicates of verify/exact.h
/// decide the candidates of each broad phase, in parts of limited size to save memory. Work that
/// can be divided runs on several threads. This function and the next three also return peers that
/// this build does not have.
std::vector<Peer> all_peers();

/// Returns libraries as their users run them, with their own inexact triangle tests. So pairs may
/// be missed or falsely reported. fcl-float and fcl-double use FCL's OBBRSS hierarchies and
/// fcl::collide() on coordinates rounded to float or double. ode-trimesh uses the contacts of ODE's
/// dCollide(). BenchAnswer::pairs has the pairs that the library reports, without neighbours
/// (verify/exact.h). candidate_pairs is the number of these pairs. FCL's pairs of objects are
/// divided over the threads.
std::vector<Peer> narrow_peers();

/// Returns libraries that compute distances.
/// fcl-double, fcl-float: FCL's distance() of two OBBRSS hierarchies. With `nearest`, FCL's dynamic
///   tree of boxes selects the objects.
/// cgal-aabb: each triangle of one object against CGAL's AABB_tree of the other object, with CGAL's
///   squared_distance() of two triangles in doubles.
std::vector<DistancePeer> distance_peers();

/// Returns one peer: fcl-double as in narrow_peers(), except that its hierarchies and its broad
/// phase are kept between calls.
std::vector<PosePeer> pose_peers();

/// The peers of one library, as its adapter provides them for the lists above.
struct LibraryPeers {
  std::vector<Peer> broad = {}, narrow = {};
  std::vector<DistancePeer> distances = {};
};
LibraryPeers cgal_library();
LibraryPeers fcl_library();
LibraryPeers embree_library();
LibraryPeers bullet_library();
LibraryPeers ode_library();
PosePeer fcl_poses();

// Functions and classes for the source files that adapt libraries.

/// Returns a peer that needs no setup. Each run calls run(scene, threads).
Peer plain_peer(const std::string& name, const std::string& library,
                BenchAnswer (*run)(const Scene&, unsigned threads),
                std::function<std::string(const Scene&)> refuses = {});

/// Returns the numbers of the objects that have triangles, ascending.
std::vector<std::uint32_t> objects_with_triangles(const Scene& scene);

/// Returns `reason` if the scene has degenerate triangles, else "".
std::string refuse_degenerate(const Scene& scene, const char* reason);

/// Data that a peer computes from a scene: the boxes of the triangles, and which pairs of triangles
/// are tested. The time for this computation counts as time of the peer.
struct PeerScene {
  /// with_boxes: false for a peer that makes its own boxes.
  explicit PeerScene(const Scene& scene, bool with_boxes = true);

  const Scene& scene;
  std::vector<Box> boxes;            // one per triangle
  std::vector<std::uint32_t> owner;  // one per triangle: the number of its object
  bool two_sides = false;            // exactly two objects have triangles, and no object is `self`
  std::uint32_t second = 0;          // if two_sides, the second object's first triangle; else 0

  /// True if the pair (a, b) is tested. Triangles of one object that share a vertex index are not
  /// tested. The exact decision later removes triangles that share a vertex position.
  bool counts(std::uint32_t a, std::uint32_t b) const {
    return owner[a] != owner[b] ||
           (scene.objects[owner[a]].self && !share_index(scene.triangles[a], scene.triangles[b]));
  }
  /// True if counts() is true for at least one pair.
  bool has_pairs() const;
};

/// Collects candidates from one or several threads. Decides a part of the candidates when the part
/// is full. finish() decides the remaining candidates on all threads.
class PeerCandidates {
 public:
  /// parallel: true if candidates come from several threads. Each thread then decides its own full
  /// parts. If false, candidates come from one thread, and full parts are decided on all threads.
  PeerCandidates(const Scene& scene, unsigned threads, bool parallel);
  ~PeerCandidates();

  /// The candidates of one thread; valid until finish(). add() takes no lock.
  class Part {
   public:
    void add(std::uint32_t a, std::uint32_t b) {
      pending_.push_back(a < b ? TrianglePair{a, b} : TrianglePair{b, a});
      if (pending_.size() == kFull) decide(all_.parallel_ ? 1 : all_.threads_);
    }

   private:
    friend class PeerCandidates;
    explicit Part(const PeerCandidates& all) : all_(all) {}
    void decide(unsigned threads);

    const PeerCandidates& all_;
    std::vector<TrianglePair> pending_;
    std::vector<TrianglePair> pairs_;
    std::uint64_t decided_ = 0;
    double exact_ms_ = 0;
  };
  Part& part();

  /// Returns the answer. candidates_ms is the time since construction minus exact_ms.
  BenchAnswer finish(double build_ms = 0);

 private:
  static constexpr std::size_t kFull = std::size_t{1} << 17;  // 1 MiB of candidates
  const Scene& scene_;
  const unsigned threads_;
  const bool parallel_;
  const std::uint64_t id_;  // different for every PeerCandidates of a process
  const Stopwatch since_;
  std::mutex mutex_;  // protects parts_
  std::vector<std::unique_ptr<Part>> parts_;
};

/// A task of search_trees(): compare all leaves below node `a` of tree `first` with all leaves
/// below node `b` of tree `second`. For libraries whose own traversal has only one thread.
///
/// A node is an int, and the root is 0. A Tree has the functions is_leaf(node), left(node),
/// right(node), triangle(leaf), size(node), and meets(node, other tree, node of the other tree). Of
/// two nodes, the node with the larger size() is divided. meets() is true if triangles of the two
/// nodes could intersect.
template <class Tree>
struct TreeTask {
  const Tree* first;
  const Tree* second;
  int a = 0;
  int b = 0;
  bool inner = false;  // true: compares the leaves below a with each other; first == second, a == b
};

/// Does one step of a search. If the volumes of the two nodes are disjoint, does nothing. If the
/// nodes are leaves, calls `found`. Else divides the larger node and gives the new tasks to `next`.
template <class Tree, class Found, class Next>
void step(const TreeTask<Tree>& task, const Found& found, const Next& next) {
  const Tree& first = *task.first;
  const Tree& second = *task.second;
  const auto with = [&](int left, int right, bool inner = false) {
    next(TreeTask<Tree>{&first, &second, left, right, inner});
  };
  if (task.inner) {
    if (first.is_leaf(task.a)) return;
    const int left = first.left(task.a), right = first.right(task.a);
    with(left, left, true);
    with(right, right, true);
    with(left, right);
    return;
  }
  if (!first.meets(task.a, second, task.b)) return;
  const bool leaf = first.is_leaf(task.a), other_leaf = second.is_leaf(task.b);
  if (leaf && other_leaf) {
    found(first.triangle(task.a), second.triangle(task.b));
  } else if (other_leaf || (!leaf && first.size(task.a) > second.size(task.b))) {
    with(first.left(task.a), task.b);
    with(first.right(task.a), task.b);
  } else {
    with(task.a, second.left(task.b));
    with(task.a, second.right(task.b));
  }
}

template <class Tree, class Found>
void descend(const TreeTask<Tree>& task, const Found& found) {
  step(task, found, [&found](const TreeTask<Tree>& next) { descend(next, found); });
}

/// Adds the candidates of all tasks to `candidates`. If first == second, leaves out triangles that
/// share a vertex index. Precondition: `candidates` was made with parallel == (threads > 1).
template <class Tree>
void search_trees(const Scene& scene, std::vector<TreeTask<Tree>> tasks, unsigned threads,
                  PeerCandidates& candidates) {
  // Divides tasks until there are enough tasks for all threads.
  const std::size_t enough = threads > 1 ? 64 * threads : 1;
  const auto add = [&](const TreeTask<Tree>& task) {
    return [&scene, &part = candidates.part(), self = task.first == task.second](std::uint32_t a,
                                                                                 std::uint32_t b) {
      if (!self || !share_index(scene.triangles[a], scene.triangles[b])) part.add(a, b);
    };
  };
  while (!tasks.empty() && tasks.size() < enough) {
    std::vector<TreeTask<Tree>> finer;
    for (const TreeTask<Tree>& task : tasks)
      step(task, add(task), [&finer](const TreeTask<Tree>& next) { finer.push_back(next); });
    tasks = std::move(finer);
  }
  for_each_shared(tasks.size(), threads, [&](std::size_t i) { descend(tasks[i], add(tasks[i])); });
}

/// Returns the finite distances of all pairs of objects, sorted. Divides the work over the threads.
/// numbers: the objects' numbers, ascending. distance(i, k): distance of numbers[i] and numbers[k].
std::vector<PeerDistance> distances_of_pairs(
    const std::vector<std::uint32_t>& numbers, unsigned threads,
    const std::function<double(std::size_t i, std::size_t k)>& distance);

}  // namespace farcull
