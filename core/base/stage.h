// A Stage describes one step of a run: whether the step runs or is skipped, and why. A plan lists
// the stages before a run. A trace lists the stages after the run. Both use struct Stage, so a run
// can be compared with its plan. A long computation reports its current step as a ProgressStep.
// experiments/record/stage_words.h has the texts of stages and steps.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace farcull {

enum class StageKind : std::uint8_t {
  boxes,           // compares boxes to find the triangles that can collide
  blocks,          // compares boxes of blocks of triangles
  setup,           // starts the device: context, shaders, threads
  draw,            // all drawing; listed only if the run draws nothing
  patches,         // cuts objects that are tested against themselves into patches
  objects,         // decides whether whole objects are tested before single triangles
  clusters,        // decides whether clusters of triangles are tested before single triangles
  view,            // one view; listed only if the view is skipped
  fatten,          // fattens the triangles for one view
  cull,            // runs the visibility passes of one level in one view
  agreement,       // culls the triangles that every view of a round found free of collision
  further_views,   // the views and rounds skipped after few were left or few were culled
  further_rounds,  // all rounds after the first
  offset,          // culls again with another fattener
  sweep,           // sweep and prune
  join,            // finds pairs of triangles whose boxes overlap
  exact,           // runs exact predicates on the candidate pairs
  near,            // finds the triangles of two objects that can be closest to each other
  closest,         // computes exact distances and closest points
  inside,          // decides whether objects lie inside other objects
  verify,          // checks whether culling missed a colliding pair
  read,            // reads the files
  contacts,        // finds how the triangles of a pair touch or intersect
  touch,           // decides whether two touching objects also overlap
  depth,           // bounds the penetration depth
};

/// What a stage counts.
enum class Unit : std::uint8_t { none, triangles, pairs };

/// Why a stage runs or is skipped, or how it ended. n, m, k, l and fattener are members of Stage.
enum class Reason : std::uint8_t {
  none,
  full,            // the option `full` is set, so no stage is skipped
  regions,         // the boxes of n pairs of objects overlap
  meetings,        // as regions; k pairs are ignored; m objects are tested against themselves
  crowded,         // the boxes of too many pairs of objects overlap; m and k as in meetings
  block_pairs,     // the boxes of n pairs of blocks overlap, in m pairs of objects (also pairs of
                   // an object with itself); k: block pairs with a moved corner (empty: all n)
  normal_pairs,    // as block_pairs; triangles are also compared along their normals
  oriented_pairs,  // as block_pairs; the oriented boxes of the blocks overlap, too
  moved_pairs,     // as block_pairs; boxes of blocks were moved with their objects
  boxes_meet,      // boxes of n pairs of triangles overlap; other triangles are not drawn
  boxes_decide_little,  // boxes of triangles are not compared: small gain or high cost
  no_boxes_overlap,     // no boxes of objects overlap; k pairs are ignored; no object has `self`
  no_box_pairs,         // no two triangles that could collide have overlapping boxes
  no_triangle_meets,    // no triangle intersects the box of another object
  nothing_to_look_at,   // box tests leave nothing to draw, so no device is needed
  shaders,              // sets up the canvas for `fattener`; on GL also context and shaders
  fattener,             // `fattener` was used; n triangles exceed its error budget and are kept
  unresolvable,         // doubles cannot represent the view's region to pixel accuracy
  nothing_left,         // no triangle is left
  set_unchanged,        // the passes would store the same triangles as in the last visit
  passes,               // n of 2 passes ran; the others would store the same triangles as before
  few_left,             // n triangles are left (n <= m), so no further view is drawn
  few_to_test,          // n triangles are left (n <= m): testing them is faster than culling
  patches_cut,          // objects are cut into n patches of at most m triangles
  patches_whole,        // no object tested against itself has more than m triangles
  asked_singly,         // whole objects are not tested, because each triangle is tested anyway
  rounds_given,         // the option `rounds` is n
  all_views,            // a triangle is culled if every view finds it free of collision
  little_culled,        // the last view (or round) culled only n of m triangles
  owners,               // no clusters are used, because an object is tested against itself
  clusters_given,       // the caller set the sizes of clusters
  clusters_large,       // clusters are used: occlusion queries on more than n triangles
  clusters_small,       // no clusters are used: only n triangles take part (n <= m)
  clusters_flags,       // no clusters are used: there are no occlusion queries to save
  sweep,                // boxes of n objects with m triangles overlap; k, l: see Stage
  not_cleared,          // takes the pairs that boxes found and drawing did not remove
  join_kept,            // compares boxes of the kept triangles
  join_patches,         // as join_kept; also compares all triangles inside each patch
  join_all,             // compares boxes of all triangles
  join_uneven,          // triangles are too unevenly spread for blocks; uses a tree of boxes
  join_crowded,         // boxes of too many pairs of objects overlap; uses a tree of boxes
  join_often,           // boxes and oriented boxes of blocks overlap too often; uses a tree
  join_many_blocks,     // boxes of more than n pairs of blocks overlap; uses a tree
  predicates,           // runs exact predicates on the candidate pairs
  no_candidates,        // no pair of triangles is left to test
  every_pair,           // checks for every pair whether culling missed it
  not_asked,            // the option `no_verify` is set
  near_boxes,           // n pairs of objects were tested by m comparisons of boxes
  inside_not_asked,     // the option `inside` is no
  // The next five reasons are conditions that depend on pixels. They occur only in plans.
  if_more_left,    // if more than n triangles are left
  if_changed,      // if the previous round changed something
  if_culled,       // if the last view or round culled at least one triangle in n
  if_more_culled,  // if more than n triangles are left, and the last view culled one in m
  if_candidates,   // if candidate pairs are left
  limited,         // only in a trace: the option `limit` ended the search early
};

