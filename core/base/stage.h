// A Stage describes a step of a run: whether the step runs or is left out, and why. A plan lists
// the stages before a run; a trace lists them after it. Both use struct Stage, so a run can be
// compared with its plan. A long computation reports its current step as a ProgressStep.
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
  boxes,           // compares boxes to find the triangles that can take part
  blocks,          // compares boxes of blocks of triangles
  setup,           // starts the device: context, shaders, threads
  draw,            // represents all drawing; listed only if nothing is drawn
  patches,         // cuts objects that are tested against themselves into patches
  objects,         // decides whether whole objects are tested before triangles
  clusters,        // decides whether there is a level between objects and triangles
  view,            // represents a view that is left out
  fatten,          // fattens the triangles of one view
  cull,            // runs the passes of one level in one view
  agreement,       // finds the triangles that every view of a round has cleared
  further_views,   // represents views and rounds that are left out: little is left or was culled
  further_rounds,  // rounds after the first
  offset,          // culls again, with another fattener
  sweep,           // sweep and prune
  join,            // finds pairs of triangles whose boxes overlap
  exact,           // runs exact predicates on the candidates
  near,            // finds the triangles of two objects that can be closest
  closest,         // computes distances and closest points, exactly
  inside,          // decides whether objects lie inside others
  verify,          // checks for every pair whether it was missed
  read,            // reads the files
  contacts,        // finds how triangles meet
  touch,           // decides whether two objects that touch also overlap
  depth,           // bounds the penetration depth
};

/// What a stage counts.
enum class Unit : std::uint8_t { none, triangles, pairs };

/// Why a stage runs or is left out, or how it ended. n, m, k, l and fattener are members of Stage.
enum class Reason : std::uint8_t {
  none,
  full,            // the option `full`: nothing is left out
  regions,         // boxes of n pairs of objects overlap
  meetings,        // as regions; k pairs are ignored; m objects are tested against themselves
  crowded,         // boxes of too many pairs of objects overlap; m and k as in meetings
  block_pairs,     // n pairs of blocks have overlapping boxes, in m pairs of objects (an object
                   // and itself is a pair, too); k: pairs with a moved corner (empty: all)
  normal_pairs,    // as block_pairs; triangles are also compared along their normals
  oriented_pairs,  // as block_pairs, and the oriented boxes overlap, too
  moved_pairs,     // as block_pairs; boxes of blocks were moved with their objects
  boxes_meet,      // boxes of n pairs of triangles overlap; other triangles are not drawn
  boxes_decide_little,  // boxes of triangles are not compared: little gain or high cost
  no_boxes_overlap,     // no boxes of objects overlap; k pairs are ignored; no object has `self`
  no_box_pairs,         // boxes overlap for no pair of triangles that could collide
  no_triangle_meets,    // no triangle meets the box of another object
  nothing_to_look_at,   // boxes leave nothing to draw: no device is needed
  shaders,              // sets up the canvas for the fattener; on GL, context and shaders
  fattener,             // n triangles exceed the budget of `fattener` and are kept
  unresolvable,         // double arithmetic cannot resolve the region of the view in pixels
  nothing_left,         // no triangle is left
  set_unchanged,        // the passes would store the same triangles as in the last visit
  passes,               // n of 2 passes ran; the others would store the same triangles as before
  few_left,             // n triangles are left (n <= m), so no further view is drawn
  few_to_test,          // n triangles are left (n <= m): testing them is faster than culling
  patches_cut,          // objects are cut into n patches of at most m triangles
  patches_whole,        // no object tested against itself has more than m triangles
  asked_singly,         // objects are not tested as wholes: their triangles are tested anyway
  rounds_given,         // the option `rounds` is n
  all_views,            // a triangle is culled if every view clears it
  little_culled,        // the last view (or round) culled n of m triangles, too few to go on
  owners,               // every triangle is its own owner
  clusters_given,       // the sizes of clusters are given
  clusters_large,       // clusters are used: occlusion queries on more than n triangles
  clusters_small,       // no clusters are used: only n triangles take part (n <= m)
  clusters_flags,       // no clusters are used: they save nothing without occlusion queries
  sweep,                // boxes of n objects with m triangles overlap; k, l: see Stage
  not_cleared,          // takes the pairs that boxes found and drawing did not clear
  join_kept,            // compares boxes of the kept triangles
  join_patches,         // as join_kept; also compares all triangles inside each patch
  join_all,             // compares boxes of all triangles
  join_uneven,          // triangles are too unevenly spread for blocks; uses a tree of boxes
  join_crowded,         // boxes of too many pairs of objects overlap; uses a tree of boxes
  join_often,           // boxes and oriented boxes of blocks overlap too often; uses a tree
  join_many_blocks,     // boxes of more than n pairs of blocks overlap; uses a tree
  predicates,           // runs exact predicates on the candidates
  no_candidates,        // no pair of triangles is left to test
  every_pair,           // checks for every pair whether it was missed
  not_asked,            // the option `no_verify` is set
  near_boxes,           // n pairs of objects; m pairs of boxes were compared
  inside_not_asked,     // the option `inside` is no
  // The next five depend on pixels and occur only in plans.
  if_more_left,    // if more than n triangles are left (n = 0: any)
  if_changed,      // if the previous round changed something
  if_culled,       // if the last view or round culled one triangle in n
  if_more_culled,  // if more than n triangles are left, and the last view culled one in m
  if_candidates,   // if candidates are left
  limited,         // in a trace: the option `limit` ended the search early
};

/// Values of Stage::level: no level, objects, and single triangles. Any other value is the number
/// of triangles in a cluster.
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
  std::string fattener = {};   // name of the fattener, for some reasons
  std::uint64_t n = 0, m = 0;  // numbers whose meaning depends on the reason
  // k: number of pairs ignored or compared (sweep: changed places). l: lists that a sweep sorted.
  std::optional<std::uint64_t> k = {};
  std::uint64_t l = 0;
  double ms = 0;
  std::uint64_t in = 0, out = 0;  // numbers before and after the stage
  Unit unit = Unit::none;         // what `in` and `out` count
  std::uint64_t draws = 0;        // number of elements drawn
  std::uint64_t queries = 0;      // slots whose visibility was tested
  // Draws and queries that this stage saved, compared with plain CULLIDE's passes on the same
  // triangles. Only Quick-CULLIDE and FAR save any.
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

/// The next step of a long computation: a stage, or other work that `text` names.
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

/// Function that is called before each step. May be empty.
using Progress = std::function<void(const ProgressStep&)>;

}  // namespace farcull
