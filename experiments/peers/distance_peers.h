// Distance queries of other libraries, which a user would ask instead of `farcull distance`: each
// goes from the triangles of a scene to distances between its objects.
//
// All of them round, so their distances may be off, which `farcull bench --distances` measures too.
// Pairs of objects are divided over the threads; one query has one thread.
#pragma once

#include <cstdint>
#include <functional>
#include <limits>
#include <string>
#include <vector>

#include "core/scene/scene.h"

namespace farcull {

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

/// All of them, those included that this build was made without.
///   fcl-double, fcl-float  FCL's distance() of two OBBRSS hierarchies; with `nearest` behind its
///                          dynamic tree of boxes
///   cgal-aabb              each triangle of one object against CGAL's AABB_tree of the other, with
///                          squared_distance() of two triangles in doubles
///   embree-points          Embree's rtcPointQuery from every vertex of each object to the other
///                          one's triangles, in floats. Edges are not asked against edges, so it
///                          bounds the distance from above, and objects that cross are not 0
std::vector<DistancePeer> distance_peers();

/// Their parts, a library each.
std::vector<DistancePeer> fcl_distance_peers();
std::vector<DistancePeer> cgal_distance_peers();
std::vector<DistancePeer> embree_distance_peers();

}  // namespace farcull