/// Values of Stage::level: no level, whole objects, and single triangles. Any other value is the
/// number of triangles in a cluster.
inline constexpr std::uint32_t kNoLevel = 0, kObjectLevel = UINT32_MAX,
                               kTriangleLevel = UINT32_MAX - 1;

struct Stage {
  StageKind kind = StageKind::boxes;
  std::string subject = {};        // name of the view or offset; empty for setup and boxes
  std::uint32_t level = kNoLevel;  // set for the kind `cull`
  int round = 0;                   // counted from 1; 0: the stage belongs to no round
  bool ran = false;                // in a plan: the stage will run
  bool depends = false;            // pixels decide whether the stage runs
  Reason reason = Reason::none;
  std::string fattener = {};   // name of the fattener; set for some values of `reason`
  std::uint64_t n = 0, m = 0;  // counts; the comment at the value of `reason` explains them
  // k: as n and m; for Reason::sweep, the number of places changed. l: lists that the sweep sorted.
  std::optional<std::uint64_t> k = {};
  std::uint64_t l = 0;
  double ms = 0;
  std::uint64_t in = 0, out = 0;  // counts before and after the stage
  Unit unit = Unit::none;         // what `in` and `out` count
  std::uint64_t draws = 0;        // number of elements drawn
  std::uint64_t queries = 0;      // number of visibility tests
  // Draws and queries that this stage saved, compared with the passes of plain CULLIDE on the same
  // triangles. Both numbers are 0 for plain CULLIDE.
  std::uint64_t draws_saved = 0;
  std::uint64_t queries_saved = 0;
};

/// Returns the sums of draws, queries, draws_saved and queries_saved over all stages. The other
/// fields of the result keep their initial values.
inline Stage work_of(const std::vector<Stage>& stages) {
  Stage sum;
  for (const Stage& stage : stages) {
    sum.draws += stage.draws;
    sum.queries += stage.queries;
    sum.draws_saved += stage.draws_saved;
    sum.queries_saved += stage.queries_saved;
  }
  return sum;
}

/// The next step of a long computation: a stage, or other work with the name `text`.
struct ProgressStep {
  ProgressStep(StageKind kind, std::string subject = {}, int round = 0)
      : kind(kind), subject(std::move(subject)), round(round) {}
  ProgressStep(std::string text) : text(std::move(text)) {}
  ProgressStep(const char* text) : text(text) {}

  StageKind kind = StageKind::boxes;
  std::string subject = {};  // as in Stage
  int round = 0;             // as in Stage
  std::string text = {};     // name of the step; if not empty, the other members are unused
};

/// A function that a long computation calls before each step. May be empty.
using Progress = std::function<void(const ProgressStep&)>;

}  // namespace farcull
