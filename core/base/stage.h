// A stage of a run: what is done, or left out, and why. A plan lists the stages that are to come, a
// trace those that were. The same structure serves both, so a run can be compared with its plan.
// Also the callback by which a long computation reports its current step. Words for all of it are
// made in experiments/record/stage_words.h.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace farcull {

enum class StageKind : std::uint8_t {
  boxes,           // which triangles can take part, by boxes
  blocks,          // boxes of blocks of triangles
  setup,           // the device: context, shaders, threads
  draw,            // all drawing; listed only if nothing is drawn
  patches,         // owners inside objects that are tested against themselves
  objects,         // whether objects are asked as a whole before their triangles
  clusters,        // whether there is a level between objects and triangles
  view,            // a view as a whole
  fatten,          // the primitives of one view
  cull,            // the passes of one level in one view
  agreement,       // the triangles that every view of a round has cleared
  further_views,   // further views, left out because few triangles are left
  further_rounds,  // rounds after the first
  offset,          // a further fattener
  sweep,           // sweep and prune
  join,            // pairs of triangles whose boxes overlap
  exact,           // exact predicates on the candidates
  near,            // the triangles of two objects that can be nearest
  closest,         // distances and closest points, exactly
  inside,          // whether objects lie inside others
  verify,          // accounting for every pair
  read,            // the files
  contacts,        // how triangles meet
  touch,           // whether objects that meet overlap
  depth,           // bounds of the penetration depth
};

/// The things that a stage counts.
enum class Unit : std::uint8_t { none, triangles, pairs };

/// Why a stage runs, was left out, or how it went. n, m, k, l and `fattener` are those of Stage.
enum class Reason : std::uint8_t {
  none,
  full,            // the option `full`: nothing is left out
  regions,         // n pairs of objects' boxes overlap
  meetings,        // n such pairs without k ignored ones; m objects are tested against themselves
  crowded,         // too many such pairs to list; m and k as above
  block_pairs,     // boxes of n pairs of blocks overlap, of m pairs of objects (or one and itself);
                   // k were compared, since a corner moved; empty: all
  normal_pairs,    // the same, and triangles are compared along their normals too
  oriented_pairs,  // the same, but oriented boxes of the blocks overlap too
  moved_pairs,     // the same, but boxes of blocks were kept, and moved with their objects
  boxes_meet,      // boxes of n pairs of triangles overlap; other triangles take no part
  boxes_decide_little,  // boxes of triangles would settle little, or cost much: not compared
  no_boxes_overlap,     // no two objects' boxes overlap (k as above, none tested against itself)
  no_box_pairs,         // no boxes of two triangles that could collide overlap
  no_triangle_meets,    // no triangle meets the box of another object
  nothing_to_look_at,   // boxes leave nothing to draw: no device is needed
  shaders,              // the canvas for the fattener is set up; on GL also context and shaders
  fattener,             // its name; n triangles are beyond its budget and kept
  unresolvable,         // double arithmetic cannot resolve the region of the view in pixels
  nothing_left,         // no triangle is left
  set_unchanged,        // what the passes store has not changed since the last visit of the view
  passes,               // n passes ran; fewer than 2: the other one's stored set has not changed
  few_left,             // n triangles are left, at most m, so no further view is drawn
  few_to_test,          // n triangles are left: m or fewer are cheaper to test
  patches_cut,          // n patches of at most m triangles
  patches_whole,        // n objects, none of more than m triangles: each is one patch
  few_objects,          // n objects take part, fewer than m: one seldom hides all of another
  rounds_given,         // n rounds were asked for
  all_views,            // a triangle is culled if every view clears it
  little_culled,        // the round culled n of m triangles, too few for another round
  owners,               // every triangle is an owner by itself
  clusters_given,       // sizes of clusters are given
  clusters_large,       // occlusion queries on many triangles
  clusters_small,       // occlusion queries on n triangles or fewer
  clusters_flags,       // flags are read back at once
  sweep,                // boxes of n objects overlap, which have m triangles; k, l below
  not_cleared,          // pairs that boxes found, without those that drawing cleared
  join_kept,            // boxes of what is kept
  join_patches,         // boxes of what is kept in different patches, and of all in one patch
  join_all,             // boxes of all triangles
  join_uneven,          // triangles lie too unevenly for blocks; a tree of boxes decides
  join_crowded,         // too many pairs of objects' boxes overlap: as above
  join_often,           // boxes of blocks overlap too often, also oriented ones: as above
  join_many_blocks,     // boxes of more than n pairs of blocks overlap: as above
  predicates,           // exact predicates on the candidates
  no_candidates,        // there is no candidate to decide
  every_pair,           // every pair is accounted for
  not_asked,            // the option `no_verify`
  near_boxes,           // of n pairs of objects; m bounds of boxes were compared
  inside_not_asked,     // the option `inside` is no
  // Only in a plan: conditions that depend on pixels.
  if_more_left,   // if more than n triangles are left (n = 0: any)
  if_changed,     // if the previous round changed something
  if_culled,      // if the previous round culled at least one triangle in n
  if_candidates,  // if there are candidates
  limited,        // the option `limit` ended the search, so not all pairs are known
};

/// Level of a stage that culls: none, objects, single triangles; any other value is the size of
/// a cluster in triangles.
inline constexpr std::uint32_t kNoLevel = 0, kObjectLevel = UINT32_MAX,
                               kTriangleLevel = UINT32_MAX - 1;

struct Stage {
  StageKind kind = StageKind::boxes;
  std::string subject = {};        // the view or the offset; of setup and boxes: empty
  std::uint32_t level = kNoLevel;  // of cull
  int round = 0;                   // of a visit, from 1; 0: the stage belongs to no round
  bool ran = false;                // in a plan: it will run
  bool depends = false;            // pixels decide whether it runs, or decided it
  Reason reason = Reason::none;
  std::string fattener = {};   // the name of the one that the reason is about
  std::uint64_t n = 0, m = 0;  // numbers that the reason is about
  // Pairs that are ignored, or were compared; of a sweep: places changed, and l lists sorted anew.
  std::optional<std::uint64_t> k = {};
  std::uint64_t l = 0;
  double ms = 0;
  std::uint64_t in = 0, out = 0;  // what enters the stage, and what is left after it
  Unit unit = Unit::none;         // of in and out
  std::uint64_t draws = 0;        // elements drawn
  std::uint64_t queries = 0;      // slots asked
  // How many more draws and queries plain CULLIDE's passes would take on the same live triangles.
  // Only Quick-CULLIDE and FAR save some.
  std::uint64_t draws_saved = 0;
  std::uint64_t queries_saved = 0;
};

/// A stage with the sums over all stages of draws, queries, draws_saved and queries_saved; its
/// other fields are empty.
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
  std::string text = {};     // not empty: names the step, and the other members are unused
};

/// Called before each step. May be empty.
using Progress = std::function<void(const ProgressStep&)>;

}  // namespace farcull
