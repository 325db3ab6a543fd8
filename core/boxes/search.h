// The method `boxes`: every pair of triangles whose boxes overlap. If large triangles lie among
// small ones, only those pairs that meet along the normals of both; if slivers lie obliquely, only
// those whose oriented boxes overlap as well. No pair that intersects is lost
// (docs/reliability.md, "Boxes of blocks" and "Oriented boxes"), neither between objects nor inside
// those tested against themselves. The method decides nothing exactly; verify/ does.
//
// A plan says what finds the pairs: boxes of blocks of 16 triangles, along the axes or oriented, or
// a tree of the boxes of all triangles. The rules are fixed: the same scene and settings give the
// same plan.
#pragma once

#include <cstdint>
#include <vector>

#include "core/base/stage.h"
#include "core/boxes/frames.h"
#include "core/boxes/meetings.h"
#include "core/scene/scene.h"

namespace farcull {

struct BoxesSettings {
  double clearance = 0;    // world units, finite, >= 0: pairs at this distance or less count too
  bool full = false;       // leave nothing out: the boxes of all triangles are compared
  bool neighbours = true;  // false: pairs of one object that share a vertex index are left out
  bool lists = false;      // pairs of blocks are listed even if find_boxes() has a `take`
  /// Objects that are not tested against each other, as in_order() gives them. Boxes compare none
  /// of their triangles.
  std::vector<ObjectPair> ignored = {};
};

struct BoxesPlan {
  BoxesSettings settings;
  BlockDecision decision;
  std::vector<Stage> trace;  // of the planning itself
  unsigned threads = 0;      // as given
  bool remembers = false;    // find_boxes() keeps what it finds in the memory
  bool by_tree() const { return decision.tree != Reason::none; }
  bool nothing_can_meet() const { return !by_tree() && decision.blocks.empty(); }
};

/// Decides what finds the pairs. threads: 0 for as many as there are cores. memory: keeps the
/// scene's last frame, if that was planned and found with the same object; null: nothing is kept.
/// Precondition: memory->moved.update(scene) began this frame. The memory may change what finds the
/// pairs, but loses no colliding one. decided: the answer of decide_by_motions() for this scene and
/// these settings, used unless settings.full, and without a memory; null: none. Throws Error for a
/// scene that is too large, std::logic_error for a clearance that is negative or not finite.
BoxesPlan plan_boxes(const Scene& scene, const BoxesSettings& settings, unsigned threads = 0,
                     FrameMemory* memory = nullptr, const BlockDecision* decided = nullptr);

/// The stage that find_boxes() will go through.
Stage planned_stage(const BoxesPlan& plan);

struct BoxesResult {
  std::vector<TrianglePair> candidates;  // sorted, each once; the closed boxes, grown by half
                                         // the clearance, overlap
  bool streamed = false;                 // all candidates went to `take` instead, as found
  std::uint64_t count = 0;               // of candidates
  Stage stage;
};

/// Finds the candidate pairs of the scene that was planned: of different objects, and of one object
/// if it is marked `self`. The result does not depend on threads. memory: that of the plan; null if
/// the plan has none. take: receives candidates as they are found, not listed, if a tree finds
/// them, or if blocks do and settings.lists and plan.remembers are false; empty: candidates are
/// listed.
BoxesResult find_boxes(const Scene& scene, const BoxesPlan& plan, FrameMemory* memory = nullptr,
                       const Progress& progress = {}, const TakePairs& take = {});

}  // namespace farcull
