// FAR pairs (core/pairs/pairs.h): boxes of runs on the CPU, or interval pairs on the device of the
// session.
#include "core/base/stopwatch.h"
#include "core/pairs/backend.h"
#include "experiments/method/methods.h"

namespace farcull {

void plan_far_pairs(const Scene& scene, unsigned threads, const Progress&, Plan& plan) {
  const RunOptions& options = plan.options;
  PairSettings settings{.views = {},
                        .resolution = resolution_of(options),
                        .clearance = options.clearance,
                        .full = options.full,
                        // Who names a GL device wants it to look.
                        .blocks = options.device.empty() || is_cpu(options.device),
                        .neighbours = options.neighbours,
                        .ignored = options.ignored};
  if (!views_of(options).empty()) settings.views = parse_views(views_of(options));
  PairPlan pairs = plan_pairs(scene, settings, threads, plan.memory);
  plan.trace = pairs.trace;
  Stage setup{.kind = StageKind::setup};
  if (pairs.choices.empty()) {
    setup.reason = Reason::nothing_to_look_at;
  } else {
    setup.ran = true;
    setup.reason = Reason::device;
    setup.detail = options.device.empty() ? "OpenGL compute where hardware answers, else the cpu"
                                          : options.device;
  }
  plan.ahead.push_back(setup);
  const std::vector<Stage> views = planned_stages(pairs);
  plan.ahead.insert(plan.ahead.end(), views.begin(), views.end());
  plan.work = std::move(pairs);
}

namespace {

void take(PairResult&& result, Candidates& out) {
  out.pairs = std::move(result.candidates);
  out.count = out.pairs.size();
  out.by = std::move(result.views);
  out.trace.insert(out.trace.end(), result.stages.begin(), result.stages.end());
}

}  // namespace

Candidates find_far_pairs(const Scene& scene, const Plan& plan, Session& session,
                          const Progress& progress) {
  const auto& pairs = std::get<PairPlan>(plan.work);
  Candidates out;
  out.by = std::vector<PairView>();
  if (pairs.nothing_can_meet()) {
    out.device.note = plan.options.ignored.empty()
                          ? "no two objects' boxes overlap, and none is tested against itself"
                          : "no two objects' boxes overlap, ignored ones apart, and none is tested "
                            "against itself";
    out.trace.push_back({.kind = StageKind::setup, .reason = Reason::nothing_to_look_at});
    return out;
  }
  if (pairs.choices.empty()) {
    out.device = {.gl = {}, .cpu = true, .note = "boxes of runs decide: no view", .relies = {}};
    out.trace.push_back({.kind = StageKind::setup, .reason = Reason::nothing_to_look_at});
    const Stopwatch watch;
    take(find_pairs(scene, pairs, *cpu_pair_backend(session.threads()), session.pair_workspace(),
                    progress),
         out);
    out.ms = watch.ms();
    return out;
  }
  if (progress) progress("opening the device");
  const Stopwatch setup;
  PairDevice& device = session.pairs();
  out.setup_ms = setup.ms();
  out.device = {.gl = device.gl, .cpu = !device.gl, .note = device.reason, .relies = {}};
  if (device.gl) out.device.relies = Reliance::pairs;
  out.trace.push_back({.kind = StageKind::setup,
                       .ran = true,
                       .reason = Reason::device,
                       .detail = device.backend->name(),
                       .ms = out.setup_ms});

  const Stopwatch watch;
  take(find_pairs(scene, pairs, *device.backend, session.pair_workspace(), progress), out);
  out.ms = watch.ms();
  return out;
}

}  // namespace farcull
