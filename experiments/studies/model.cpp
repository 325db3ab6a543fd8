// The study "model" compares the misses of runs with the misses that the model of docs/misses.md
// predicts. In a run, the pixel grid has one position relative to the scene. The model averages
// over all positions. So each point is run at several random positions of the grid.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "experiments/method/miss_model.h"
#include "experiments/scenes/mesh/scene_build.h"
#include "experiments/studies/run_point.h"

namespace farcull {
namespace {

constexpr int kPositions = 4;
constexpr int kMostFarResolution = 256;  // px; above, FAR takes minutes and misses few pairs

// Returns the scene with two more objects, which move the pixel grid of each view by up to a pixel
// along both axes. Each new object is a tiny triangle. Windows are centred on the places where
// objects may meet, that is, where boxes of objects overlap. The boxes of the new objects overlap
// at most two pixels beyond the lower corner of all other such places.
Scene with_moved_grid(const Scene& scene, const Regions& regions, int resolution,
                      shapes::Random& random) {
  Box all = Box::empty();
  for (const Box& place : regions.places) all.add(place);
  const double pixel = (all.hi - all.lo).maxCoeff() / resolution;
  const Vec3 corner = all.lo - pixel * (Vec3::Ones() + random.in_cube(1));
  Scene out = scene;
  for (const double by : {0.0, 1e-3}) {
    const auto first = static_cast<std::uint32_t>(out.vertices.size());
    const Vec3 at = corner - Vec3::Constant(by * pixel);
    for (const Vec3& p : {Vec3(0, 0, 0), Vec3(2, 0, 2), Vec3(0, 2, 2)})
      out.vertices.emplace_back(at + 1e-3 * pixel * p);
    const auto triangle = static_cast<std::uint32_t>(out.triangles.size());
    out.triangles.push_back({first, first + 1, first + 2});
    out.source_face.push_back(0);
    out.objects.push_back({fmt::format("grid{}", by > 0), triangle, 1});
  }
  return out;
}

PointResult measure_model(const Point& point, MeasurementContext& lab) {
  const auto& of = std::get<RunPoint>(point);
  const Scene& scene = open_scene(of.scene, lab);
  const RunOptions options = options_of(of, lab);
  const TruePairs& truth = lab.truth();
  const Plan planned = plan(scene, options);
  const auto& work = std::get<DrawPlan>(planned.work);
  PointResult out{.device = "none", .left_out = "the images of too many triangles overlap"};
  const std::optional<MissPrediction> predicted = predict_misses(scene, work, options, truth.pairs);
  if (!predicted) return out;
  out.left_out = "";
  ForecastCounts counts{.colliding = truth.pairs.size(),
                        .positions = kPositions,
                        .expected = predicted->missed,
                        .low = predicted->low(),
                        .high = predicted->high(),
                        .triangles = scene.triangles.size(),
                        .scene_hash = scene_hash(scene)};
  shapes::Random random(1);
  for (int i = 0; i < kPositions; ++i) {
    const Scene moved = with_moved_grid(scene, work.regions, options.resolution, random);
    const Record record = run(moved, options, lab.session(), lab.progress());
    out.device = answered(record);
    const std::uint64_t missed = lacking(truth.pairs, record.collisions.all());
    counts.missed_in_all += missed;
    counts.missed_least = i == 0 ? missed : std::min(counts.missed_least, missed);
    counts.missed_most = std::max(counts.missed_most, missed);
    const auto count = static_cast<double>(missed);
    counts.outside += count < std::floor(counts.low) || count > std::ceil(counts.high);
  }
  out.counts = counts;
  return out;
}

std::vector<std::string> scenes_of(bool quick) {
  if (quick) return {"random-soup", "needles:60", "crowd:60", "two-spheres"};
  std::vector<std::string> out = {
      "slivers:100:30",  "slivers:200:1e3", "crowd:300:0.5", "field:8000",   "spheres:6000",
      "shells:8",        "two-tori",        "two-spheres",   "torii:720",    "cylinders:30",
      "tree-leaves:100", "cad-cut:2000",    "mixed:50:100",  "stack:16:0.01"};
  for (const char* drawn : {"random-soup", "needles:100", "crowd:200"}) {
    for (const std::string& scene : drawn_scenes(drawn, 3)) out.push_back(scene);
  }
  return out;
}

std::vector<Point> model_grid(const GridChoice& choice) {
  const std::vector<int> resolutions =
      choice.quick ? std::vector{64, 256} : std::vector{64, 128, 256, 512, 1024};
  std::vector<Point> out;
  for (const std::string& name : scenes_of(choice.quick)) {
    const NamedScene scene{name};
    for (const int resolution : resolutions) {
      const CullideForm all_views{.rounds = 1, .clear = ClearRule::all};
      for (const CullideForm& form : {CullideForm{}, kPublishedForm, all_views})
        out.emplace_back(cullide_point(scene, Method::cullide, resolution, form));
      out.emplace_back(cullide_point(scene, Method::quick_cullide, resolution));
      if (resolution > kMostFarResolution) continue;
      for (const char* offset : {"obb", "exact"}) {
        for (const double factor : {0.0, 0.3, 0.6})
          out.emplace_back(far_point(scene, offset, {.factor = factor}, resolution));
      }
    }
  }
  return out;
}

}  // namespace

Study model_study() {
  return {.name = "model",
          .title = "A model that predicts what CULLIDE misses",
          .question =
              "How many colliding pairs do the forms of CULLIDE miss, and FAR below its radius, "
              "beside what a model predicts from the triangles alone?",
          .grid = model_grid,
          .measure = measure_model,
          .campaign = true};
}

}  // namespace farcull
