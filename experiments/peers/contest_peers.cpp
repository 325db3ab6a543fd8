// Contestants: FCL and ODE with their own tests of two triangles, and distances by FCL and CGAL.
#include <algorithm>

#include "experiments/peers/contestant.h"
#include "experiments/peers/peer.h"

namespace farcull {
namespace {

template <class AnyPeer>
void require_taken(const AnyPeer& peer, const Scene& scene) {
  if (const std::string why = why_left_out(peer, scene); !why.empty()) throw Refusal(why);
}

Contestant narrow(const Peer& peer) {
  const auto pairs = [peer, run = peer.set_up(1)](const Scene& scene) {
    require_taken(peer, scene);
    return run(scene).pairs;
  };
  return {.card = crossing_card(peer.name, peer.library),
          .pair = [pairs](const SuitePair& pair) { return !pairs(scene_of(pair)).empty(); },
          .mesh = pairs};
}

/// Returns a function that gives a library's distance of two triangles, without points. Each
/// triangle is an object.
std::function<ContestDistance(const SuitePair&)> distance_by(const DistancePeer& peer) {
  return [peer](const SuitePair& pair) {
    const Scene scene = two_objects(pair);
    require_taken(peer, scene);
    const PeerDistances found = peer.run(scene, {}, 1);
    if (found.distances.empty()) throw Refusal("it gives no distance");
    return ContestDistance{found.distances[0].distance};
  };
}

}  // namespace
}  // namespace farcull

int main(int argc, char** argv) {
  using namespace farcull;
  std::vector<Contestant> all;
  for (const Peer& peer : narrow_peers()) {
    if (peer.missing.empty()) all.push_back(narrow(peer));
  }
  for (const DistancePeer& peer : distance_peers()) {
    if (!peer.missing.empty()) continue;
    const auto same = std::ranges::find(
        all, peer.name, [](const Contestant& contestant) { return contestant.card.name; });
    if (same != all.end())
      same->distance = distance_by(peer);
    else if (peer.name == "cgal-aabb")
      all.push_back(
          {.card = {.name = peer.name, .library = peer.library}, .distance = distance_by(peer)});
  }
  return contest(argc, argv, all);
}
