#include "experiments/run.h"

#include <fmt/format.h>

#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <limits>

#include "core/error.h"
#include "experiments/kernel_probes.h"
#include "experiments/run_culled.h"
#include "experiments/run_pairs.h"
#include "verify/exact.h"

namespace farcull {
namespace {

void run_exact(const Scene& scene, const Progress& progress, RunRecord& record) {
  if (progress) progress("exact tests of every pair");
  ExactResult result = all_colliding_pairs(scene, {.clearance = record.options.clearance});
  record.device_note = "the method draws nothing";
  record.pcs_triangles = scene.triangles.size();
  for (const Object& object : scene.objects) record.pcs_objects += object.triangle_count > 0;
  record.candidate_pairs = result.box_pairs;
  record.pairs = std::move(result.pairs);
  record.neighbour_pairs = std::move(result.neighbour_pairs);
  record.neighbours = result.neighbours;
  std::set_union(record.pairs.begin(), record.pairs.end(), record.neighbour_pairs.begin(),
                 record.neighbour_pairs.end(), std::back_inserter(record.kept));
  record.ms.cull = result.join_ms;
  record.ms.exact = result.predicates_ms;
  record.stages.push_back({.name = "join",
                           .ran = true,
                           .reason = "boxes of all triangles",
                           .ms = result.join_ms,
                           .in = scene.triangles.size(),
                           .out = result.box_pairs,
                           .unit = "pairs"});
  record.stages.push_back({.name = "exact",
                           .ran = true,
                           .reason = "exact predicates on the candidates",
                           .ms = result.predicates_ms,
                           .in = result.box_pairs,
                           .out = record.kept.size(),
                           .unit = "pairs"});
}

// What becomes of the candidates.
void decide_stage(const Scene& scene, const Progress& progress, RunRecord& record) {
  if (record.kept.empty() && !record.options.full) {
    record.stages.push_back(
        {.name = "exact", .reason = "there are no candidates", .unit = "pairs"});
    return;
  }
  if (progress) progress("exact tests");
  const Stopwatch exact;
  Collisions collisions = decide(scene, record.kept, {.clearance = record.options.clearance});
  record.ms.exact = exact.ms();
  record.pairs = std::move(collisions.pairs);
  record.neighbour_pairs = std::move(collisions.neighbour_pairs);
  record.neighbours = collisions.neighbours;
  record.stages.push_back({.name = "exact",
                           .ran = true,
                           .reason = "exact predicates on the candidates",
                           .ms = record.ms.exact,
                           .in = record.kept.size(),
                           .out = record.pairs.size() + record.neighbour_pairs.size(),
                           .unit = "pairs"});
}

// Accounts for every pair that culling did not leave to the exact tests.
void verify_stage(const Scene& scene, const Progress& progress, RunRecord& record) {
  if (!record.options.verify) {
    record.stages.push_back({.name = "verify", .reason = "--no-verify", .unit = "pairs"});
    return;
  }
  if (progress) progress("accounting for every pair");
  record.verification = account(scene, record.kept,
                                {.clearance = record.options.clearance,
                                 .max_examples = std::numeric_limits<std::size_t>::max()});
  Accounting& accounting = *record.verification;
  if (record.options.clearance == 0) record.missed = count_contacts(scene, accounting.examples);
  accounting.examples.resize(std::min(accounting.examples.size(), kExamples));
  record.stages.push_back({.name = "verify",
                           .ran = true,
                           .reason = "every pair; out: those that were missed",
                           .ms = accounting.ms,
                           .in = accounting.pairs_total,
                           .out = accounting.false_negatives,
                           .unit = "pairs"});
}

}  // namespace

const GlContext& Session::context() {
  if (!context_) context_ = std::make_unique<GlContext>(device_);
  return *context_;
}

const DeviceVerdict& Session::verdict(Reliance reliance) {
  const auto known = verdicts_.find(reliance);
  if (known != verdicts_.end()) return known->second;
  const Probes probes = [this, reliance] {
    return reliance == Reliance::pairs ? pair_probes(context()) : drawing_probes(context());
  };
  const Say say = [](const std::string& line) {
    // Progress may stand in the line.
    std::fprintf(stderr, "%sfarcull: %s\n", ::isatty(STDERR_FILENO) ? "\r\033[K" : "",
                 line.c_str());
  };
  return verdicts_.emplace(reliance, device_verdict(context().info(), reliance, probes, say))
      .first->second;
}

void rely_on_device(Session& session, Reliance reliance, RunRecord& record) {
  if (!promises(record.options)) return;
  record.verdict = session.verdict(reliance);
  record.promises = record.verdict->holds;
  record.promise_reason = to_string(*record.verdict, reliance);
}

GlCanvas& Session::canvas(const Fattener& fattener, const GlCanvasOptions& options) {
  return canvases_
      .try_emplace({fattener.name, options.depth_format, options.query}, context(), fattener.mode,
                   fattener.solid, options)
      .first->second;
}

PairDevice& Session::pairs() {
  if (!pairs_)
    pairs_ = open_pair_device(device_, 0, [this]() -> const GlContext& { return context(); });
  return *pairs_;
}

void Session::forget_device() {
  canvases_.clear();
  pairs_.reset();
  context_.reset();
  verdicts_.clear();  // another device may answer next time
}

bool promises(const RunOptions& options) {
  if (options.method == Method::far) {
    return depth_of(options) == DepthMode::fragment && !options.radius.published &&
           options.radius.factor >= 1;
  }
  return options.method == Method::far_pairs || options.method == Method::i_collide;
}

Stage work_of(const std::vector<Stage>& stages) {
  Stage out;
  for (const Stage& stage : stages) {
    out.draws += stage.draws;
    out.queries += stage.queries;
    out.draws_saved += stage.draws_saved;
    out.queries_saved += stage.queries_saved;
  }
  return out;
}

bool has_self(const Scene& scene) {
  return std::any_of(scene.objects.begin(), scene.objects.end(),
                     [](const Object& object) { return object.self; });
}

void require_scene(const Scene& scene, Method method) {
  const bool self = has_self(scene);
  if (self && !tests_self(method)) {
    throw Error(scene.name,
                to_string(method) + " tests no object against itself, as one of it has to be",
                "use --method " + method_names(tests_self));
  }
  if (!self && tests_self_alone(method)) {
    throw Error(scene.name,
                to_string(method) + " tests objects against themselves, and none of it has to be",
                "add --self, or use --method cullide or quick-cullide");
  }
}

RunRecord run_scene(const Scene& scene, const RunOptions& options, Session& session,
                    const Progress& progress) {
  const FloatingPointGuard guard;
  validate(options);
  require_scene(scene, options.method);
  RunRecord record;
  record.callers = callers_floating_point();
  record.options = options;
  record.promises = promises(options);
  record.promise_reason =
      record.promises ? "nothing rests on a device" : "the method, or its radius, promises nothing";
  record.scene_hash = scene_hash(scene);
  record.degenerate_triangles = degenerate_triangles(scene);

  if (options.method == Method::exact) {
    run_exact(scene, progress, record);
  } else {
    try {
      if (options.method == Method::far_pairs) {
        run_far_pairs(scene, session, progress, record);
      } else if (options.method == Method::i_collide) {
        run_swept(scene, session, progress, record);
      } else {
        run_culled(scene, session, progress, record);
      }
    } catch (...) {
      session.forget_device();
      throw;
    }
    decide_stage(scene, progress, record);
  }
  record.ms.total = record.ms.setup + record.ms.cull + record.ms.exact;
  verify_stage(scene, progress, record);
  require_proved("arithmetic");  // a driver's code ran in this thread too
  record.used = floating_point();
  return record;
}

bool broken(const RunRecord& record, bool strict) {
  return (strict || promises(record.options)) && record.verification &&
         record.verification->false_negatives > 0;
}

}  // namespace farcull
