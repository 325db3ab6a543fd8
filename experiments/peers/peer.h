// Other libraries, which a user would take instead of farcull: what `farcull bench` and the studies
// compare with, in the process. One file per library adapts it; peer.cpp lists what they give.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <limits>
#include <string>
#include <vector>

#include "core/scene/scene.h"

namespace farcull {

struct BenchAnswer {
  double build_ms = 0;       // of a hierarchy, where there is one
  double candidates_ms = 0;  // finding the candidates
  double exact_ms = 0;  // deciding them; where several threads do so between finding, their sum
                        // divided by the threads
  std::uint64_t candidate_pairs = 0;     // given to the exact decision
  std::vector<TrianglePair> pairs = {};  // sorted, each once
};

/// Goes from the triangles to the pairs. Throws Error where it cannot vouch for its answer.
using BenchRun = std::function<BenchAnswer(const Scene&)>;

/// Goes from the triangles of a scene to pairs of triangles of different objects, and of one object
/// where it is `self`, that collide and are not neighbours (verify/exact.h).
struct Peer {
  std::string name;     // as in --peers
  std::string library;  // with its version, such as "CGAL 5.5.1"
  std::string
      missing;  // why this build or this number of threads is without it; empty: it is there
  std::function<BenchRun(unsigned threads)> set_up = {};  // devices, pools; not timed with the run
  std::function<std::string(const Scene&)> refuses = {};  // why it is not exact on such a scene;
                                                          // empty: it is. Null: on all
};

/// objects: every two objects that have triangles. nearest: each of them and the nearest other one.
enum class DistanceTask : std::uint8_t { objects, nearest };

struct PeerQuestion {
  DistanceTask task = DistanceTask::objects;
  double within = std::numeric_limits<double>::infinity();  // world units: farther ones may be left
                                                            // out
};

/// With `objects` a < b; with `nearest` b is the object that is nearest to a.
struct PeerDistance {
  std::uint32_t a = 0, b = 0;
  double distance = 0;  // as the library gives it, but 0 where it says that they meet
  bool operator==(const PeerDistance&) const = default;
};

struct PeerDistances {
  double build_ms = 0;                       // of hierarchies
  double query_ms = 0;                       // of everything behind it
  std::vector<PeerDistance> distances = {};  // sorted by a, then b
};

/// Goes from the triangles of a scene to distances between its objects. All libraries round, so
/// their distances may be off, which `farcull bench --distances` measures too. Pairs of objects are
/// divided over the threads; one query has one thread.
struct DistancePeer {
  std::string name;          // as in --peers
  std::string library;       // with its version
  std::string missing = {};  // why this build is without it; empty: it is there
  /// False: it answers in floats, or bounds distances from above alone, so it is no measure of how
  /// fast distances can be had.
  bool comparable = true;
  std::function<PeerDistances(const Scene&, const PeerQuestion&, unsigned threads)> run = {};
  std::function<std::string(const Scene&)> refuses = {};  // why it cannot be asked about such a
                                                          // scene; empty: it can. Null: about all
};

/// Broad phases, each followed by the exact decisions of verify/exact.h, but for CGAL's
/// self_intersections(), which decides exactly by itself. They run at their best settings. Whatever
/// can be divided runs on the threads of the bench, and candidates are decided in bounded parts, so
/// that tens of millions of overlapping boxes are never stored. Those included that this build was
/// made without. `threads` >= 1.
std::vector<Peer> all_peers(unsigned threads);

/// Libraries as their users run them, with their own inexact test of two triangles, so that pairs
/// may be missed or wrong. fcl-float and fcl-double are FCL's OBBRSS hierarchies and fcl::collide()
/// on coordinates rounded to that type. ode-trimesh is the contacts of ODE's dCollide().
/// BenchAnswer::pairs is what the library reports, without neighbours (verify/exact.h) inside an
/// object that is `self`; candidate_pairs is their number. One traversal has one thread; FCL's
/// pairs of objects are divided over the threads. Not among all_peers(), whose answers are exact;
/// `refuses` names what a library does not do at all, since they vouch for nothing.
std::vector<Peer> narrow_peers();

/// Distances, those included that this build was made without.
///   fcl-double, fcl-float  FCL's distance() of two OBBRSS hierarchies; with `nearest` behind its
///                          dynamic tree of boxes
///   cgal-aabb              each triangle of one object against CGAL's AABB_tree of the other, with
///                          squared_distance() of two triangles in doubles
///   embree-points          Embree's rtcPointQuery from every vertex of each object to the other
///                          one's triangles, in floats. Edges are not asked against edges, so it
///                          bounds the distance from above, and objects that cross are not 0
std::vector<DistancePeer> distance_peers();

/// The adapter of one library gives parts of the three lists above.
struct LibraryPeers {
  std::vector<Peer> broad = {}, narrow = {};
  std::vector<DistancePeer> distances = {};
};
LibraryPeers cgal_library(unsigned threads);
LibraryPeers fcl_library();
LibraryPeers embree_library();
LibraryPeers bullet_library();
LibraryPeers ode_library();

/// CGAL's exact predicate by itself, as its users call it: what decide() falls back to. Neither may
/// be degenerate.
bool cgal_do_intersect(const std::array<Vec3, 3>& a, const std::array<Vec3, 3>& b);

}  // namespace farcull
