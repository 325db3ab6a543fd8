// Four studies. "scenes" lists the scenes of all other studies and the sizes of their triangles in
// pixels. "culling" counts the candidate pairs of several methods. "efficiency" counts the
// candidate pairs of methods in each frame of moving scenes. "scaling" measures how the run time of
// methods grows.
// Papers: "efficiency" compares FAR with I-COLLIDE (Govindaraju, Lin and Manocha, TVCG 2006,
// section 6) and Quick-CULLIDE with CULLIDE (IEEE VR 2005). "scaling" has the plots of CULLIDE
// (Graphics Hardware 2003).
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "experiments/studies/run_point.h"

namespace farcull {
namespace {

using enum Method;

// Returns the scene of a RunPoint or PeerPoint, and null for other points.
const PointScene* scene_of(const Point& point) {
  if (const auto* run = std::get_if<RunPoint>(&point)) return &run->scene;
  if (const auto* peer = std::get_if<PeerPoint>(&point)) return &peer->scene;
  return nullptr;
}

// Lists each scene once. For a moving scene, lists the middle frame of all its measured frames.
std::vector<Point> scenes_grid(const GridChoice& choice) {
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

// Returns the areas of triangle images in pixels, in ascending order, for the views x, y and z at
// kSceneResolution. Includes only triangles that may collide: the triangle's box overlaps the box
// of another object, or the triangle's object is tested against itself.
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

// Returns the percentile `part` (0 to 1) of the sorted values, by the nearest-rank method.
double percentile(const std::vector<double>& sorted, double part) {
  const auto rank = static_cast<std::size_t>(std::ceil(part * static_cast<double>(sorted.size())));
  return sorted[std::max<std::size_t>(rank, 1) - 1];
}

PointResult measure_scene(const Point& point, MeasurementContext& lab) {
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

constexpr const char* kBoxes = "cgal-boxes";  // finds pairs of triangles whose boxes overlap
constexpr const char* kOriented = "fcl-obb";  // finds tree leaves whose oriented boxes overlap

std::vector<PointScene> culled_scenes(bool quick) {
  std::vector<const char*> names = {"two-bunnies",     "armadillo-elephant", "dragon-bunny",
                                    "mannequin-devil", "two-tori",           "crowd:400",
                                    "spheres:20000",   "needles:400",        "needles-crossed",
                                    "random-soup",     "cad-cut:8000",       "crumpled:20000"};
  if (quick) {
    names = {"two-bunnies", "two-spheres", "crowd:60",     "needles:60",
             "random-soup", "slivers:100", "crumpled:2000"};
  }
  std::vector<PointScene> out;
  for (const char* name : names) out.push_back(NamedScene{name});
  out.push_back(quick ? MotionFrame{"cloth:450", 40, 100} : MotionFrame{"cloth:800", 80, 100});
  return out;
}

std::vector<Point> culling_grid(const GridChoice& choice) {
  std::vector<Point> out;
  for (const PointScene& scene : culled_scenes(choice.quick)) {
    out.emplace_back(PeerPoint{scene, kBoxes});
    out.emplace_back(PeerPoint{scene, kOriented});
    out.emplace_back(plain_point(scene, Method::boxes));
  }
  return out;
}

// Also counts the neighbours: triangles of one object that share a vertex. The libraries skip them,
// but `boxes` passes pairs of neighbours to the exact predicates.
PointResult measure_culling(const Point& point, MeasurementContext& lab) {
  if (const auto* peer = std::get_if<PeerPoint>(&point)) return measure_peer(*peer, lab, 1);
  Record record;
  PointResult out = measure_run(std::get<RunPoint>(point), lab, &record);
  std::get<RunCounts>(out.counts).neighbours =
      NeighbourCounts{record.collisions.neighbours, record.collisions.neighbour_pairs.size()};
  return out;
}

struct MovingCase {
  const char* scene;
  bool self = false;  // true: each object is also tested against itself; few methods can do so
};

// Returns moving scenes that are small enough for rendering in software. quick: only three scenes.
const std::vector<MovingCase>& moving_cases(bool quick) {
  static const std::vector<MovingCase> full = {
      {"two-spheres"},     {"needles:60"},  {"crowd:60"},           {"field:4000"},
      {"cylinders:30"},    {"torii:800"},   {"tree-leaves:60"},     {"shells:6"},
      {"cloth:800", true}, {"two-bunnies"}, {"bunny-dragon:19994"}, {"breaking-dragon:19994"}};
  static const std::vector<MovingCase> few = {{"crowd:30"}, {"cylinders:12"}, {"tree-leaves:20"}};
  return quick ? few : full;
}

constexpr int kFrameResolution = 256;

void add_methods(std::vector<Point>& out, const MovingCase& moving, const MotionFrame& frame) {
  out.push_back(plain_point(frame, i_collide));
  if (!moving.self) {
    for (const char* offset : {"obb", "exact"})
      out.push_back(far_point(frame, offset, kBudgetRadius, kFrameResolution));
    for (const Method method : {cullide, quick_cullide})
      out.push_back(cullide_point(frame, method, kFrameResolution));
  }
  out.push_back(plain_point(frame, boxes));
}

// A scene of a plot. If several plots use a scene, the study measures the scene once.
struct Case {
  std::string scene;
  int resolution;  // px, for the methods that render
  bool drawn;      // true: also run the methods that render; they are slow in software
};

std::vector<Case> cases(bool quick) {
  constexpr int kUsual = 256;
  std::vector<Case> out;
  const auto add = [&out](std::string scene, int resolution, bool drawn) {
    out.push_back({std::move(scene), resolution, drawn});
  };
  // Each plot has at least six sizes, so that a fitted exponent has a confidence interval.
  // First plot: time against the number of objects. All objects have about the same size. The box
  // that contains the objects grows with their number.
  for (const int n :
       quick ? std::vector{5, 10, 20, 40, 80, 160} : std::vector{25, 50, 100, 200, 400, 800}) {
    add(fmt::format("crowd:{}", n), kUsual, true);
  }
  if (!quick) {
    for (const int n : {1600, 3200, 6400}) add(fmt::format("crowd:{}", n), kUsual, false);
  }
  // Second plot: time against density (objects per unit of volume).
  const int objects = quick ? 20 : 100;
  for (const double density : {0.05, 0.1, 0.2, 0.4, 0.8, 1.6}) {
    add(fmt::format("crowd:{}:{}", objects, density), kUsual, true);
  }
  // Third plot: time against the number of triangles. Each scene consists of six tori.
  for (const int n :
       quick ? std::vector{72, 128, 200, 320, 500, 800} : std::vector{72, 200, 400, 800, 1600}) {
    add(fmt::format("torii:{}", n), kUsual, true);
  }
  if (!quick) {
    for (const int n : {5000, 20000, 80000}) add(fmt::format("torii:{}", n), kUsual, n <= 5000);
  }
  // Fourth plot: time against resolution.
  for (const int pixels : quick ? std::vector{32, 64, 128, 256, 512, 1024}
                                : std::vector{64, 128, 256, 512, 1024, 2048}) {
    add("two-spheres", pixels, true);
  }
  return out;
}

// The range of nine runs contains the median of another nine runs with a probability above 95 %.
// The range of fewer runs does so less often (docs/experiments.md, "Statistics").
constexpr int kRepeat = 3 * kRounds;

std::vector<RunPoint> points_of(const Case& c) {
  const NamedScene scene{c.scene};
  std::vector<RunPoint> out;
  if (c.drawn) {
    out = {far_point(scene, "obb", kBudgetRadius, c.resolution),
           cullide_point(scene, cullide, c.resolution)};
  }
  for (const Method method : {boxes, i_collide, exact}) out.push_back(plain_point(scene, method));
  for (RunPoint& point : out) point.repeat = kRepeat;
  return out;
}

}  // namespace

Study culling_study() {
  return {.name = "culling",
          .title = "What boxes cull",
          .question =
              "How many pairs do boxes of triangles, oriented boxes, and the method boxes leave to "
              "exact predicates, for each pair that collides?",
          .grid = culling_grid,
          .measure = measure_culling,
          .library = library_of_peer};
}

Study efficiency_study() {
  const auto grid = [](const GridChoice& choice) {
    std::vector<Point> out;
    // The range of n independent values contains the true median with probability 1 - 2^(1 - n).
    // This is at least 95 % only if n is 6 or more.
    const long frames = choice.quick ? 6 : 12;
    for (const MovingCase& moving : moving_cases(choice.quick)) {
      for (long frame = 0; frame < frames; ++frame)
        add_methods(out, moving, {moving.scene, frame, frames});
    }
    return out;
  };
  return {.name = "efficiency",
          .title = "Culling efficiency in motion",
          .question =
              "How much smaller than what I-COLLIDE leaves is what FAR leaves to exact tests, and "
              "how much does Quick-CULLIDE draw and ask less than CULLIDE, frame by frame over "
              "scenes that move?",
          .grid = grid,
          .measure = measure_run_point};
}

Study scaling_study() {
  const auto grid = [](const GridChoice& choice) {
    std::vector<Point> out;
    std::set<PointKey> had;
    for (const Case& c : cases(choice.quick)) {
      for (RunPoint& point : points_of(c)) {
        if (had.insert(key_of(point)).second) out.push_back(std::move(point));
      }
    }
    return out;
  };
  return {.name = "scaling",
          .title = "Time against size",
          .question =
              "How does the time from triangles to exact pairs grow with the number of objects, of "
              "triangles, of pixels, with density, and with the pairs that collide?",
          .grid = grid,
          .measure = measure_run_point,
          .plain = true};
}

Study scenes_study() {
  return {
      .name = "scenes",
      .title = "The scenes of the studies",
      .question = "Which scenes do the studies use, and how large are their triangles in pixels?",
      .grid = scenes_grid,
      .measure = measure_scene};
}

}  // namespace farcull
