#include "experiments/run.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>

#include "core/box_join.h"
#include "core/error.h"
#include "core/plan.h"
#include "experiments/run_pairs.h"
#include "offsets/exact.h"
#include "offsets/obb.h"
#include "verify/exact.h"

namespace farcull {
namespace {

constexpr int kUsualResolution = 512;
constexpr const char* kUsualViews = "x,y,z";

Fattener fattener_of(const RunOptions& options) {
  if (options.method == Method::cullide) return raw_triangles();
  if (options.offset == "exact") return exact_fattener();
  return depth_of(options) == DepthMode::fragment ? obb_fattener() : obb_surface_fattener();
}

// Culls on a canvas of its own, or says in the record why nothing had to be drawn.
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
  if (progress) progress("opening the device");
  const Stopwatch setup;
  const GlContext& context = session.context();
  const Fattener fattener = fattener_of(options);
  GlCanvas canvas(context, fattener.mode, fattener.solid,
                  {.depth_format = options.depth_format, .query = query_of(options)});
  record.device = context.info();
  record.depth_bits = canvas.limits().depth_bits;
  record.ms.setup = setup.ms();
  record.stages.push_back({.name = "setup",
                           .ran = true,
                           .reason = "context and shaders",
                           .ms = record.ms.setup,
                           .unit = ""});

  CullSettings settings{.views = parse_views(views_of(options)),
                        .resolution = resolution_of(options),
                        .fattener = fattener,
                        .radius = options.radius,
                        .quick = options.method == Method::far};
  CullResult result = cull(scene, plan, settings, canvas, progress);
  record.views = std::move(result.views);
  record.stages.insert(record.stages.end(), result.stages.begin(), result.stages.end());
  return std::move(result.live);
}

void run_culled(const Scene& scene, Session& session, const Progress& progress, RunRecord& record) {
  std::vector<TrianglePair>& candidates = record.kept;
  const Stopwatch planning;
  if (progress) progress("planning");
  const Plan plan = make_plan(scene);
  record.stages.push_back(
      {.name = "boxes",
       .ran = true,
       .reason = plan.regions.size() == 1
                     ? "1 pair of objects' boxes overlaps"
                     : fmt::format("{} pairs of objects' boxes overlap", plan.regions.size()),
       .ms = planning.ms(),
       .in = scene.triangles.size(),
       .out = plan.triangles.size(),
       .unit = "triangles"});
  const std::vector<std::uint32_t> live = cull_stage(scene, plan, session, progress, record);
  record.pcs_triangles = live.size();
  record.pcs_objects = count_objects(scene, live);

  const Stopwatch join;
  if (progress) progress("joining boxes");
  candidates = box_join(plan.triangle_boxes, owners(scene), live);
  record.candidate_pairs = candidates.size();
  record.stages.push_back({.name = "join",
                           .ran = true,
                           .reason = "boxes of what is kept",
                           .ms = join.ms(),
                           .in = live.size(),
                           .out = candidates.size(),
                           .unit = "pairs"});
  record.ms.cull = planning.ms() - record.ms.setup;

  const Stopwatch exact;
  if (progress) progress("exact tests");
  record.pairs = decide(scene, candidates).pairs;
  record.ms.exact = exact.ms();
  record.stages.push_back({.name = "exact",
                           .ran = true,
                           .reason = "exact predicates on the candidates",
                           .ms = record.ms.exact,
                           .in = candidates.size(),
                           .out = record.pairs.size(),
                           .unit = "pairs"});
}

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

}  // namespace

std::string to_string(Method method) {
  switch (method) {
    case Method::far:
      return "far";
    case Method::cullide:
      return "cullide";
    case Method::far_pairs:
      return "far-pairs";
    case Method::exact:
      return "exact";
  }
  return "";
}

Method parse_method(const std::string& name, const std::string& option) {
  for (const Method method : {Method::far, Method::cullide, Method::far_pairs, Method::exact}) {
    if (name == to_string(method)) return method;
  }
  throw Error(option, "'" + name + "' is no method", "give far, cullide, far-pairs or exact");
}

int parse_resolution(const std::string& text, const std::string& option) {
  int value = 0;
  const auto [end, code] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (code != std::errc() || end != text.data() + text.size() || value < 1) {
    throw Error(option, "'" + text + "' is no resolution",
                "give a whole number of pixels from 1, such as 512");
  }
  return value;
}

RadiusRule parse_radius(const std::string& text) {
  if (text == "published") return {.published = true, .factor = 1};
  if (text == "budget") return {};
  double factor = 0;
  const auto [end, code] = std::from_chars(text.data(), text.data() + text.size(), factor);
  if (code != std::errc() || end != text.data() + text.size() || !std::isfinite(factor) ||
      factor < 0 || factor > 1e5) {
    throw Error(
        "--radius", "'" + text + "' is no radius",
        "give budget, published, or a factor of 0 to 100000 on the budget radius, such as 0.9");
  }
  return {.published = false, .factor = factor};
}

void require_pair_resolution(int resolution, const std::string& option) {
  if (resolution <= kMostPairResolution) return;
  throw Error(
      option,
      fmt::format("{} is outside 1 .. {}, the limit of far-pairs", resolution, kMostPairResolution),
      "give a number in that range, or auto");
}

int resolution_of(const RunOptions& options) {
  if (options.resolution > 0 || options.method == Method::far_pairs) return options.resolution;
  return kUsualResolution;
}

