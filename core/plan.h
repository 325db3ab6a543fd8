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
  std::vector<Box> regions;  // where two objects' boxes overlap, one per pair; see make_plan
  std::vector<std::uint32_t>
      triangles;  // ascending; those whose box meets the box of another object, or in a self region
};

/// self: objects with Object::self take part by themselves as well, their whole box a region.
Plan make_plan(const Scene& scene, bool self = false);

}  // namespace farcull
