// The method `boxes` finds every pair of triangles whose boxes overlap. If the scene has large
// triangles among small ones, the method drops pairs that the normal of one triangle separates. If
// the scene has oblique slivers, the method drops pairs whose oriented boxes are disjoint. No
// intersecting pair is lost (docs/reliability.md, "Boxes of blocks" and "Oriented boxes"). The
// triangles of a pair belong to two objects, or to one object that is tested against itself.
//
// A plan decides how pairs are found: by axis-aligned boxes of blocks of 16 triangles, by oriented
// boxes of blocks, or by a tree of the boxes of all triangles. The same scene and settings always
// give the same plan.
#pragma once

#include <cstdint>
#include <vector>

#include "core/base/stage.h"
#include "core/boxes/frames.h"
#include "core/boxes/meetings.h"
#include "core/scene/scene.h"

namespace farcull {

struct BoxesSettings {
  double clearance = 0;    // finds pairs at most this far apart; world units, finite, >= 0
  bool full = false;       // true: compares the boxes of all triangles by a tree
  bool neighbours = true;  // false: leaves out pairs of one object that share a vertex index
  bool lists = false;      // true: pairs found by blocks are listed, not given to `take`
  /// Pairs of objects that are not tested against each other; a result of in_order().
  std::vector<ObjectPair> ignored = {};
};

struct BoxesPlan {
  BoxesSettings settings;
  BlockDecision decision;
  std::vector<Stage> trace;  // stages of the planning itself
  unsigned threads = 0;      // the argument of plan_boxes()
  bool remembers = false;    // true: find_boxes() stores its pairs in the FrameMemory
  bool by_tree() const { return decision.tree != Reason::none; }
  bool nothing_can_meet() const { return !by_tree() && decision.blocks.empty(); }
};

/// Decides how pairs are found. threads: 0 for one per core. memory: the same object for all frames
/// of a scene, or null to keep nothing. Precondition: memory->moved.update(scene) was called for
/// this frame. With a memory, the candidates may differ in pairs that do not collide. decided:
/// null, or (without a memory) the result of decide_by_motions() for this scene and these settings.
/// settings.full overrides `decided`. Throws Error if the scene is too large. Throws
/// std::logic_error if the clearance is negative or not finite.
BoxesPlan plan_boxes(const Scene& scene, const BoxesSettings& settings, unsigned threads = 0,
                     FrameMemory* memory = nullptr, const BlockDecision* decided = nullptr);

/// Describes what find_boxes() will do. Times and results are not set.
Stage planned_stage(const BoxesPlan& plan);

struct BoxesResult {
  std::vector<TrianglePair> candidates;  // pairs of triangles whose grown boxes overlap; sorted,
                                         // each once; empty if `streamed` is true
  bool streamed = false;                 // true: all candidates were given to `take`
  std::uint64_t count = 0;               // number of candidates
  Stage stage;
};

/// Finds the candidate pairs of the planned scene. The result does not depend on threads. memory:
/// the argument of plan_boxes(). take: a function that receives the candidates, or empty. If
/// settings.lists or plan.remembers is true, pairs found by blocks are not given to `take`. The
/// result lists the candidates if they were not given to `take`.
BoxesResult find_boxes(const Scene& scene, const BoxesPlan& plan, FrameMemory* memory = nullptr,
                       const Progress& progress = {}, const TakePairs& take = {});

}  // namespace farcull
