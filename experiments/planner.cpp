#include "experiments/planner.h"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <optional>

#include "core/pair_view.h"
#include "core/plan.h"
#include "experiments/run.h"
#include "experiments/run_culled.h"
#include "experiments/tables.h"

namespace farcull {
namespace {

using Steps = std::vector<PlannedStep>;

std::string of_all(std::size_t some, std::size_t all) {
  return fmt::format("{} of {} triangles", grouped(some), grouped(all));
}

void add_views(const Plan& plan, const RunOptions& options, std::uint32_t enough, Steps& steps) {
  bool sure = true;
  for (const View& view : parse_views(views_of(options))) {
    const std::string name = "view " + view.name;
    const std::optional<Window> window = fit_window(view, plan.regions, resolution_of(options));
    if (!window) {
      steps.push_back(
          {name, Decision::left_out, "double arithmetic cannot resolve the region in pixels"});
      continue;
    }
    std::string reason = fmt::format("{} x {} px", window->width, window->height);
    if (!sure)
      reason += enough > 0 ? fmt::format("; if more than {} triangles are left", enough)
                           : "; if any triangle is left";
    steps.push_back({name, sure ? Decision::runs : Decision::depends, reason});
    sure = options.full;
  }
}

void add_levels(const Plan& plan, const RunOptions& options, Steps& steps) {
  if (options.method == Method::s_cullide) {
    steps.push_back({"objects", Decision::left_out, "every triangle is an owner by itself"});
  } else {
    steps.push_back({"objects", Decision::runs, "in the first round"});
  }
  const Clusters clusters = clusters_of(options, plan.triangles.size());
  steps.push_back({"sub-object level", clusters.sizes.empty() ? Decision::left_out : Decision::runs,
                   clusters.reason});
  steps.push_back(
      {"triangles", options.full ? Decision::runs : Decision::depends,
       options.full ? "--full" : "if any are left; passes whose stored set has changed"});
}

void add_canvas(const Scene& scene, const RunOptions& options, bool promised, Steps& steps) {
  const bool self = options.method == Method::s_cullide;
  const Plan plan = make_plan(scene, {.self = self, .full = options.full});
  steps.push_back({"boxes", Decision::runs,
                   of_all(plan.triangles.size(), scene.triangles.size()) + " can take part; " +
                       std::to_string(plan.regions.size()) + " regions"});
  if (plan.triangles.empty()) {
    steps.push_back({"device", Decision::left_out, "boxes decide: there is nothing to draw"});
    return;
  }
  steps.push_back({"device", Decision::runs,
                   options.device.empty() ? "OpenGL: hardware first, then software"
                                          : "OpenGL: --device " + options.device});
  const std::uint32_t enough = promised && !options.full ? kFewTriangles : 0;
  add_views(plan, options, enough, steps);
  add_levels(plan, options, steps);
  if (options.method != Method::far) return;
  if (options.offset != "exact") {
    steps.push_back({"exact offsets", Decision::left_out, "not asked for (--offset exact)"});
  } else if (options.full || !promised) {
    steps.push_back({"boxes before exact offsets", Decision::left_out,
                     options.full ? "--full" : "nothing is promised at this radius"});
  } else {
    steps.push_back({"exact offsets", Decision::depends,
                     fmt::format("if oriented boxes leave more than {} triangles", enough)});
  }
}

void add_pairs(const Scene& scene, const RunOptions& options, Steps& steps) {
  const PairRegions regions = pair_regions(scene, options.clearance, options.full);
  steps.push_back({"boxes", Decision::runs,
                   of_all(regions.triangles.size(), scene.triangles.size()) + " can take part"});
  if (regions.triangles.empty()) {
    steps.push_back({"device", Decision::left_out, "boxes decide: there is nothing to look at"});
    return;
  }
  const std::string device = options.device.empty()
                                 ? "OpenGL compute where hardware answers, else the cpu"
                                 : options.device;
  steps.push_back({"device", Decision::runs, device});
  if (!options.views.empty()) {
    for (const View& view : parse_views(options.views))
      steps.push_back({"view " + view.name, Decision::runs, "given"});
    return;
  }
  std::size_t number = 0;
  for (const PairChoice& choice : choose_pair_views(scene, regions, resolution_of(options))) {
    if (number == kMostPairViews) break;
    const bool sure = number++ == 0 || options.full;
    steps.push_back(
        {"view " + choice.view.name, sure ? Decision::runs : Decision::depends,
         fmt::format("{} px, {}{}", choice.resolution, choice.reason,
                     sure ? ""
                          : fmt::format("; if more than {} candidates are left for each "
                                        "triangle that takes part",
                                        kFurtherViewFrom))});
  }
}

}  // namespace

Steps planned(const Scene& scene, const RunOptions& options) {
  validate(options);
  require_scene(scene, options.method);
  Steps steps;
  if (draws(options.method)) {
    add_canvas(scene, options, promises(options), steps);
  } else if (options.method == Method::far_pairs) {
    add_pairs(scene, options, steps);
  } else if (options.method == Method::i_collide) {
    steps.push_back({"objects", Decision::runs, "sweep and prune on their boxes"});
    steps.push_back({"triangles", Decision::runs, "of objects whose boxes overlap"});
  }
  if (has_self(scene)) {
    steps.push_back({"self", Decision::runs, "objects are tested against themselves"});
  }
  if (const std::string unasked = not_asked_text(scene); !unasked.empty()) {
    steps.push_back({"self", Decision::left_out, "not asked for (--self): " + unasked});
  } else if (!has_self(scene)) {
    steps.push_back({"self", Decision::left_out, "no object has two triangles"});
  }
  if (options.method == Method::exact || options.full) {
    steps.push_back({"exact tests", Decision::runs,
                     options.full ? "of the candidates" : "of all pairs whose boxes overlap"});
  } else {
    steps.push_back({"exact tests", Decision::depends, "if there are candidates"});
  }
  if (options.verify) {
    steps.push_back({"accounting", Decision::runs, "every pair that was culled"});
  } else {
    steps.push_back({"accounting", Decision::left_out, "--no-verify"});
  }
  return steps;
}

namespace {

std::string text_of(Decision decision) {
  switch (decision) {
    case Decision::runs:
      return "runs";
    case Decision::left_out:
      return "left out";
    case Decision::depends:
      return "depends";
  }
  return "";
}

}  // namespace

std::string plan_table(const Scene& scene, const RunOptions& options, const Steps& steps) {
  Table table("lll");
  table.add({"step", "", "why"});
  for (const PlannedStep& step : steps) table.add({step.name, text_of(step.decision), step.reason});
  return fmt::format("{}: {} objects, {} triangles, {}{}\n\n{}", scene.name,
                     grouped(scene.objects.size()), grouped(scene.triangles.size()),
                     describe(options), options.full ? ", --full" : "", table.text());
}

nlohmann::ordered_json plan_json(const Scene& scene, const RunOptions& options,
                                 const Steps& steps) {
  nlohmann::ordered_json list = nlohmann::ordered_json::array();
  for (const PlannedStep& step : steps) {
    list.push_back(
        {{"step", step.name}, {"decision", text_of(step.decision)}, {"reason", step.reason}});
  }
  return {{"scene", scene.name},
          {"objects", scene.objects.size()},
          {"triangles", scene.triangles.size()},
          {"method", to_string(options.method)},
          {"full", options.full},
          {"steps", list}};
}

}  // namespace farcull
