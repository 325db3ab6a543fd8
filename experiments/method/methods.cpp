// The table of methods, and the methods that do not draw. cullide.cpp has the methods that draw.
#include "experiments/method/method.h"

#include <array>

#include "core/base/error.h"
#include "core/base/stopwatch.h"
#include "core/base/text.h"
#include "core/boxes/search.h"
#include "core/scene/scene.h"
#include "experiments/method/plan.h"
#include "experiments/method/record.h"
#include "experiments/method/session.h"

namespace farcull {

// ---- the table: the one place that lists the methods ----

namespace {

constexpr std::array kTable = {
    Traits{.method = Method::far,
           .name = "far",
           .promises = Promises::at_budget_radius,
           .draws = true,
           .fattens = true,
           .quick = true,
           .tests_self = true,
           .plan = plan_drawing,
           .find = find_by_drawing},
    Traits{.method = Method::cullide,
           .name = "cullide",
           .draws = true,
           .plan = plan_drawing,
           .find = find_by_drawing},
    Traits{.method = Method::quick_cullide,
           .name = "quick-cullide",
           .draws = true,
           .quick = true,
           .plan = plan_drawing,
           .find = find_by_drawing},
    Traits{.method = Method::s_cullide,
           .name = "s-cullide",
           .draws = true,
           .quick = true,
           .tests_self = true,
           .tests_self_alone = true,
           .plan = plan_drawing,
           .find = find_by_drawing},
    Traits{.method = Method::i_collide,
           .name = "i-collide",
           .promises = Promises::always,
           .tests_self = true,
           .plan = plan_sweep,
           .find = find_by_sweep},
    Traits{.method = Method::boxes,
           .name = "boxes",
           .promises = Promises::always,
           .tests_self = true,
           .takes_clearance = true,
           .plan = plan_by_boxes,
           .find = find_by_boxes},
    Traits{.method = Method::exact,
           .name = "exact",
           .culls = false,
           .tests_self = true,
           .takes_clearance = true,
           .plan = plan_exact,
           .find = find_exact},
    // A new method goes here.
};

constexpr auto kMethods = [] {
  std::array<Method, kTable.size()> methods{};
  for (std::size_t i = 0; i < kTable.size(); ++i) methods[i] = kTable[i].method;
  return methods;
}();

// traits() uses the value of a method as an index into the table.
static_assert([] {
  for (std::size_t i = 0; i < kTable.size(); ++i) {
    if (static_cast<std::size_t>(kTable[i].method) != i) return false;
  }
  return true;
}());

Stage sweep_stage(const Scene& scene) {
  return {.kind = StageKind::sweep,
          .ran = true,
          .reason = Reason::sweep,
          .in = scene.triangles.size(),
          .unit = Unit::pairs};
}

}  // namespace

const Traits& traits(Method method) { return kTable[static_cast<std::size_t>(method)]; }

std::span<const Method> all_methods() { return kMethods; }

std::string to_string(Method method) { return traits(method).name; }

Method parse_method(const std::string& name, const std::string& option) {
  for (const Method method : all_methods()) {
    if (name == to_string(method)) return method;
  }
  const bool renamed = name == "far-pairs";
  throw Error(option, "'" + name + "' is no method",
              (renamed ? "far-pairs is now called boxes; "
                       : did_you_mean(likely_word(name, list_of_methods()))) +
                  "give " + method_names());
}

std::vector<std::string> list_of_methods(const std::function<bool(const Traits&)>& can) {
  std::vector<std::string> names;
  for (const Traits& method : kTable) {
    if (!can || can(method)) names.emplace_back(method.name);
  }
  return names;
}

std::string method_names(const std::function<bool(const Traits&)>& can) {
  const std::vector<std::string> names = list_of_methods(can);
  std::string text;
  for (std::size_t i = 0; i < names.size(); ++i)
    text += (i == 0 ? "" : i + 1 < names.size() ? ", " : " or ") + names[i];
  return text;
}

// The method `exact`. Decides each pair of triangles whose boxes overlap, as soon as it is found.

void plan_exact(const Scene& scene, unsigned, const Progress&, Plan& plan) {
  plan.ahead.push_back({.kind = StageKind::join,
                        .ran = true,
                        .reason = Reason::join_all,
                        .in = scene.triangles.size(),
                        .unit = Unit::pairs});
}

Candidates find_exact(const Scene& scene, const Plan& plan, Session& session,
                      const Progress& progress, const TakePairs&) {
  if (progress) progress("exact tests of every pair");
  ExactResult result = all_colliding_pairs(scene,
                                           {.clearance = plan.options.clearance,
                                            .threads = session.cpu_threads(),
                                            .neighbours = plan.options.neighbours},
                                           plan.options.ignored);
  Candidates out;
  out.triangle_count = scene.triangles.size();
  for (const Object& object : scene.objects) out.object_count += object.triangle_count > 0;
  out.count = result.box_pairs;
  out.ignored = result.ignored;
  out.ms = result.join_ms;
  out.decided_ms = result.predicates_ms;
  out.streamed = true;
  out.decided = std::move(result);
  out.trace.push_back({.kind = StageKind::join,
                       .ran = true,
                       .reason = Reason::join_all,
                       .ms = out.ms,
                       .in = scene.triangles.size(),
                       .out = out.count,
                       .unit = Unit::pairs});
  return out;
}

// The method `i-collide` (1995). Sweep and prune on boxes of objects, then on boxes of triangles.

void plan_sweep(const Scene& scene, unsigned, const Progress&, Plan& plan) {
  plan.ahead.push_back(sweep_stage(scene));
}

Candidates find_by_sweep(const Scene& scene, const Plan& plan, Session& session,
                         const Progress& progress, const TakePairs&) {
  if (progress) progress(StageKind::sweep);
  const Stopwatch watch;
  if (plan.options.full) session.sweep().forget();
  SweepPruneResult result = session.sweep().find(scene);
  Candidates out;
  out.ms = watch.ms();
  out.count = result.candidates.size();
  out.pairs = std::move(result.candidates);
  out.triangles = std::move(result.triangles);
  out.triangle_count = out.triangles.size();
  out.object_count = count_objects(scene, out.triangles);
  // Counts the triangles of objects that are in a pair or are tested against themselves.
  std::vector<std::uint8_t> in(scene.objects.size(), 0);
  for (const TrianglePair& pair : result.object_pairs) in[pair.a] = in[pair.b] = 1;
  std::uint64_t swept = 0;
  for (std::size_t o = 0; o < in.size(); ++o) {
    const Object& object = scene.objects[o];
    if (in[o] != 0 || (object.self && object.triangle_count > 1)) swept += object.triangle_count;
  }
  out.by = SweptObjects{swept};
  Stage stage = sweep_stage(scene);
  stage.n = result.counts.objects;
  stage.m = swept;
  stage.k = result.counts.swaps;
  stage.l = result.counts.sorts;
  stage.ms = out.ms;
  stage.out = out.count;
  out.trace.push_back(stage);
  return out;
}

void plan_by_boxes(const Scene& scene, unsigned threads, const Progress&, Plan& plan) {
  const RunOptions& options = plan.options;
  BoxesPlan boxes = plan_boxes(scene,
                               {.clearance = options.clearance,
                                .full = options.full,
                                .neighbours = options.neighbours,
                                // The verification needs a list of all candidates.
                                .lists = options.verify,
                                .ignored = options.ignored},
                               threads, plan.memory, plan.decided);
  plan.trace = boxes.trace;
  plan.ahead.push_back(planned_stage(boxes));
  plan.work = std::move(boxes);
}

Candidates find_by_boxes(const Scene& scene, const Plan& plan, Session&, const Progress& progress,
                         const TakePairs& take) {
  const Stopwatch watch;
  BoxesResult result =
      find_boxes(scene, std::get<BoxesPlan>(plan.work), plan.memory, progress, take);
  Candidates out;
  out.pairs = std::move(result.candidates);
  out.streamed = result.streamed;
  out.count = result.count;
  out.trace.push_back(std::move(result.stage));
  out.ms = watch.ms();
  return out;
}

}  // namespace farcull
