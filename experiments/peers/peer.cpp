// The list of peers, with entries for libraries that this build is without.
#include "experiments/peers/peer.h"

#include <iterator>
#include <utility>

#include "experiments/peers/distance_peers.h"

namespace farcull {
namespace {

#if !FARCULL_WITH_FCL || !FARCULL_WITH_EMBREE || !FARCULL_WITH_BULLET || !FARCULL_WITH_ODE
Peer missing(const std::string& name, const std::string& library, const std::string& debian) {
  return {.name = name,
          .library = library,
          .missing = "built without " + library + " (Debian: " + debian + ")"};
}
#endif

}  // namespace

#if !FARCULL_WITH_FCL
std::vector<Peer> fcl_peers() {
  return {missing("fcl-obbrss", "FCL", "libfcl-dev"), missing("fcl-obb", "FCL", "libfcl-dev"),
          missing("fcl-aabb", "FCL", "libfcl-dev")};
}

std::vector<Peer> fcl_narrow_peers() {
  return {missing("fcl-float", "FCL", "libfcl-dev"), missing("fcl-double", "FCL", "libfcl-dev")};
}

std::vector<DistancePeer> fcl_distance_peers() {
  const std::string missing = "built without FCL (Debian: libfcl-dev)";
  return {{.name = "fcl-double", .library = "FCL", .missing = missing},
          {.name = "fcl-float", .library = "FCL", .missing = missing, .comparable = false}};
}
#endif

#if !FARCULL_WITH_EMBREE
std::vector<Peer> embree_peers() {
  return {missing("embree-low", "Embree 3", "libembree-dev"),
          missing("embree-medium", "Embree 3", "libembree-dev")};
}

std::vector<DistancePeer> embree_distance_peers() {
  return {{.name = "embree-points",
           .library = "Embree 3",
           .missing = "built without Embree 3 (Debian: libembree-dev)",
           .comparable = false}};
}
#endif

#if !FARCULL_WITH_BULLET
std::vector<Peer> bullet_peers() {
  return {missing("bullet-gimpact", "Bullet in double", "libbullet-dev")};
}
#endif

#if !FARCULL_WITH_ODE
std::vector<Peer> ode_narrow_peers() { return {missing("ode-trimesh", "ODE", "libode-dev")}; }
#endif

std::vector<Peer> narrow_peers() {
  std::vector<Peer> all = fcl_narrow_peers();
  for (Peer& peer : ode_narrow_peers()) all.push_back(std::move(peer));
  return all;
}

std::vector<DistancePeer> distance_peers() {
  std::vector<DistancePeer> all = fcl_distance_peers();
  for (std::vector<DistancePeer> some : {cgal_distance_peers(), embree_distance_peers()})
    all.insert(all.end(), std::move_iterator(some.begin()), std::move_iterator(some.end()));
  return all;
}

std::vector<Peer> all_peers(unsigned threads) {
  std::vector<Peer> all = cgal_peers(threads);
  for (std::vector<Peer> some :
       {cgal_self_peers(threads), fcl_peers(), embree_peers(), bullet_peers()}) {
    all.insert(all.end(), std::move_iterator(some.begin()), std::move_iterator(some.end()));
  }
  return all;
}

}  // namespace farcull
