#include "experiments/run_culled.h"

#include <fmt/format.h>

#include <utility>

#include "core/box_join.h"
#include "core/plan.h"
#include "experiments/run_pairs.h"
#include "offsets/exact.h"
#include "offsets/obb.h"

namespace farcull {
namespace {

Canvas& open_canvas(const Fattener& fattener, Session& session, const Progress& progress,
                    RunRecord& record) {
  if (progress) progress("opening the device");
  const Stopwatch setup;
  session.context();
  rely_on_device(session, Reliance::drawing, record);
  GlCanvas& canvas = session.canvas(
      fattener, {.depth_format = record.options.depth_format, .query = query_of(record.options)});
  record.device = session.context().info();
  record.depth_bits = canvas.limits().depth_bits;
  record.stages.push_back({.name = "setup",
                           .ran = true,
                           .reason = "context and shaders for " + fattener.name,
                           .ms = setup.ms(),
                           .unit = ""});
  record.ms.setup += setup.ms();
  return canvas;
}

// Culls with one offset after the other, each on what the one before has left, or says in the
// record why nothing had to be drawn.
std::vector<std::uint32_t> cull_stage(const Scene& scene, const Plan& plan, Session& session,
                                      const Progress& progress, RunRecord& record) {
  const RunOptions& options = record.options;
  if (plan.triangles.empty()) {
    record.device_note = plan.regions.empty()
                             ? "no two objects' boxes overlap: nothing to draw"
                             : "no triangle meets the box of another object: nothing to draw";
    record.stages.push_back({.name = "draw", .reason = record.device_note, .unit = "triangles"});
    return {};
  }
  CullSettings settings{
      .views = parse_views(views_of(options)),
      .resolution = resolution_of(options),
      .fattener = {.name = "", .mode = DepthMode::fixed, .solid = {}, .fatten = {}},
      .radius = options.radius,
      .quick = options.method != Method::cullide,
      .self = options.method == Method::s_cullide,
      .touching = options.method != Method::s_cullide,
      .clusters = clusters_of(options, plan.triangles.size()),
      .full = options.full,
      .enough = promises(options) && !options.full ? kFewTriangles : 0,
      .bits = {}};
  CullResult result;
  result.live = plan.triangles;
  for (Fattener& fattener : fatteners_of(options)) {
    if (!record.views.empty() && result.live.size() <= settings.enough) {
      record.stages.push_back(
          {.name = "offset " + fattener.name,
           .reason = fmt::format("{} triangles are left: {} or fewer are cheaper to test",
                                 result.live.size(), settings.enough),
           .in = result.live.size(),
           .out = result.live.size(),
           .unit = "triangles"});
      break;
    }
    Canvas& canvas = open_canvas(fattener, session, progress, record);
    settings.fattener = std::move(fattener);
    settings.bits = std::move(result.bits);
    result = cull(scene, plan, settings, canvas, progress);
    record.views = std::move(result.views);
    record.stages.insert(record.stages.end(), result.stages.begin(), result.stages.end());
  }
  return std::move(result.live);
}

Stage boxes_stage(const Scene& scene, const Plan& plan, const RunOptions& options, double ms) {
  std::string reason = plan.regions.size() == 1
                           ? "1 pair of objects' boxes overlaps"
                           : fmt::format("{} pairs of objects' boxes overlap", plan.regions.size());
  if (options.full) reason = "--full: every triangle is drawn";
  return {.name = "boxes",
          .ran = true,
          .reason = std::move(reason),
          .ms = ms,
          .in = scene.triangles.size(),
          .out = plan.triangles.size(),
          .unit = "triangles"};
}

// Those in a pair, and those that are tested against themselves; ascending.
std::vector<std::uint32_t> surviving_objects(const Scene& scene,
                                             const std::vector<TrianglePair>& pairs) {
  std::vector<std::uint8_t> in(scene.objects.size(), 0);
  for (const TrianglePair& pair : pairs) in[pair.a] = in[pair.b] = 1;
  std::vector<std::uint32_t> out;
  for (std::uint32_t o = 0; o < in.size(); ++o) {
    const Object& object = scene.objects[o];
    if (in[o] != 0 || (object.self && object.triangle_count > 1)) out.push_back(o);
  }
  return out;
}

}  // namespace

std::vector<Fattener> fatteners_of(const RunOptions& options) {
  if (options.method != Method::far) return {raw_triangles()};
  if (depth_of(options) == DepthMode::fixed) return {obb_surface_fattener()};
  if (options.offset != "exact") return {obb_fattener()};
  // Where nothing is promised, boxes before would be one more chance to miss.
  if (options.full || !promises(options)) return {exact_fattener()};
  return {obb_fattener(), exact_fattener()};
}

Clusters clusters_of(const RunOptions& options, std::size_t triangles) {
  if (options.method == Method::s_cullide)
    return {.sizes = {}, .reason = "every triangle is an owner"};
  if (options.clusters) return {.sizes = *options.clusters, .reason = "--clusters"};
  return usual_clusters(query_of(options) == QueryMode::occlusion, triangles);
}

void run_culled(const Scene& scene, Session& session, const Progress& progress, RunRecord& record) {
  const Stopwatch planning;
  if (progress) progress("planning");
  const bool self = record.options.method == Method::s_cullide;
  const Plan plan = make_plan(scene, {.self = self, .full = record.options.full});
  record.stages.push_back(boxes_stage(scene, plan, record.options, planning.ms()));
  record.pcs = cull_stage(scene, plan, session, progress, record);
  const std::vector<std::uint32_t>& live = record.pcs;
  record.pcs_triangles = live.size();
  record.pcs_objects = count_objects(scene, live);

  const Stopwatch join;
  if (progress) progress("joining boxes");
  record.kept = box_join(plan.triangle_boxes, self ? join_owners(scene) : owners(scene), live);
  record.candidate_pairs = record.kept.size();
  record.stages.push_back({.name = "join",
                           .ran = true,
                           .reason = "boxes of what is kept",
                           .ms = join.ms(),
                           .in = live.size(),
                           .out = record.kept.size(),
                           .unit = "pairs"});
  record.ms.cull = planning.ms() - record.ms.setup;
}

void run_swept(const Scene& scene, Session& session, const Progress& progress, RunRecord& record) {
  record.device_note = "the method draws nothing";
  if (progress) progress("sweep and prune");
  const Stopwatch sweep;
  if (record.options.full) session.sweep().forget();
  SweepPruneResult result = session.sweep().find(scene);
  record.ms.cull = sweep.ms();
  record.kept = std::move(result.candidates);
  record.candidate_pairs = record.kept.size();
  record.pcs = std::move(result.triangles);
  record.pcs_triangles = record.pcs.size();
  record.pcs_objects = count_objects(scene, record.pcs);
  for (const std::uint32_t o : surviving_objects(scene, result.object_pairs))
    record.object_triangles += scene.objects[o].triangle_count;
  record.stages.push_back(
      {.name = "sweep",
       .ran = true,
       .reason = fmt::format("boxes of {} objects overlap, which have {} triangles; {} places "
                             "changed, {} lists sorted from scratch",
                             result.counts.objects, record.object_triangles, result.counts.swaps,
                             result.counts.sorts),
       .ms = record.ms.cull,
       .in = scene.triangles.size(),
       .out = record.kept.size(),
       .unit = "pairs"});
}

}  // namespace farcull
