// All pairs whose boxes overlap, each decided as the join finds it: nothing is culled.
#include "experiments/method/methods.h"

namespace farcull {

void plan_exact(const Scene& scene, unsigned, const Progress&, Plan& plan) {
  plan.ahead.push_back({.kind = StageKind::join,
                        .ran = true,
                        .reason = Reason::join_all,
                        .in = scene.triangles.size(),
                        .unit = Unit::pairs});
}

Candidates find_exact(const Scene& scene, const Plan& plan, Session& session,
                      const Progress& progress) {
  if (progress) progress("exact tests of every pair");
  ExactResult result = all_colliding_pairs(scene,
                                           {.clearance = plan.options.clearance,
                                            .threads = session.cpu_threads(),
                                            .neighbours = plan.options.neighbours},
                                           plan.options.ignored);
  Candidates out;
  out.device.note = "the method draws nothing";
  out.triangle_count = scene.triangles.size();
  for (const Object& object : scene.objects) out.object_count += object.triangle_count > 0;
  out.count = result.box_pairs;
  out.ignored = result.ignored;
  out.ms = result.join_ms;
  out.decided_ms = result.predicates_ms;
  const std::size_t colliding = result.pairs.size() + result.neighbour_pairs.size();
  out.decided = Collisions{.pairs = std::move(result.pairs),
                           .neighbour_pairs = std::move(result.neighbour_pairs),
                           .neighbours = result.neighbours};
  out.trace.push_back({.kind = StageKind::join,
                       .ran = true,
                       .reason = Reason::join_all,
                       .ms = out.ms,
                       .in = scene.triangles.size(),
                       .out = out.count,
                       .unit = Unit::pairs});
  out.trace.push_back({.kind = StageKind::exact,
                       .ran = true,
                       .reason = Reason::predicates,
                       .ms = out.decided_ms,
                       .in = out.count,
                       .out = colliding,
                       .unit = Unit::pairs});
  return out;
}

}  // namespace farcull
