// The libraries of `farcull bench` as contestants: FCL and ODE with their own tests of two
// triangles, and broad phases followed by exact tests. If a pair is lost although the tests are
// exact, the broad phase has lost it.
#include "experiments/peers/peer.h"

#include <algorithm>
#include <memory>

#include "experiments/peers/contestant.h"

namespace farcull {
namespace {

BenchAnswer answer(const Peer& peer, const BenchRun& run, const Scene& scene) {
  if (peer.refuses) {
    const std::string why = peer.refuses(scene);
    if (!why.empty()) throw Refusal(why);
  }
  return run(scene);
}

Contestant contestant(const Peer& peer, ContestantCard card) {
  card.library = peer.library;
  const auto run = std::make_shared<BenchRun>();
  const auto found = [peer, run](const Scene& scene) {
    if (!*run) *run = peer.set_up(1);
    return answer(peer, *run, scene).pairs;
  };
  return {.card = std::move(card),
          .pair = [found](const SuitePair& pair) { return !found(scene_of(pair)).empty(); },
          .mesh = found};
}

Contestant narrow(const Peer& peer) {
  const bool fcl = peer.name.starts_with("fcl");
  ContestantCard card{.name = peer.name, .means = Means::crossing, .degenerate = false};
  if (fcl) {
    card.call =
        "what fcl::collide() calls for two BVHModel<OBBRSS>, all contacts, behind its broad phase; "
        "scalar " +
        peer.name.substr(peer.name.find('-') + 1);
    card.says =
        "nothing of exactness or of touching: \"detecting whether the two models overlap, and "
        "optionally, all of the triangles that overlap\"";
    card.source = "FCL README; fcl/narrowphase/collision.h, collide()";
    card.use =
        "\"proximity queries on a pair of geometric models composed of triangles\"; where a wrong "
        "answer near contact does no harm";
  } else {
    card.call =
        "dCollide() of two trimeshes with 65,535 contacts at most; a mesh of one triangle gets it "
        "twice, since else it has no contacts, and two of them crash; pairs are read from the "
        "contacts, and of those nearer than 1e-4 ODE keeps one";
    card.says =
        "nothing of exactness or of triangles that only touch: \"Trimesh/Trimesh collisions, "
        "perform "
        "quite well, but there are three minor caveats\"; those listed are about time steps";
    card.source =
        "ODE manual, Collision Detection, Triangle Mesh Class; ode/collision.h, dCollide()";
    card.use = "simulation of bodies; \"It works well for relatively large triangles\"";
  }
  return contestant(peer, std::move(card));
}

/// The distance that a library gives for two triangles, each an object of its own. It says no
/// points.
std::function<ContestDistance(const SuitePair&)> distance_by(const DistancePeer& peer) {
  return [peer](const SuitePair& pair) {
    const Scene scene = two_objects(pair);
    const std::string why = peer.refuses ? peer.refuses(scene) : "";
    if (!why.empty()) throw Refusal(why);
    const PeerDistances found = peer.run(scene, {}, 1);
    if (found.distances.empty()) throw Refusal("it gives no distance");
    return ContestDistance{found.distances[0].distance};
  };
}

Contestant distance_alone(const DistancePeer& peer) {
  return {.card = {.name = peer.name,
                   .library = peer.library,
                   .call = "squared_distance() of two triangles in doubles",
                   .says = "nothing is quoted: how far its distances are off is what is measured",
                   .source = "experiments/peers/cgal.cpp",
                   .use = "distances near the size of the objects"},
          .distance = distance_by(peer)};
}

Contestant broad(const Peer& peer) {
  Contestant out = contestant(
      peer, {.name = peer.name + "-exact",
             .call = "the broad phase `" + peer.name +
                     "` of farcull bench, then exact tests of its candidates by farcull",
             .says = "nothing is quoted: whether it loses pairs that meet is what is measured",
             .source = "experiments/peers",
             .use = "to tell a broad phase that loses pairs from a test that does"});
  out.pair = {};  // a broad phase has no answer about a pair
  return out;
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
    const auto same = std::find_if(all.begin(), all.end(), [&](const Contestant& contestant) {
      return contestant.card.name == peer.name;
    });
    if (same != all.end())
      same->distance = distance_by(peer);
    else if (peer.name == "cgal-aabb")
      all.push_back(distance_alone(peer));
  }
  for (const Peer& peer : all_peers(1)) {
    if (peer.missing.empty()) all.push_back(broad(peer));
  }
  return contest(argc, argv, std::move(all));
}
