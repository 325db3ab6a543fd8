// Plans a run. Each method plans its search for candidates. The later stages are planned here.
#include "experiments/method/plan.h"

#include <utility>

#include "core/base/error.h"
#include "core/base/floating_point.h"
#include "core/base/stopwatch.h"
#include "core/scene/scene.h"

namespace farcull {

std::vector<Stage> Plan::stages() const {
  std::vector<Stage> all = trace;
  all.insert(all.end(), ahead.begin(), ahead.end());
  return all;
}

Plan plan(const Scene& scene, const RunOptions& options, unsigned threads, const Progress& progress,
          FrameMemory* memory, const BlockDecision* decided) {
  const FloatingPointGuard guard;
  const Stopwatch watch;
  validate(options);
  require_scene(scene, options.method);
  if (progress) progress("planning");
  Plan out{.options = options, .work = {}, .trace = {}, .ahead = {}};
  if (!scene.ignored.empty()) {
    std::vector<ObjectPair>& all = out.options.ignored;
    all.insert(all.end(), scene.ignored.begin(), scene.ignored.end());
    all = in_order(std::move(all));
  }
  out.memory = memory;
  out.decided = decided;
  const Traits& method = traits(options.method);
  method.plan(scene, threads, progress, out);
  const bool always = options.full || !method.culls;
  out.ahead.push_back({.kind = StageKind::exact,
                       .ran = true,
                       .depends = !always,
                       .reason = always ? Reason::predicates : Reason::if_candidates,
                       .unit = Unit::pairs});
  out.ahead.push_back({.kind = StageKind::verify,
                       .ran = options.verify,
                       .reason = options.verify ? Reason::every_pair : Reason::not_asked,
                       .unit = Unit::pairs});
  out.ms = watch.ms();
  return out;
}

void require_scene(const Scene& scene, Method method) {
  const bool self = has_self(scene);
  if (self && !tests_self(method)) {
    throw Error(scene.name,
                to_string(method) + " tests no object against itself, as one of it has to be",
                "use {method} " + method_names([](const Traits& t) { return t.tests_self; }));
  }
  if (!self && tests_self_alone(method)) {
    throw Error(scene.name,
                to_string(method) + " tests objects against themselves, and none of it has to be",
                "add {self}, or use {method} cullide or quick-cullide");
  }
}

}  // namespace farcull