std::string views_of(const RunOptions& options) {
  if (!options.views.empty() || options.method == Method::far_pairs) return options.views;
  return kUsualViews;
}

DepthMode depth_of(const RunOptions& options) {
  return options.depth.value_or(options.method == Method::far ? DepthMode::fragment
                                                              : DepthMode::fixed);
}

QueryMode query_of(const RunOptions& options) {
  return options.query.value_or(
      options.depth_format == DepthFormat::float32 ? QueryMode::flags : QueryMode::occlusion);
}

std::string describe(const RunOptions& options) {
  if (options.method == Method::exact) return "exact";
  const int resolution = resolution_of(options);
  if (resolution == 0) return to_string(options.method);
  return fmt::format("{} at {} px", to_string(options.method), resolution);
}

void validate(const RunOptions& options) {
  if (options.resolution < 0) {
    throw Error("--resolution", fmt::format("{} is no resolution", options.resolution),
                "give 1 px or more");
  }
  const bool pairs = options.method == Method::far_pairs;
  if (pairs) require_pair_resolution(options.resolution);
  if (!(options.clearance >= 0) || !std::isfinite(options.clearance)) {
    throw Error("--clearance", fmt::format("{} is no distance", options.clearance),
                "give a finite distance in world units, 0 or more");
  }
  if (options.clearance > 0 && !pairs && options.method != Method::exact) {
    throw Error("--clearance", to_string(options.method) + " finds what meets, not what is near",
                "use --method far-pairs or exact");
  }
  if (options.offset != "obb" && options.offset != "exact") {
    throw Error("--offset", "'" + options.offset + "' is no offset", "give obb or exact");
  }
  if (options.offset == "exact" && options.depth == DepthMode::fixed) {
    throw Error("--offset",
                "exact offsets are evaluated by the fragment program, not drawn as surfaces",
                "use --depth fragment, or --offset obb");
  }
  if (options.method == Method::cullide && options.depth == DepthMode::fragment) {
    throw Error("--depth", "cullide draws the triangles themselves, by fixed function",
                "leave --depth out, or use --method far");
  }
  if (options.query == QueryMode::flags && options.depth_format == DepthFormat::fixed24) {
    throw Error("--query",
                "flags cannot be used with a 24-bit depth buffer: a comparison in the shader loses "
                "equal depths",
                "use --query occlusion or --depth-format 32f");
  }
  // Whether there is such a device is seen when one is needed; what can be none is refused at once.
  const std::string& device = options.device;
  if (device == "cpu" && (options.method == Method::far || options.method == Method::cullide)) {
    throw Error("--device", to_string(options.method) + " draws with OpenGL, not on the cpu",
                "give software, or use --method far-pairs");
  }
  if (device != "" && device != "cpu" && device != "hardware" && device != "software" &&
      device.find_first_not_of("0123456789") != std::string::npos) {
    throw Error("--device", "'" + device + "' is no device",
                "give cpu (far-pairs), software, hardware or a number that `farcull doctor` lists");
  }
  if (!options.views.empty()) parse_views(options.views);
}

const GlContext& Session::context() {
  if (!context_) context_ = std::make_unique<GlContext>(device_);
  return *context_;
}

PairDevice& Session::pairs() {
  if (!pairs_)
    pairs_ = open_pair_device(device_, 0, [this]() -> const GlContext& { return context(); });
  return *pairs_;
}

bool has_self(const Scene& scene) {
  return std::any_of(scene.objects.begin(), scene.objects.end(),
                     [](const Object& object) { return object.self; });
}

RunRecord run_scene(const Scene& scene, const RunOptions& options, Session& session,
                    const Progress& progress) {
  validate(options);
  if (has_self(scene) && (options.method == Method::far || options.method == Method::cullide)) {
    throw Error(
        scene.name,
        to_string(options.method) + " tests no object against itself, as one of it has to be",
        "use --method far-pairs or exact");
  }
  RunRecord record;
  record.options = options;
  record.promises = options.method == Method::far_pairs ||
                    (options.method == Method::far && depth_of(options) == DepthMode::fragment &&
                     !options.radius.published && options.radius.factor >= 1);
  record.scene_hash = scene_hash(scene);
  record.degenerate_triangles = degenerate_triangles(scene);

  if (options.method == Method::exact) {
    run_exact(scene, progress, record);
  } else if (options.method == Method::far_pairs) {
    run_far_pairs(scene, session, progress, record);
  } else {
    run_culled(scene, session, progress, record);
  }
  record.ms.total = record.ms.setup + record.ms.cull + record.ms.exact;
  if (options.verify) {
    if (progress) progress("accounting for every pair");
    record.verification = account(scene, record.kept, {.clearance = options.clearance});
    if (!record.verification->adds_up())
      throw std::logic_error("the classes of the accounting do not add up");
  }
  record.stages.push_back(
      {.name = "verify",
       .ran = options.verify,
       .reason = options.verify ? "every pair; out: those that were missed" : "--no-verify",
       .ms = options.verify ? record.verification->ms : 0,
       .in = options.verify ? record.verification->pairs_total : 0,
       .out = options.verify ? record.verification->false_negatives : 0,
       .unit = "pairs"});
  return record;
}

bool broken(const RunRecord& record, bool strict) {
  return (strict || record.promises) && record.verification &&
         record.verification->false_negatives > 0;
}

}  // namespace farcull
