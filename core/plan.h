// What a scene needs, before any pixel is drawn: which objects' boxes overlap, where, and which
// triangles can take part. Fixed rules: the same scene and options give the same plan.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "core/scene.h"

namespace farcull {

/// One stage of a run, as it was planned and as it went. `in` and `out` count what enters and what
/// is left (triangles, objects or pairs, as `unit` says).
struct Stage {
  std::string name;
  bool ran = false;
  std::string reason = {};  // why it ran or was left out
  double ms = 0;
  std::uint64_t in = 0;
  std::uint64_t out = 0;
  std::string unit = {};
  std::uint64_t draws = 0;    // elements drawn
  std::uint64_t queries = 0;  // slots asked
  // Against plain CULLIDE's passes on the same live triangles; Quick-CULLIDE and FAR fill them.
  std::uint64_t draws_saved = 0;
  std::uint64_t queries_saved = 0;
};

struct Plan {
  std::vector<Box> triangle_boxes;
  std::vector<Box> object_boxes;
  std::vector<Box> regions;  // the places where two objects' boxes overlap, one per pair
  std::vector<std::uint32_t> triangles;  // ascending; those whose box meets the box of another
                                         // object: all that can take part
};

/// Further views and finer offsets are left out where no more triangles than this are kept: the
/// exact tests of so few take less time than the upload and the readbacks of one view.
constexpr std::uint32_t kFewTriangles = 256;

struct PlanRules {
  bool self = false;  // objects that are marked so are tested against themselves
  bool full = false;  // leave nothing out: every triangle takes part
};

/// With `self` a marked object of two triangles or more is a region of its own, and all of it takes
/// part. With `full` the regions are the same, or the box of the scene where there are none, so
/// that the views are, and every triangle takes part.
Plan make_plan(const Scene& scene, const PlanRules& rules = {});

}  // namespace farcull
