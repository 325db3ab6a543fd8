// The lists of peers, in the order of tables. An entry that no adapter of this build gives says why
// it is missing.
#include "experiments/peers/peer.h"

#include <algorithm>
#include <span>
#include <utility>

namespace farcull {
namespace {

struct Known {
  const char* name;
  const char* library;
  const char* package;  // of Debian
};

constexpr Known kBroad[] = {{"cgal-boxes", "CGAL", "libcgal-dev"},
                            {"cgal-boxes-2000", "CGAL", "libcgal-dev"},
                            {"cgal-boxes-parallel", "CGAL", "libcgal-dev"},
                            {"cgal-boxes-2000-parallel", "CGAL", "libcgal-dev"},
                            {"cgal-object-pairs", "CGAL", "libcgal-dev"},
                            {"cgal-aabb", "CGAL", "libcgal-dev"},
                            {"cgal-aabb-triangles", "CGAL", "libcgal-dev"},
                            {"cgal-self-intersections", "CGAL", "libcgal-dev"},
                            {"cgal-self-intersections-parallel", "CGAL", "libcgal-dev"},
                            {"fcl-obbrss", "FCL", "libfcl-dev"},
                            {"fcl-obb", "FCL", "libfcl-dev"},
                            {"fcl-aabb", "FCL", "libfcl-dev"},
                            {"embree-low", "Embree 3", "libembree-dev"},
                            {"embree-medium", "Embree 3", "libembree-dev"},
                            {"bullet-gimpact", "Bullet in double", "libbullet-dev"}};
constexpr Known kNarrow[] = {{"fcl-float", "FCL", "libfcl-dev"},
                             {"fcl-double", "FCL", "libfcl-dev"},
                             {"ode-trimesh", "ODE", "libode-dev"}};
constexpr Known kDistances[] = {{"fcl-double", "FCL", "libfcl-dev"},
                                {"fcl-float", "FCL", "libfcl-dev"},
                                {"cgal-aabb", "CGAL", "libcgal-dev"},
                                {"embree-points", "Embree 3", "libembree-dev"}};

std::vector<LibraryPeers> libraries_of_build([[maybe_unused]] unsigned threads) {
  std::vector<LibraryPeers> all;
#if FARCULL_WITH_CGAL
  all.push_back(cgal_library(threads));
#endif
#if FARCULL_WITH_FCL
  all.push_back(fcl_library());
#endif
#if FARCULL_WITH_EMBREE
  all.push_back(embree_library());
#endif
#if FARCULL_WITH_BULLET
  all.push_back(bullet_library());
#endif
#if FARCULL_WITH_ODE
  all.push_back(ode_library());
#endif
  return all;
}

std::string why_missing(const Known& known) {
  if (!FARCULL_WITH_PEERS) return "built without peers (-DFARCULL_PEERS=OFF)";
  return std::string("built without ") + known.library + " (Debian: " + known.package + ")";
}

/// The peers of a list, from one part of what the adapters give.
template <class PeerKind>
std::vector<PeerKind> listed(std::span<const Known> list, std::vector<PeerKind> LibraryPeers::*part,
                             unsigned threads) {
  std::vector<LibraryPeers> libraries = libraries_of_build(threads);
  std::vector<PeerKind> out;
  for (const Known& known : list) {
    PeerKind peer{.name = known.name, .library = known.library, .missing = why_missing(known)};
    for (LibraryPeers& library : libraries) {
      for (PeerKind& given : library.*part) {
        if (given.name == known.name) peer = std::move(given);
      }
    }
    out.push_back(std::move(peer));
  }
  return out;
}

}  // namespace

std::vector<Peer> all_peers(unsigned threads) {
  return listed(kBroad, &LibraryPeers::broad, threads);
}
std::vector<Peer> narrow_peers() { return listed(kNarrow, &LibraryPeers::narrow, 1); }
std::vector<DistancePeer> distance_peers() {
  return listed(kDistances, &LibraryPeers::distances, 1);
}

}  // namespace farcull
