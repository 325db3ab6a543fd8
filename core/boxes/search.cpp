// Finds the pairs of triangles whose boxes overlap, by blocks or by a tree of all boxes.
#include "core/boxes/search.h"

#include <cmath>
#include <stdexcept>
#include <utility>

#include "core/base/error.h"
#include "core/base/stopwatch.h"
#include "core/boxes/join.h"
#include "core/boxes/oriented.h"

namespace farcull {
namespace {

// True if the memory has results of the previous frame that can be reused. Otherwise prepares the
// memory for the results of this frame.
bool knows_last_frame(const BoxesSettings& settings, FrameMemory& memory) {
  const std::optional<std::uint64_t> last =
      std::exchange(memory.frame, {});  // stays empty until find_boxes() has finished
  if (last && !settings.full && memory.moved.follows(*last) &&
      memory.clearance == settings.clearance && memory.neighbours == settings.neighbours &&
      memory.ignored == settings.ignored && (!memory.oriented || !memory.moved.any()) &&
      mostly_unmoved(memory.moved, memory.pairs))
    return true;
  memory.clearance = settings.clearance;
  memory.neighbours = settings.neighbours;
  memory.ignored = settings.ignored;
  memory.blocks.reset();
  return false;
}

// Returns the number of ignored pairs of objects, or empty if there are none.
std::optional<std::uint64_t> ignored_pairs(const BoxesSettings& settings) {
  if (settings.ignored.empty()) return std::nullopt;
  return settings.ignored.size();
}

Stage stage_of_objects(const Scene& scene, const BoxesPlan& plan, double ms) {
  const BlockDecision& decision = plan.decision;
  const bool full = plan.settings.full;
  return {.kind = StageKind::boxes,
          .ran = true,
          .reason = full                                    ? Reason::full
                    : decision.tree == Reason::join_crowded ? Reason::crowded
                                                            : Reason::meetings,
          .n = full ? 0 : decision.pairs,
          .m = full ? 0 : decision.self,
          .k = full ? std::nullopt : ignored_pairs(plan.settings),
          .ms = ms,
          .in = scene.triangles.size(),
          .out = plan.by_tree() ? scene.triangles.size() : decision.blocks.triangles,
          .unit = Unit::triangles};
}

// Stores the found pairs for the next frame if blocks found them. Stores no pairs of a tree.
void remember(const BoxesPlan& plan, const std::vector<TrianglePair>& found, FrameMemory& memory) {
  const BlockDecision& decision = plan.decision;
  memory.frame = plan.by_tree() ? std::nullopt : std::optional(memory.moved.frame());
  // If nothing moved, the plan has no blocks, and memory.oriented keeps its value.
  if (decision.blocks.of) memory.oriented = decision.blocks.oriented != nullptr;
  memory.pairs = plan.by_tree() ? std::vector<TrianglePair>() : found;
  memory.counts = {.blocks = {}, .pairs = decision.pairs, .self = decision.self};
  memory.counts.blocks.overlaps = decision.blocks.overlaps;
  memory.counts.blocks.meetings = decision.blocks.meetings;
  memory.counts.blocks.triangles = decision.blocks.triangles;
}

}  // namespace

BoxesPlan plan_boxes(const Scene& scene, const BoxesSettings& settings, unsigned threads,
                     FrameMemory* memory, const BlockDecision* decided) {
  if (!(settings.clearance >= 0) || !std::isfinite(settings.clearance))
    throw std::logic_error("plan_boxes: the clearance is negative or not finite");
  if (scene.triangles.size() + scene.objects.size() >= std::size_t{1} << 31)
    throw Error(scene.name, "has 2^31 triangles and objects, or more", "split it into scenes");
  const Stopwatch watch;
  BoxesPlan plan;
  plan.settings = settings;
  plan.threads = threads;
  plan.remembers = memory != nullptr;
  const bool known = memory && knows_last_frame(settings, *memory);
  if (settings.full) {
    plan.decision.tree = Reason::join_all;
  } else if (decided) {
    plan.decision = *decided;
  } else if (known) {
    plan.decision = decide_next_frame(scene, threads, *memory);
  } else {
    plan.decision = decide_by_blocks(scene, settings.clearance, threads, settings.ignored);
  }
  plan.trace.push_back(stage_of_objects(scene, plan, watch.ms()));
  return plan;
}

Stage planned_stage(const BoxesPlan& plan) {
  const BlockDecision& decision = plan.decision;
  if (plan.by_tree()) {
    return {.kind = StageKind::join,
            .ran = true,
            .reason = decision.tree,
            .n = decision.tree_n,
            .unit = Unit::pairs};
  }
  if (plan.nothing_can_meet()) {
    return {.kind = StageKind::blocks,
            .reason = Reason::no_boxes_overlap,
            .k = ignored_pairs(plan.settings),
            .unit = Unit::pairs};
  }
  const std::size_t compared = decision.blocks.pairs.size();
  return {.kind = StageKind::blocks,
          .ran = true,
          .reason = decision.blocks.oriented  ? Reason::oriented_pairs
                    : decision.blocks.normals ? Reason::normal_pairs
                    : decision.blocks.moved   ? Reason::moved_pairs
                                              : Reason::block_pairs,
          .n = decision.blocks.overlaps,
          .m = decision.blocks.meetings,
          .k = compared < decision.blocks.overlaps ? std::optional<std::uint64_t>(compared)
                                                   : std::nullopt,
          .in = decision.blocks.triangles,
          .unit = Unit::pairs};
}

BoxesResult find_boxes(const Scene& scene, const BoxesPlan& plan, FrameMemory* memory,
                       const Progress& progress, const TakePairs& take) {
  const Stopwatch watch;
  const auto& [clearance, full, neighbours, lists, ignored] = plan.settings;
  BoxesResult out;
  out.stage = planned_stage(plan);
  if (progress) progress(plan.by_tree() ? StageKind::join : StageKind::blocks);
  if (plan.by_tree()) {
    OrderedPairs tree(scene, clearance, ignored, neighbours, plan.threads);
    out.streamed = static_cast<bool>(take);
    if (out.streamed) {
      out.count = tree.give(take);
    } else {
      out.candidates = tree.all();
    }
    out.stage.m = tree.compared();
    out.stage.in = scene.triangles.size();
  } else if (!plan.nothing_can_meet()) {
    const BlockMeetings& blocks = plan.decision.blocks;
    out.streamed = take && !lists && !plan.remembers;
    if (out.streamed) {
      out.count = give_pairs_of_blocks(scene, blocks, blocks.pairs, clearance, neighbours,
                                       plan.threads, take);
    } else {
      out.candidates = pairs_of_blocks(scene, blocks, clearance, neighbours, plan.threads);
    }
  }
  if (!out.streamed) out.count = out.candidates.size();
  if (plan.remembers) remember(plan, out.candidates, *memory);
  out.stage.ms = watch.ms();
  out.stage.out = out.count;
  return out;
}

}  // namespace farcull
