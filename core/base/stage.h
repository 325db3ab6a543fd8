// A stage of a run is a step that runs or is left out, with the reason. A plan lists the stages
// that will come. A trace lists the stages that have passed. Both use struct Stage, so a run can be
// compared with its plan. By a ProgressStep a long computation reports its current step. The texts
// of stages and steps are in experiments/record/stage_words.h.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace farcull {

enum class StageKind : std::uint8_t {
  boxes,           // finds the triangles that can take part, by comparing boxes
  blocks,          // compares boxes of blocks of triangles
  setup,           // starts the device: context, shaders, threads
  draw,            // stands for all drawing; listed only if nothing is drawn
  patches,         // cuts objects that are tested against themselves into patches
  objects,         // decides whether whole objects are tested before single triangles
  clusters,        // decides whether there is a level between objects and triangles
  view,            // stands for a view that is left out
  fatten,          // makes what one view draws
  cull,            // runs the passes of one level in one view
  agreement,       // finds the triangles that every view of a round has cleared
  further_views,   // stands for views that are left out because few triangles are left
  further_rounds,  // rounds after the first
  offset,          // culls with a further fattener
  sweep,           // sweep and prune
  join,            // finds pairs of triangles whose boxes overlap
  exact,           // runs exact predicates on the candidates
  near,            // finds the triangles of two objects that can be nearest
  closest,         // computes distances and closest points, exactly
  inside,          // decides whether objects lie inside others
  verify,          // accounts for every pair
  read,            // reads the files
  contacts,        // finds how triangles meet
  touch,           // decides whether two objects that touch also overlap
  depth,           // bounds the penetration depth
};

/// The things that a stage counts.
enum class Unit : std::uint8_t { none, triangles, pairs };

/// Why a stage runs or was left out, or how it went. n, m, k, l, fattener: members of Stage.
enum class Reason : std::uint8_t {
  none,
  full,            // the option `full`: nothing is left out
  regions,         // the boxes of n pairs of objects overlap
  meetings,        // as regions; k pairs are ignored, and m objects are tested against themselves
  crowded,         // boxes of too many pairs of objects overlap; m and k as in meetings
  block_pairs,     // boxes of n pairs of blocks overlap; these lie in m pairs of objects, or of an
                   // object and itself; k pairs with a moved corner were compared (no k: all pairs)
  normal_pairs,    // as block_pairs; triangles are also compared along their normals
  oriented_pairs,  // as block_pairs, but for oriented boxes
  moved_pairs,     // as block_pairs; boxes of blocks were kept and moved with their objects
  boxes_meet,      // boxes of n pairs of triangles overlap; only these triangles take part
  boxes_decide_little,  // boxes of triangles are not compared: too little gain or too costly
  no_boxes_overlap,     // no boxes of objects overlap; k pairs are ignored; no object has `self`
  no_box_pairs,         // no boxes of two triangles that could collide overlap
  no_triangle_meets,    // no triangle meets the box of another object
  nothing_to_look_at,   // boxes leave nothing to draw: no device is needed
  shaders,              // the canvas for the fattener is set up; on GL also context and shaders
  fattener,             // n triangles exceed the budget of `fattener` and are kept
  unresolvable,         // double arithmetic cannot resolve the region of the view in pixels
  nothing_left,         // no triangle is left
  set_unchanged,     // the passes would store the same triangles as in the last visit of the view
  passes,            // n of 2 passes ran; the others would store the same triangles as before
  few_left,          // n triangles are left (n <= m), so no further view is drawn
  few_to_test,       // n triangles are left; m or fewer are cheaper to test than to cull
  patches_cut,       // n patches of at most m triangles
  patches_whole,     // no object is cut: none that is tested against itself exceeds m triangles
  few_objects,       // n objects take part (n < m): few objects seldom hide each other
  rounds_given,      // n rounds were asked for
  all_views,         // a triangle is culled if every view clears it
  little_culled,     // the last view culled n of m triangles, too few for another view
  owners,            // every triangle is an owner of its own
  clusters_given,    // sizes of clusters are given
  clusters_large,    // there are clusters: occlusion queries are used, on more than n triangles
  clusters_small,    // there are no clusters: only n triangles take part (n <= m)
  flags,             // no clusters, no object level: without occlusion queries they save nothing
  sweep,             // boxes of n objects with m triangles overlap; k and l: see Stage
  not_cleared,       // takes the pairs that boxes found, without the pairs that drawing cleared
  join_kept,         // compares boxes of the triangles that are kept
  join_patches,      // as join_kept; also compares boxes of all triangles inside each patch
  join_all,          // compares boxes of all triangles
  join_uneven,       // triangles lie too unevenly for blocks; a tree of boxes decides
  join_crowded,      // boxes of too many pairs of objects overlap; a tree decides
  join_often,        // boxes and oriented boxes of blocks overlap too often; a tree decides
  join_many_blocks,  // boxes of more than n pairs of blocks overlap; a tree decides
  predicates,        // exact predicates on the candidates
  no_candidates,     // there is no candidate to decide
  every_pair,        // every pair is accounted for
  not_asked,         // the option `no_verify`
  near_boxes,        // n pairs of objects; m pairs of boxes were compared
  inside_not_asked,  // the option `inside` is no
  // Conditions that depend on pixels; only in a plan.
  if_more_left,    // if more than n triangles are left (n = 0: any)
  if_changed,      // if the previous round changed something
  if_culled,       // if the last view culled at least one triangle in n
  if_more_culled,  // if more than n triangles are left, and the last view culled one in m
  if_candidates,   // if there are candidates
  limited,         // in a trace: the option `limit` ended the search, so not all pairs are known
};

/// Values of Stage::level: none, objects, single triangles. Any other value is the number of
/// triangles of a cluster.
inline constexpr std::uint32_t kNoLevel = 0, kObjectLevel = UINT32_MAX,
                               kTriangleLevel = UINT32_MAX - 1;

struct Stage {
  StageKind kind = StageKind::boxes;
  std::string subject = {};        // the view or the offset; empty for setup and boxes
  std::uint32_t level = kNoLevel;  // set for the kind `cull`
  int round = 0;                   // counted from 1; 0: the stage belongs to no round
  bool ran = false;                // in a plan: it will run
  bool depends = false;            // pixels decide whether it runs
  Reason reason = Reason::none;
  std::string fattener = {};   // name of the fattener that the reason is about
  std::uint64_t n = 0, m = 0;  // numbers that the reason is about
  // k: number of pairs ignored or compared. In a sweep, k places changed, and l lists were sorted.
  std::optional<std::uint64_t> k = {};
  std::uint64_t l = 0;
  double ms = 0;
  std::uint64_t in = 0, out = 0;  // what enters the stage, and what is left after it
  Unit unit = Unit::none;         // of in and out
  std::uint64_t draws = 0;        // elements drawn
  std::uint64_t queries = 0;      // slots whose visibility was tested
  // How many more draws and queries plain CULLIDE's passes would take on the same live triangles.
  // Only Quick-CULLIDE and FAR save some.
  std::uint64_t draws_saved = 0;
  std::uint64_t queries_saved = 0;
};

/// Sums draws, queries, draws_saved and queries_saved over all stages. The other fields of the
/// result are empty.
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
  std::string text = {};     // names the step; if it is not empty, the other members are unused
};

/// Called before each step. May be empty.
using Progress = std::function<void(const ProgressStep&)>;

}  // namespace farcull
