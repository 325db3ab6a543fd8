// Broad phases of other libraries, which a user would take instead of farcull, for `farcull bench`:
// each is followed by the exact decisions of verify/exact.h, but for CGAL's self_intersections(),
// which decides exactly by itself. All go from the triangles of a scene
// to the same list: the pairs of triangles of different objects, and of one object where it is
// `self`, that collide and are not neighbours (verify/exact.h).
//
// Peers run at their best settings. Whatever can be divided runs on the threads of the bench, and
// candidates are decided in bounded parts, so that tens of millions of overlapping boxes are never
// stored.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
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

struct Peer {
  std::string name;     // as in --peers
  std::string library;  // with its version, such as "CGAL 5.5.1"
  std::string
      missing;  // why this build or this number of threads is without it; empty: it is there
  std::function<BenchRun(unsigned threads)> set_up = {};  // devices, pools; not timed with the run
  std::function<std::string(const Scene&)> refuses = {};  // why it is not exact on such a scene;
                                                          // empty: it is. Null: on all
};

/// All peers, those included that this build was made without. `threads` >= 1.
std::vector<Peer> all_peers(unsigned threads);

/// Their parts, a library each; peer.cpp joins them.
std::vector<Peer> cgal_peers(unsigned threads);
std::vector<Peer> cgal_self_peers(unsigned threads);
std::vector<Peer> fcl_peers();
std::vector<Peer> embree_peers();
std::vector<Peer> bullet_peers();

/// Libraries as their users run them, with their own inexact test of two triangles, so that pairs
/// may be missed or wrong. fcl-float and fcl-double are FCL's OBBRSS hierarchies and fcl::collide()
/// on coordinates rounded to that type. ode-trimesh is the contacts of ODE's dCollide().
/// BenchAnswer::pairs is what the library reports, without neighbours (verify/exact.h) inside an
/// object that is `self`; candidate_pairs is their number. One traversal has one thread; FCL's
/// pairs of objects are divided over the threads. Not among all_peers(), whose answers are exact;
/// `refuses` names what a library does not do at all, since they vouch for nothing.
std::vector<Peer> narrow_peers();

/// Their parts, a library each.
std::vector<Peer> fcl_narrow_peers();
std::vector<Peer> ode_narrow_peers();

/// CGAL's exact predicate by itself, as its users call it: what decide() falls back to. Neither may
/// be degenerate.
bool cgal_do_intersect(const std::array<Vec3, 3>& a, const std::array<Vec3, 3>& b);

}  // namespace farcull
