// The method `boxes` finds every pair of triangles whose boxes overlap. If large triangles lie
// among small ones, it leaves out pairs that a normal of one triangle separates. If slivers lie
// obliquely, it leaves out pairs whose oriented boxes are apart. No pair that intersects is lost
// (docs/reliability.md, "Boxes of blocks" and "Oriented boxes"). The triangles of a pair belong to
// two objects, or to one object that is tested against itself. The exact test is in verify/.
//
// A plan decides how pairs are found: by boxes of blocks of 16 triangles, along the axes or
// oriented, or by a tree of the boxes of all triangles. The rules are fixed: the same scene and
// settings give the same plan.
#pragma once

#include <cstdint>
#include <vector>

#include "core/base/stage.h"
#include "core/boxes/frames.h"
#include "core/boxes/meetings.h"
#include "core/scene/scene.h"

namespace farcull {

struct BoxesSettings {
  double clearance = 0;    // world units, finite, >= 0: pairs at most this far apart count
  bool full = false;       // leave nothing out: the boxes of all triangles are compared
  bool neighbours = true;  // false: pairs of one object that share a vertex index are left out
  bool lists = false;      // pairs found by blocks are listed even if find_boxes() has a `take`
  /// Pairs of objects that are not tested against each other; a result of in_order().
  std::vector<ObjectPair> ignored = {};
};

struct BoxesPlan {
  BoxesSettings settings;
  BlockDecision decision;
  std::vector<Stage> trace;  // stages of the planning itself
  unsigned threads = 0;      // as given to plan_boxes()
  bool remembers = false;    // find_boxes() keeps its pairs in the FrameMemory
  bool by_tree() const { return decision.tree != Reason::none; }
  bool nothing_can_meet() const { return !by_tree() && decision.blocks.empty(); }
};

/// Decides how pairs are found. threads: 0 for as many as there are cores. memory: one object for
/// all frames of a scene, or null to keep nothing. Precondition: memory->moved.update(scene) began
/// this frame. With a memory, pairs may be found in another way, but no colliding pair is lost.
/// decided: without a memory, the answer of decide_by_motions() for this scene and these settings,
/// or null. It is not used if settings.full is set. Throws Error for a scene that is too large.
/// Throws std::logic_error for a clearance that is negative or not finite.
BoxesPlan plan_boxes(const Scene& scene, const BoxesSettings& settings, unsigned threads = 0,
                     FrameMemory* memory = nullptr, const BlockDecision* decided = nullptr);

/// The stage that find_boxes() will go through.
Stage planned_stage(const BoxesPlan& plan);

struct BoxesResult {
  std::vector<TrianglePair> candidates;  // pairs whose closed boxes, grown by half the clearance,
                                         // overlap; sorted, each once
  bool streamed = false;                 // all candidates were given to `take`; none is listed here
  std::uint64_t count = 0;               // number of candidates
  Stage stage;
};

/// Finds the candidate pairs of the planned scene. The result does not depend on threads. memory:
/// the argument of plan_boxes(). take: receives candidates as they are found. The result lists the
/// candidates if `take` is empty, or if blocks find them and settings.lists or plan.remembers is
/// set.
BoxesResult find_boxes(const Scene& scene, const BoxesPlan& plan, FrameMemory* memory = nullptr,
                       const Progress& progress = {}, const TakePairs& take = {});

}  // namespace farcull
