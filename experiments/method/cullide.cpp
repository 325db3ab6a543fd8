// FAR and the CULLIDE family. Boxes select the triangles to draw. A canvas culls these triangles in
// each view, with one offset after the other. Candidates are pairs of remaining triangles whose
// boxes overlap.
#include <algorithm>
#include <iterator>

#include "core/base/error.h"
#include "core/base/stopwatch.h"
#include "core/boxes/join.h"
#include "core/boxes/meetings.h"
#include "core/cull/view_order.h"
#include "core/native/canvas.h"
#include "core/scene/scene.h"
#include "experiments/method/plan.h"
#include "experiments/method/record.h"
#include "experiments/method/session.h"
#include "offsets/offsets.h"
// The header of a new offset goes here.

namespace farcull {
namespace {

// True if stages may be skipped. This loses no pair, since the method is guaranteed to miss none.
bool is_thrifty(const RunOptions& options) {
  return guaranteed(options) && !options.full && !options.no_shortcuts;
}

// Returns the offsets in the order of use. Each offset is applied to the triangles that remain
// after the previous offset.
std::vector<Fattener> fatteners_of(const RunOptions& options) {
  if (!fattens(options.method)) return {raw_triangles()};
  if (depth_of(options) == DepthMode::fixed) return {obb_surface_fattener()};
  if (options.offset == "obb") return {obb_fattener()};
  // A new offset goes here.
  // Without a guarantee, culling by oriented boxes first would add one more way to miss pairs.
  if (!is_thrifty(options)) return {minkowski_fattener()};
  return {obb_fattener(), minkowski_fattener()};
}

Clusters clusters_of(const RunOptions& options, std::size_t triangles) {
  if (tests_self_alone(options.method)) return {.sizes = {}, .reason = Reason::owners};
  if (options.objects_alone) return {};
  if (options.clusters) return {.sizes = *options.clusters, .reason = Reason::clusters_given};
  return usual_clusters(query_of(options) == QueryMode::occlusion, triangles);
}

CullSettings settings_of(const RunOptions& options, std::size_t triangles) {
  const bool self = tests_self_alone(options.method);
  const bool thrifty = is_thrifty(options);
  return {.views = parse_views(views_of(options)),
          .resolution = resolution_of(options),
          .fattener = {},
          .radius = options.radius,
          .quick = traits(options.method).quick,
          .self = self,
          .touching = !self,
          .clusters = clusters_of(options, triangles),
          .clear = options.clear,
          .rounds = options.rounds,
          .objects_alone = options.objects_alone,
          .full = options.full,
          .enough = thrifty ? kFewTriangles : 0,
          .object_level = !thrifty,
          .worth_a_view = thrifty && !options.objects_alone ? kWorthAView : 0};
}

Stage setup_stage(const Fattener& fattener) {
  return {
      .kind = StageKind::setup, .ran = true, .reason = Reason::shaders, .fattener = fattener.name};
}

Stage offset_stage(const Fattener& fattener) {
  return {.kind = StageKind::offset,
          .subject = fattener.name,
          .depends = true,
          .unit = Unit::triangles};
}

Stage join_stage(const DrawPlan& work) {
  return {.kind = StageKind::join,
          .ran = true,
          .reason = work.pairs               ? Reason::not_cleared
                    : work.patches.count > 0 ? Reason::join_patches
                                             : Reason::join_kept,
          .unit = Unit::pairs};
}

// Cuts objects that are tested against themselves into patches.
Stage cut(const Scene& scene, std::span<const Box> boxes, std::span<const std::uint32_t> marked,
          Patches& patches) {
  const Stopwatch watch;
  patches = cut_patches(scene, boxes, marked, usual_patch_size(scene, marked));
  return {.kind = StageKind::patches,
          .ran = patches.cut,
          .reason = patches.cut ? Reason::patches_cut : Reason::patches_whole,
          .n = patches.cut ? patches.count : 0,
          .m = patches.size,
          .ms = watch.ms()};
}

void cull_by_offsets(const Scene& scene, const DrawPlan& work, const RunOptions& options,
                     Session& session, const Progress& progress, Candidates& out) {
  CullSettings settings = work.settings;
  std::vector<ViewReport> views;
  out.triangles = work.regions.triangles;
  for (const Fattener& fattener : work.fatteners) {
    const bool further = &fattener != &work.fatteners.front();
    if (further && out.triangles.size() <= settings.enough) {
      Stage stage = offset_stage(fattener);
      stage.reason = Reason::few_to_test;
      stage.in = stage.out = stage.n = out.triangles.size();
      stage.m = settings.enough;
      out.trace.push_back(stage);
      break;
    }
    if (progress) progress(StageKind::setup);
    const Stopwatch setup;
    Canvas& canvas = session.canvas(fattener, {.depth_format = options.depth_format,
                                               .query = query_of(options),
                                               .conservative = options.conservative});
    out.device.depth_bits = canvas.limits().depth_bits;
    out.device.note = session.canvas_device().reason;
    out.device.cpu = session.canvas_device().native;
    if (out.device.cpu) {
      out.device.lanes = lane_target();
    } else {
      out.device.gl = session.context().info();
      out.device.relies = true;
    }
    Stage stage = setup_stage(fattener);
    stage.depends = further;
    stage.ms = setup.ms();
    out.setup_ms += stage.ms;
    out.trace.push_back(stage);

    settings.fattener = fattener;
    settings.bits = std::move(out.bits);
    const CanvasWork before = canvas.work();
    CullResult result = cull(scene, work.regions, settings, canvas, progress);
    CanvasWork now = canvas.work();
    out.asked += now -= before;
    for (Stage& drawn : result.stages) {
      drawn.depends |= further;
      out.trace.push_back(std::move(drawn));
    }
    out.triangles = std::move(result.live);
    out.bits = std::move(result.bits);
    for (std::size_t v = 0; v < views.size(); ++v) result.views[v].drawn |= views[v].drawn;
    views = std::move(result.views);
  }
  out.by = std::move(views);
}

// Compares boxes of objects, as in the papers, to find the triangles and the regions to draw.
void find_places(const Scene& scene, unsigned threads, Plan& plan, DrawPlan& work) {
  const RunOptions& options = plan.options;
  if (!work.self && has_self(scene)) {
    const std::vector<std::uint32_t> marked = triangles_of_marked(scene);
    plan.trace.push_back(cut(scene, triangle_boxes(scene), marked, work.patches));
  }
  const Stopwatch watch;
  const bool self = work.self || work.patches.cut;
  work.regions = find_regions(scene, {.self = self, .full = options.full, .threads = threads});
  Stage stage{.kind = StageKind::boxes,
              .ran = true,
              .reason = Reason::full,
              .in = scene.triangles.size(),
              .out = work.regions.triangles.size(),
              .unit = Unit::triangles};
  if (!options.full) {
    for (const Object& object : scene.objects)
      stage.m += self && object.self && object.triangle_count > 1;
    stage.reason = self ? Reason::meetings : Reason::regions;
    stage.n = work.regions.places.size() - stage.m;
  }
  stage.ms = watch.ms();
  plan.trace.push_back(stage);
}

// Finds all pairs of triangles whose boxes overlap. Returns false if the boxes cull too little.
bool compare_boxes(const Scene& scene, unsigned threads, Plan& plan, DrawPlan& work) {
  const RunOptions& options = plan.options;
  const Stopwatch watch;
  Stage stage{.kind = StageKind::boxes, .unit = Unit::triangles};
  stage.in = stage.out = scene.triangles.size();
  std::optional<std::vector<TrianglePair>> pairs =
      pairs_of_boxes(scene, options.ignored, options.neighbours, threads);
  if (!pairs) {
    stage.kind = StageKind::blocks;
    stage.reason = Reason::boxes_decide_little;
    stage.ms = watch.ms();
    plan.trace.push_back(stage);
    return false;
  }
  stage.ran = true;
  stage.reason = Reason::boxes_meet;
  stage.n = pairs->size();
  // First, each object is one owner, and the triangles to draw are selected. Then objects that are
  // tested against themselves are cut into patches, and each patch is an owner.
  work.pairs = split_pairs(scene, *pairs, join_owners(scene));
  work.regions = regions_of(scene, work.pairs->drawn);
  stage.out = work.regions.triangles.size();
  stage.ms = watch.ms();
  plan.trace.push_back(stage);
  if (!has_self(scene)) {
    work.patches.owner = owners(scene);
    return true;
  }
  std::vector<std::uint32_t> marked;
  std::ranges::set_intersection(work.regions.triangles, triangles_of_marked(scene),
                                std::back_inserter(marked));
  Stage patches = cut(scene, work.regions.triangle_boxes, marked, work.patches);
  work.pairs = split_pairs(scene, *pairs, work.patches.owner);
  work.regions = regions_of(scene, work.pairs->drawn);
  patches.in = stage.out;
  patches.out = work.regions.triangles.size();
  patches.unit = Unit::triangles;
  plan.trace.push_back(patches);
  return true;
}

}  // namespace

void plan_drawing(const Scene& scene, unsigned threads, const Progress&, Plan& plan) {
  const RunOptions& options = plan.options;
  DrawPlan work;
  work.self = tests_self_alone(options.method);
  const bool objects = options.broad_phase == BroadPhase::objects;
  if (objects || !compare_boxes(scene, threads, plan, work)) {
    plan.options.broad_phase = BroadPhase::objects;
    find_places(scene, threads, plan, work);
  }
  if (options.objects_alone && work.patches.cut) {
    throw Error("{level}", "an object that is tested against itself is asked in patches",
                "leave {level} objects or the self-collision out");
  }
  work.settings = settings_of(options, work.regions.triangles.size());
  if (work.patches.cut) work.settings.owners = work.patches.owner;
  if (work.settings.worth_a_view > 0 && options.views.empty()) {
    work.settings.views =
        order_views(scene, work.regions, work.patches.cut ? work.patches.owner : owners(scene),
                    std::move(work.settings.views));
  }
  if (work.regions.triangles.empty()) {
    plan.trace.push_back(
        {.kind = StageKind::draw,
         .reason = work.patches.count > 0 || (work.pairs && !work.pairs->other.empty())
                       ? Reason::nothing_to_look_at
                   : work.pairs                  ? Reason::no_box_pairs
                   : work.regions.places.empty() ? Reason::no_boxes_overlap
                                                 : Reason::no_triangle_meets,
         .unit = Unit::triangles});
  } else {
    work.fatteners = fatteners_of(options);
    CullSettings first = work.settings;
    first.fattener = work.fatteners.front();
    plan.ahead.push_back(setup_stage(first.fattener));
    const std::vector<Stage> drawn = planned_stages(scene, work.regions, first);
    plan.ahead.insert(plan.ahead.end(), drawn.begin(), drawn.end());
    for (std::size_t k = 1; k < work.fatteners.size(); ++k) {
      Stage stage = offset_stage(work.fatteners[k]);
      stage.ran = true;
      stage.reason = Reason::if_more_left;
      stage.n = work.settings.enough;
      plan.ahead.push_back(stage);
    }
  }
  plan.ahead.push_back(join_stage(work));
  plan.work = std::move(work);
}

Candidates find_by_drawing(const Scene& scene, const Plan& plan, Session& session,
                           const Progress& progress, const TakePairs&) {
  const auto& work = std::get<DrawPlan>(plan.work);
  const Stopwatch watch;
  Candidates out;
  out.by = std::vector<ViewReport>();
  if (!work.fatteners.empty()) cull_by_offsets(scene, work, plan.options, session, progress, out);
  const Stopwatch join;
  if (progress) progress(StageKind::join);
  const std::uint64_t left =
      work.pairs ? work.pairs->drawn.size() + work.pairs->other.size() : out.triangles.size();
  const std::vector<Box>& boxes = work.regions.triangle_boxes;
  if (work.pairs) {
    out.pairs = work.pairs->drawn;
    if (!out.bits.empty()) remove_cleared(out.bits, work.patches.owner, out.pairs);
    const std::size_t drawn = out.pairs.size();
    out.pairs.insert(out.pairs.end(), work.pairs->other.begin(), work.pairs->other.end());
    std::ranges::inplace_merge(out.pairs, out.pairs.begin() + static_cast<std::ptrdiff_t>(drawn));
    out.triangles = members_of(out.pairs, scene.triangles.size());
  } else if (work.patches.count > 0) {
    out.pairs =
        join_patches(scene, boxes, work.patches, out.triangles, out.bits, plan.options.neighbours);
    const std::vector<std::uint32_t> members = members_of(out.pairs, scene.triangles.size());
    std::vector<std::uint32_t> all;
    std::ranges::set_union(out.triangles, members, std::back_inserter(all));
    out.triangles = std::move(all);
  } else {
    out.pairs = pairs_of_some(scene, out.triangles, session.threads());
  }
  out.count = out.pairs.size();
  Stage stage = join_stage(work);
  stage.ms = join.ms();
  stage.in = left;
  stage.out = out.count;
  out.trace.push_back(stage);
  out.triangle_count = out.triangles.size();
  out.object_count = count_objects(scene, out.triangles);
  out.ms = watch.ms() - out.setup_ms;
  return out;
}

}  // namespace farcull
