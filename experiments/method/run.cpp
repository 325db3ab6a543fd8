// The one pipeline. Command line, library, benchmark, studies and pictures call it.
#include "experiments/method/run.h"

#include "core/scene/scene.h"

namespace farcull {

Candidates find(const Scene& scene, const Plan& plan, Session& session, const Progress& progress) {
  const FloatingPointGuard guard;
  try {
    Candidates found = traits(plan.options.method).find(scene, plan, session, progress);
    const std::uint64_t removed = remove_ignored(scene, plan.options.ignored, found.pairs);
    found.ignored += removed;
    found.count -= removed;
    return found;
  } catch (...) {
    session.forget_device();
    throw;
  }
}

Promise promise_of(const RunOptions& options, const UsedDevice& device, Session& session) {
  Promise promise;
  promise.holds = promises(options);
  promise.reason =
      promise.holds ? "nothing rests on a device" : "the method, or its radius, promises nothing";
  if (!promise.holds || !device.relies) return promise;
  try {
    promise.verdict = session.verdict(*device.relies);
  } catch (...) {
    session.forget_device();
    throw;
  }
  promise.holds = promise.verdict->holds;
  promise.reason = to_string(*promise.verdict, *device.relies);
  return promise;
}

Record run(const Scene& scene, const RunOptions& options, Session& session,
           const Progress& progress) {
  const FloatingPointGuard guard;
  Record record;
  record.callers = callers_floating_point();
  record.options = options;
  const Plan planned = plan(scene, options, session.threads(), progress, session.pair_memory());
  record.options.ignored = planned.options.ignored;
  record.plan = planned.stages();
  record.trace = planned.trace;
  record.scene_hash = scene_hash(scene);
  record.degenerate_triangles = degenerate_triangles(scene);

  record.found = find(scene, planned, session, progress);
  // Where the method gives pairs alone.
  if (!record.found.pairs.empty() && record.found.triangles.empty())
    count_kept(scene, record.found);
  record.trace.insert(record.trace.end(), record.found.trace.begin(), record.found.trace.end());
  record.promise = promise_of(options, record.found.device, session);
  record.ms.setup = record.found.setup_ms;
  record.ms.cull = planned.ms + record.found.ms;
  decide_stage(scene, session, progress, record);
  record.ms.total = record.ms.setup + record.ms.cull + record.ms.exact;
  std::vector<TrianglePair> decided;  // of a method that decides as it finds
  if (options.verify && !culls(options.method)) decided = pairs_left(record);
  verify_stage(scene, culls(options.method) ? record.found.pairs : decided, progress, record);
  // Of a method that decides as it finds: decide_first() has kept to the limit already.
  if (options.limit > 0 && keep_first(options.limit, record.collisions)) record.complete = false;
  contact_stage(scene, session, progress, record);
  require_proved("arithmetic");  // a driver's code ran in this thread too
  record.used = floating_point();
  return record;
}

std::vector<TrianglePair> pairs_left(const Record& record) {
  if (culls(record.options.method)) return record.found.pairs;
  return record.collisions.all();
}

bool broken(const Record& record, bool strict) {
  return (strict || promises(record.options)) && record.verification &&
         record.verification->false_negatives > 0;
}

}  // namespace farcull
