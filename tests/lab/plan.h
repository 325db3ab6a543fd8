// A plan against the trace of the run that executed it.
#pragma once

#include "experiments/method/run.h"
#include "experiments/record/stage_words.h"
#include "experiments/scenes/builtin/scenes.h"
#include "tests/lab/test.h"

namespace farcull::lab {

/// Every built-in scene, of the packaged meshes or not, cut down to about so many triangles (fewer
/// under a sanitizer) where its name takes a size.
inline std::vector<std::string> scene_names(bool of_packaged_meshes, int triangles = 20000) {
  const double kTriangles = trials(triangles);
  std::vector<std::string> names;
  for (const BuiltinScene& scene : builtin_scenes()) {
    if (scene.needs_meshes != of_packaged_meshes) continue;
    std::string name = scene.name;
    if (scene.size && scene.triangles > kTriangles) {
      const double part = kTriangles / scene.triangles * static_cast<double>(scene.size->usual);
      name += ":" + std::to_string(std::max(scene.size->least, static_cast<std::uint64_t>(part)));
    }
    names.push_back(name);
  }
  return names;
}

/// A stage without what only the run knows: times and counts.
inline std::string fixed_part(const Stage& stage) {
  std::string text = name_of(stage) + (stage.ran ? " runs: " : " left out: ");
  // The counts of a sweep are not known before.
  if (stage.reason == Reason::sweep) return text + "sweep";
  Stage planned = stage;
  if (stage.reason == Reason::fattener) planned.n = 0;  // triangles beyond the budget
  return text + reason_of(planned);
}

/// Whether a planned stage whose running pixels decide covers this one of the trace.
inline bool covers(const Stage& planned, const Stage& ran) {
  if (planned.kind == StageKind::further_rounds) return ran.round > 1 || planned.kind == ran.kind;
  // A further offset stands for all that is drawn with it.
  if (planned.kind == StageKind::offset) return ran.depends;
  // What is left out of a view is one stage.
  if (ran.kind == StageKind::view || ran.kind == StageKind::further_views)
    return planned.kind == StageKind::fatten || planned.kind == StageKind::view;
  return planned.kind == ran.kind && planned.subject == ran.subject && planned.level == ran.level &&
         planned.round == ran.round;
}

/// The first stage in which plan and trace differ, in words; "" where the run followed its plan.
/// Stages that no pixel decides have to be the same, in order, with the same reasons; each of the
/// others has to be covered by a planned one that depends.
inline std::string not_followed(const Record& record) {
  std::vector<std::string> planned, traced;
  std::vector<Stage> depending;
  for (const Stage& stage : record.plan)
    if (stage.depends)
      depending.push_back(stage);
    else
      planned.push_back(fixed_part(stage));
  for (const Stage& stage : record.trace) {
    if (!stage.depends) {
      traced.push_back(fixed_part(stage));
      continue;
    }
    const bool covered =
        std::ranges::any_of(depending, [&](const Stage& p) { return covers(p, stage); });
    if (!covered) return "not planned: " + fixed_part(stage);
  }
  const auto [p, t] = std::mismatch(planned.begin(), planned.end(), traced.begin(), traced.end());
  if (p == planned.end() && t == traced.end()) return "";
  return "planned: " + (p == planned.end() ? "nothing" : *p) +
         "; run: " + (t == traced.end() ? "nothing" : *t);
}

}  // namespace farcull::lab
