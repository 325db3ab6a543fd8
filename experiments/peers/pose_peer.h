// Peers that find the colliding pairs of objects which move as a whole (farcull bench --poses).
#pragma once

#include <functional>
#include <span>
#include <string>
#include <vector>

#include "core/boxes/rigid.h"
#include "core/scene/scene.h"

namespace farcull {

/// The pairs of triangles of different objects that collide after each object was moved, sorted.
using PoseRun = std::function<std::vector<TrianglePair>(std::span<const RigidMotion> motions)>;

/// A library that keeps models of the objects of a scene while these move as a whole. It rounds, as
/// narrow_peers() do (peer.h).
struct PosePeer {
  std::string name;          // as in --peers
  std::string library = {};  // with its version
  std::string missing = {};  // why it cannot run in this build; empty: it can
  std::function<PoseRun(const Scene&, unsigned threads)> set_up = {};  // makes the models
  std::function<std::string(const Scene&)> refuses = {};  // why it cannot take this scene; empty:
                                                          // it can
};

/// All peers for poses, including those that this build does not have. fcl-double is FCL's OBBRSS
/// hierarchies and fcl::collide(), as in narrow_peers(), with hierarchies and the broad phase kept
/// from call to call.
std::vector<PosePeer> pose_peers();

PosePeer fcl_poses();

}  // namespace farcull
