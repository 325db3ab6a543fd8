// Sweep and prune on the boxes of objects, then of their triangles (I-COLLIDE, 1995).
#include "core/base/stopwatch.h"
#include "core/base/text.h"
#include "core/scene/scene.h"
#include "experiments/method/methods.h"

namespace farcull {
namespace {

// Triangles of the objects in a pair, and of those that are tested against themselves.
std::uint64_t triangles_of(const Scene& scene, const std::vector<TrianglePair>& object_pairs) {
  std::vector<std::uint8_t> in(scene.objects.size(), 0);
  for (const TrianglePair& pair : object_pairs) in[pair.a] = in[pair.b] = 1;
  std::uint64_t triangles = 0;
  for (std::size_t o = 0; o < in.size(); ++o) {
    const Object& object = scene.objects[o];
    if (in[o] != 0 || (object.self && object.triangle_count > 1))
      triangles += object.triangle_count;
  }
  return triangles;
}

Stage sweep_stage(const Scene& scene) {
  return {.kind = StageKind::sweep,
          .ran = true,
          .reason = Reason::sweep,
          .in = scene.triangles.size(),
          .unit = Unit::pairs};
}

}  // namespace

void plan_sweep(const Scene& scene, unsigned, const Progress&, Plan& plan) {
  plan.ahead.push_back(sweep_stage(scene));
}

Candidates find_by_sweep(const Scene& scene, const Plan& plan, Session& session,
                         const Progress& progress) {
  if (progress) progress("sweep and prune");
  const Stopwatch watch;
  if (plan.options.full) session.sweep().forget();
  SweepPruneResult result = session.sweep().find(scene);
  Candidates out;
  out.ms = watch.ms();
  out.device.note = "the method draws nothing";
  out.count = result.candidates.size();
  out.pairs = std::move(result.candidates);
  out.triangles = std::move(result.triangles);
  out.triangle_count = out.triangles.size();
  out.object_count = count_objects(scene, out.triangles);
  const std::uint64_t swept = triangles_of(scene, result.object_pairs);
  out.by = SweptObjects{swept};
  Stage stage = sweep_stage(scene);
  stage.n = result.counts.objects;
  stage.m = swept;
  stage.detail = counted(result.counts.swaps, "place", "places") + " changed, " +
                 counted(result.counts.sorts, "list", "lists") + " sorted from scratch";
  stage.ms = out.ms;
  stage.out = out.count;
  out.trace.push_back(stage);
  return out;
}

}  // namespace farcull
