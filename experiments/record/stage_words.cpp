// Words for stages. An array has words for kinds of stages. Switches have words for reasons.
#include "experiments/record/stage_words.h"

#include <array>
#include <map>

#include "core/base/error.h"
#include "core/base/text.h"

namespace farcull {
namespace {

std::string number(std::uint64_t n) { return std::to_string(n); }

std::string objects(std::uint64_t n) { return counted(n, "object", "objects"); }
std::string triangles(std::uint64_t n) { return counted(n, "triangle", "triangles"); }
std::string triangles_left(std::uint64_t n) {
  return counted(n, "triangle is left", "triangles are left");
}

// The first word of a stage's name, as in "fatten x, round 2"; in the order of StageKind.
constexpr std::array kVerbs = {"boxes",
                               "blocks",
                               "setup",
                               "draw",
                               "patches",
                               "object level",
                               "sub-object level",
                               "view",
                               "fatten",
                               "cull",
                               "agree",
                               "further views",
                               "further rounds",
                               "offset",
                               "sweep",
                               "join",
                               "exact",
                               "near pairs",
                               "closest points",
                               "inside",
                               "verify",
                               "read",
                               "kinds of contact",
                               "touch",
                               "depth"};
static_assert(kVerbs.size() == static_cast<std::size_t>(StageKind::depth) + 1);

std::string verb_of(StageKind kind) { return kVerbs.at(static_cast<std::size_t>(kind)); }

std::string at_most_rounds(const Stage& stage) {
  return stage.m > 0 ? "; at most " + number(stage.m) + " rounds" : "";
}

}  // namespace

std::string to_string(Unit unit) {
  constexpr std::array kUnits = {"", "triangles", "pairs"};
  return kUnits.at(static_cast<std::size_t>(unit));
}

std::string level_name(std::uint32_t level) {
  return level == kNoLevel         ? ""
         : level == kObjectLevel   ? "objects"
         : level == kTriangleLevel ? "triangles"
                                   : "clusters of " + number(level);
}

std::string name_of(const Stage& stage) {
  std::string name = verb_of(stage.kind);
  if (stage.level != kNoLevel) name += " " + level_name(stage.level);
  if (!stage.subject.empty()) name += " " + stage.subject;
  if (stage.round > 0) name += ", round " + number(stage.round);
  return name;
}

std::string reason_of(const Stage& stage) {
  const std::string n = grouped(stage.n), m = grouped(stage.m);
  const std::string apart = stage.k ? ", ignored ones apart" : "";
  const std::string moved = stage.k ? ", of which something moved in " + number(*stage.k) : "";
  const std::string blocks = "pairs of blocks (of at most 16 triangles) whose boxes";
  const std::string by_tree = ": pairs by a tree over the boxes of all triangles";
  const std::string of_objects = "; pairs of objects, and objects with themselves: " + m;
  switch (stage.reason) {
    case Reason::none:
      return "";
    case Reason::full:
      return spelled("{full}: nothing is left out");
    case Reason::regions:
      return counted(stage.n, "pair of objects' boxes overlaps", "pairs of objects' boxes overlap");
    case Reason::meetings:
      return "pairs of objects whose boxes overlap" + apart + ": " + n +
             "; objects tested against themselves: " + m;
    case Reason::crowded:
      return "pairs of objects whose boxes overlap: too many to list, so all objects take part "
             "whole; objects tested against themselves: " +
             m;
    case Reason::block_pairs:
      return blocks + " overlap: " + n + moved + of_objects;
    case Reason::normal_pairs:
      return blocks + " overlap: " + n + moved + of_objects +
             "; triangles are compared along their normals as well";
    case Reason::oriented_pairs:
      return blocks + " and oriented boxes overlap: " + n + moved + of_objects;
    case Reason::moved_pairs:
      return blocks + ", moved with their objects, overlap: " + n + "; pairs of objects: " + m;
    case Reason::boxes_meet:
      return "pairs of triangles whose boxes overlap: " + n + "; a triangle in none is not drawn";
    case Reason::boxes_decide_little:
      return "boxes of triangles meet too often, or lie too unevenly, to be compared first";
    case Reason::no_boxes_overlap:
      return "no two objects' boxes overlap" + apart + ", none is tested against itself";
    case Reason::no_box_pairs:
      return "no boxes of two triangles that could collide overlap";
    case Reason::no_triangle_meets:
      return "no triangle meets the box of another object";
    case Reason::nothing_to_look_at:
      return "boxes leave nothing to draw: no device is needed";
    case Reason::shaders:
      return "canvas for " + stage.fattener;
    case Reason::fattener:
      return stage.fattener +
             (stage.n > 0 ? "; " + triangles(stage.n) + " beyond the budget, kept" : std::string());
    case Reason::unresolvable:
      return "double arithmetic cannot resolve the region in pixels; nothing is culled here";
    case Reason::nothing_left:
      return "nothing is left";
    case Reason::set_unchanged:
      return "what its passes store has not changed since the last visit";
    case Reason::passes:
      return counted(stage.n, "pass", "passes") +
             (stage.n < 2 ? ", the other stores what it stored at the last visit" : "");
    case Reason::few_left:
      return triangles_left(stage.n) + ", at most " + m + " are enough";
    case Reason::few_to_test:
      return triangles_left(stage.n) + ": " + m + " or fewer are cheaper to test";
    case Reason::patches_cut:
      return counted(stage.n, "patch", "patches") + " of at most " + triangles(stage.m) +
             ": drawn against each other, each joined with itself by boxes";
    case Reason::patches_whole:
      return "no object tested against itself has more than " + triangles(stage.m) +
             ": each is joined with itself by boxes alone";
    case Reason::asked_singly:
      return "every triangle is asked anyway";
    case Reason::rounds_given:
      return spelled("{rounds} " + n);
    case Reason::all_views:
      return "culled is what every view clears";
    case Reason::little_culled:
      return "only " + n + " of " + triangles(stage.m) +
             " were culled: testing the rest is cheaper than going on";
    case Reason::owners:
      return "every triangle is an owner";
    case Reason::clusters_given:
      return spelled("{clusters}");
    case Reason::clusters_large:
      return "occlusion queries, more than " + triangles(stage.n);
    case Reason::clusters_small:
      return triangles(stage.n) + ", at most " + m;
    case Reason::clusters_flags:
      return "flags: a question costs nothing";
    case Reason::sweep:
      if (!stage.k) return "boxes of objects, then of their triangles";
      return "boxes of " + objects(stage.n) + " overlap, which have " + triangles(stage.m) + "; " +
             counted(*stage.k, "place", "places") + " changed, " +
             counted(stage.l, "list", "lists") + " sorted from scratch";
    case Reason::not_cleared:
      return "those of the pairs above that drawing did not clear";
    case Reason::join_kept:
      return "boxes of what is kept";
    case Reason::join_patches:
      return "boxes of what is kept, and of all pairs inside a patch";
    case Reason::join_all:
      return "boxes of all triangles";
    case Reason::join_uneven:
      return "triangles lie unevenly, most of them in a small part of their object's box" + by_tree;
    case Reason::join_crowded:
      return "boxes of too many pairs of objects overlap" + by_tree;
    case Reason::join_often:
      return "boxes of blocks overlap too often, oriented ones too" + by_tree;
    case Reason::join_many_blocks:
      return "boxes of more than " + n + " pairs of blocks overlap" + by_tree;
    case Reason::predicates:
      return "exact predicates on the candidates";
    case Reason::no_candidates:
      return "there are no candidates";
    case Reason::every_pair:
      return "every pair; out: those that were missed";
    case Reason::not_asked:
      return spelled("{no_verify}");
    case Reason::near_boxes:
      return counted(stage.n, "pair of objects", "pairs of objects") + "; boxes compared: " + m;
    case Reason::limited:
      return spelled("{limit}: the search stops at the last pair that is listed");
    case Reason::inside_not_asked:
      return spelled("{inside} no");
    case Reason::if_more_left:
      return stage.n > 0 ? "if more than " + triangles_left(stage.n) : "if any triangle is left";
    case Reason::if_changed:
      return "if the round before changed something" + at_most_rounds(stage);
    case Reason::if_culled:
      return "if at least one triangle in " + n + " was culled last" + at_most_rounds(stage);
    case Reason::if_more_culled:
      return "if more than " + triangles_left(stage.n) + ", and the last view culled one in " + m;
    case Reason::if_candidates:
      return "if there are candidates";
  }
  return "";
}

std::string no_device_reason(const std::vector<Stage>& trace) {
  for (const Stage& stage : trace) {
    if (stage.kind == StageKind::draw) return reason_of(stage) + ": nothing left to draw";
  }
  return "the method draws nothing";
}

std::string text_of(const ProgressStep& step) {
  if (!step.text.empty()) return step.text;
  if (step.kind == StageKind::cull)
    return "culling along " + step.subject + ", round " + number(step.round);
  static const std::map<StageKind, std::string> kWords = {
      {StageKind::setup, "opening the device"},   {StageKind::blocks, "comparing boxes of blocks"},
      {StageKind::join, "joining boxes"},         {StageKind::sweep, "sweep and prune"},
      {StageKind::exact, "exact tests"},          {StageKind::verify, "accounting for every pair"},
      {StageKind::touch, "touching or clashing"}, {StageKind::depth, "depths"}};
  const auto words = kWords.find(step.kind);
  return words == kWords.end() ? verb_of(step.kind) : words->second;
}

}  // namespace farcull
