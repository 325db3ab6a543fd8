// The study "scenes": the scenes of all other studies, and how large their triangles are in pixels.
#include <algorithm>
#include <cmath>
#include <set>
#include <variant>

#include "core/view/regions.h"
#include "core/view/view.h"
#include "experiments/studies/point.h"
#include "experiments/studies/run_point.h"
#include "experiments/studies/study.h"

namespace farcull {
namespace {

// The scene of a point; null where it is of the lemma experiment, whose points are no scene.
const PointScene* scene_of(const Point& point) {
  if (const auto* run = std::get_if<RunPoint>(&point)) return &run->scene;
  if (const auto* peer = std::get_if<PeerPoint>(&point)) return &peer->scene;
  return nullptr;
}

// Each scene once, of one that moves the middle one of its frames that are measured.
std::vector<Point> grid(const GridChoice& choice) {
  std::vector<std::pair<std::string, std::vector<RunPoint>>> scenes;
  for (const Study& study : studies_of_all()) {
    if (study.name == "scenes") continue;
    for (const Point& point : study.grid(choice)) {
      const PointScene* scene = scene_of(point);
      if (scene == nullptr) continue;
      RunPoint of = plain_point(*scene, Method::exact);
      const PointKey key = key_of(of);
      auto at = std::find_if(scenes.begin(), scenes.end(),
                             [&](const auto& known) { return known.first == key.scene; });
      if (at == scenes.end()) at = scenes.insert(at, {key.scene, {}});
      at->second.push_back(std::move(of));
    }
  }
  std::vector<Point> out;
  for (auto& [name, points] : scenes) {
    const auto frame = [](const RunPoint& point) { return key_of(point).frame; };
    std::ranges::sort(points, {}, frame);
    const auto same = std::ranges::unique(points, {}, frame);
    points.erase(same.begin(), same.end());
    out.emplace_back(points[points.size() / 2]);
  }
  return out;
}

// Pixels that triangles cover at kSceneResolution: the areas of their images in the views x, y and
// z, ascending. Only triangles that may take part count, those whose box meets another object's or
// whose object is tested against itself.
std::vector<double> covered_pixels(const Scene& scene) {
  std::vector<double> out;
  const Regions regions = find_regions(scene, {.self = true});
  if (regions.places.empty()) return out;
  for (const View& view : parse_views("x,y,z")) {
    const std::optional<Window> window = fit_window(view, regions.places, kSceneResolution);
    if (!window) continue;
    for (const std::uint32_t t : regions.triangles) {
      const std::array<Vec3, 3> corners = scene.corners(t);
      const Vec3 u = window->map * (corners[1] - corners[0]),
                 v = window->map * (corners[2] - corners[0]);
      out.push_back(0.5 * std::abs(u.x() * v.y() - u.y() * v.x()));
    }
  }
  std::sort(out.begin(), out.end());
  return out;
}

// By nearest rank.
double percentile(const std::vector<double>& sorted, double part) {
  const auto rank = static_cast<std::size_t>(std::ceil(part * static_cast<double>(sorted.size())));
  return sorted[std::max<std::size_t>(rank, 1) - 1];
}

PointResult measure(const Point& point, Lab& lab) {
  const Scene& scene = open_scene(std::get<RunPoint>(point).scene, lab);
  const std::size_t all = lab.truth().pairs.size();
  SceneCounts counts;
  counts.triangles = scene.triangles.size();
  counts.objects = scene.objects.size();
  for (const Object& object : scene.objects) counts.self_objects += object.self;
  counts.colliding = without_neighbours(scene, lab.truth()).pairs.size();
  counts.neighbours = all - counts.colliding;
  counts.scene_hash = scene_hash(scene);
  const std::vector<double> pixels = covered_pixels(scene);
  if (!pixels.empty()) {
    counts.pixels =
        PixelCounts{percentile(pixels, 0.1), percentile(pixels, 0.5), percentile(pixels, 0.9)};
  }
  return {.counts = counts, .times = {.exact = lab.truth().ms}, .device = "cpu"};
}

}  // namespace

Study scenes_study() {
  return {
      .name = "scenes",
      .title = "The scenes of the studies",
      .question = "Which scenes do the studies use, and how large are their triangles in pixels?",
      .grid = grid,
      .measure = measure};
}

}  // namespace farcull
