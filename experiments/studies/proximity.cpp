// The study "proximity" measures the size of potential neighbour sets, the number of nearest
// neighbours that a grid loses, and the errors and times of distances by libraries. The exact
// answers of all scenes are cached, since many points and several rounds use the same scene.
//
// Sud, Govindaraju, Gayle, Kabul and Manocha, Fast Proximity Computation Among Deformable Models
// using Discrete Voronoi Diagrams, SIGGRAPH 2006.
#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <stdexcept>

#include "core/base/error.h"
#include "core/base/stopwatch.h"
#include "experiments/method/distances.h"
#include "experiments/studies/run_point.h"

namespace farcull {
namespace {

constexpr unsigned kThreads = 1;

// A scene and its exact answers. Distances within an object are not measured.
struct Exact {
  Scene scene;
  std::string hash;
  std::vector<PeerDistance> distances;  // the exact answers to the task
  std::uint64_t accounted = 0;          // pairs of triangles that the accounting decided
  std::vector<NearestObjects> nearest;  // only for the task `nearest`
};

constexpr const char* kReport = "this is a fault of farcull: please report it with the scene";

// Throws Error unless `distances` and `nearest` agree. If several objects are equally near,
// `distances` names one of them.
void require_alike(const std::string& where, const Exact& exact) {
  for (const PeerDistance& one : exact.distances) {
    if (std::ranges::count(exact.nearest[one.a].objects, one.b) > 0) continue;
    throw Error(where, fmt::format("two searches name different nearest objects of {}", one.a),
                kReport);
  }
}

const Exact& exact_of(const PointScene& wanted, DistanceTask task, const std::string& where,
                      MeasurementContext& lab) {
  static std::map<std::pair<std::string, DistanceTask>, Exact> known;
  Scene scene = open_scene(wanted, lab);
  for (Object& object : scene.objects) object.self = false;
  std::string hash = scene_hash(scene);
  if (const auto at = known.find({hash, task}); at != known.end()) return at->second;
  Exact now{.scene = std::move(scene), .hash = hash, .distances = {}, .nearest = {}};
  const bool nearest = task == DistanceTask::nearest;
  const DistanceRecord record =
      distances(now.scene,
                {.pairs = nearest ? DistancePairs::nearest : DistancePairs::objects,
                 .inside = false,
                 .verify = true},
                lab.progress());
  if (const DistanceAccounting& all = *record.verification; !all.holds()) {
    throw Error(
        where,
        fmt::format("the exact answers are wrong: {} pairs are nearer, {} distances are off",
                    all.nearer, all.wrong),
        kReport);
  }
  now.distances = as_peer(record);
  now.accounted = record.verification->pairs_total;
  if (nearest) {
    now.nearest = nearest_objects(now.scene, lab.progress());
    require_alike(where, now);
  }
  return known.emplace(std::pair(std::move(hash), task), std::move(now)).first->second;
}

using enum NeighbourMethod;

constexpr int kCellsInMotion = 256;    // resolution in cells, for scenes that move
constexpr int kCountResolution = 128;  // resolution in cells, for times against object counts
constexpr int kMostInDiagrams = 400;   // most objects in a scene for which diagrams are computed
constexpr int kRuns = 3 * kRounds;     // nine runs in all, as in the study "scaling"
constexpr int kSeeds = 3;              // seeds of each scene of clusters

// Adds points for both kinds of Voronoi diagram at each resolution, and for the methods without
// cells. unwidened: true to add the reliable diagram with widening 0, which may lose objects.
void add_sets(const PointScene& scene, bool quick, bool unwidened, std::vector<Point>& out) {
  for (const NeighbourMethod method : {boxes, trees})
    out.emplace_back(NeighbourPoint{scene, method});
  for (const int cells : quick ? std::vector{64, 128, 256} : std::vector{64, 128, 256, 512, 1024}) {
    out.emplace_back(NeighbourPoint{scene, voronoi, cells});
    out.emplace_back(NeighbourPoint{scene, voronoi_reliable, cells});
    if (unwidened) out.emplace_back(NeighbourPoint{scene, voronoi_reliable, cells, 0});
  }
}

void add_distances(const PointScene& scene, DistanceTask task, std::vector<Point>& out) {
  for (const DistancePeer& contestant : distance_contestants())
    out.emplace_back(DistancePoint{
        .scene = scene, .contestant = contestant.name, .task = task, .repeat = kRuns});
}

struct RestCase {
  const char* scene;
  DistanceTask task = DistanceTask::nearest;  // the question for libraries
};

// Adds scenes in which not all objects meet.
void add_scenes_at_rest(bool quick, std::vector<Point>& out) {
  using enum DistanceTask;
  static const std::vector<RestCase> full = {{"crowd"},       {"cylinders", objects},
                                             {"field"},       {"tree-leaves"},
                                             {"ground@tiny"}, {"bunnies-far-apart", objects}};
  static const std::vector<RestCase> few = {{"field:2000"}, {"cylinders:12", objects}};
  for (const RestCase& c : quick ? few : full) {
    add_sets(NamedScene{c.scene}, quick, false, out);
    add_distances(NamedScene{c.scene}, c.task, out);
  }
  // Far from the origin, double coordinates are coarser, so distances between objects are less
  // accurate.
  for (const char* scene : {"crowd:60@far", "cylinders:12@far"})
    add_distances(NamedScene{scene}, nearest, out);
}

void add_clusters(const GridChoice& choice, std::vector<Point>& out) {
  for (const int ratio : choice.quick ? std::vector{64} : std::vector{16, 64, 256}) {
    for (int i = 0; i < (choice.quick ? 1 : kSeeds); ++i) {
      const auto seed = choice.seed + static_cast<std::uint64_t>(i);
      add_sets(ClusteredScene{ratio, seed}, choice.quick, true, out);
    }
  }
}

void add_motion(bool quick, std::vector<Point>& out) {
  static const std::vector<std::string> full = {"crowd:100", "cylinders:30", "field:4000",
                                                "tree-leaves:60"};
  static const std::vector<std::string> few = {"crowd:30", "cylinders:8"};
  // With fewer than six frames, the range of the measured values would contain their median with
  // less than 95 % probability.
  const long frames = quick ? 6 : 12;
  for (const std::string& name : quick ? few : full) {
    for (long frame = 0; frame < frames; ++frame) {
      const MotionFrame scene{name, frame, frames};
      for (const NeighbourMethod method : {boxes, trees, voronoi, voronoi_reliable})
        out.emplace_back(NeighbourPoint{scene, method, has_cells(method) ? kCellsInMotion : 0});
    }
  }
}

// Adds scenes of objects of about the same size, in a box that grows with the number of objects.
void add_counts(bool quick, std::vector<Point>& out) {
  for (const int n : quick ? std::vector{10, 20, 40, 80, 160, 320}
                           : std::vector{25, 50, 100, 200, 400, 800, 1600, 3200}) {
    const NamedScene scene{fmt::format("crowd:{}", n)};
    for (const NeighbourMethod method : {boxes, trees, voronoi, voronoi_reliable}) {
      // For more objects than this, each diagram takes seconds.
      if (has_cells(method) && n > kMostInDiagrams) continue;
      out.emplace_back(NeighbourPoint{.scene = scene,
                                      .method = method,
                                      .resolution = has_cells(method) ? kCountResolution : 0,
                                      .repeat = kRuns});
    }
    add_distances(scene, DistanceTask::nearest, out);
  }
}

}  // namespace

PointResult measure_neighbours(const NeighbourPoint& point, MeasurementContext& lab) {
  const Exact& exact = exact_of(point.scene, DistanceTask::nearest, describe(Point(point)), lab);
  const Stopwatch watch;
  NeighbourSets sets = neighbour_sets(exact.scene,
                                      {.method = point.method,
                                       .resolution = point.resolution,
                                       .widening = point.widening,
                                       .threads = kThreads},
                                      lab.progress());
  const double ms = watch.ms();
  if (!sets.left_out.empty()) return {.device = "none", .left_out = std::move(sets.left_out)};
  SetCounts counts;
  counts.sizes = sizes_of(exact.scene, sets, exact.nearest);
  counts.triangles = exact.scene.triangles.size();
  counts.objects = exact.scene.objects.size();
  counts.accounted = exact.accounted;
  counts.promises = point.method != NeighbourMethod::voronoi && point.widening >= 1;
  counts.scene_hash = exact.hash;
  return {.counts = counts, .times = {.total = ms}, .device = "cpu"};
}

PointResult measure_distances(const DistancePoint& point, const DistancePeer& contestant,
                              MeasurementContext& lab) {
  PointResult none{.device = "none", .left_out = contestant.missing};
  if (!none.left_out.empty()) return none;
  const Exact& exact = exact_of(point.scene, point.task, describe(Point(point)), lab);
  none.left_out = why_left_out(contestant, exact.scene);
  if (!none.left_out.empty()) return none;
  const PeerQuestion question{.task = point.task};
  if (lab.progress()) lab.progress()(contestant.name);
  const Stopwatch watch;
  const PeerDistances answer = contestant.run(exact.scene, question, kThreads);
  const double ms = watch.ms();
  const DistanceErrors errors = errors_of(point.task, answer.distances, exact.distances);
  const std::uint64_t asked = exact.distances.size();
  DistanceCounts counts{.asked = asked,
                        .errors = errors,
                        .triangles = exact.scene.triangles.size(),
                        .objects = exact.scene.objects.size(),
                        .accounted = exact.accounted,
                        .wrong = asked - errors.exact + errors.beyond,
                        .promises = contestant.name == farcull_distances().name,
                        .library = contestant.library,
                        .scene_hash = exact.hash};
  return {.counts = std::move(counts), .times = {.total = ms}, .device = "cpu"};
}

std::vector<DistancePeer> distance_contestants() {
  std::vector<DistancePeer> out = {farcull_distances()};
  for (DistancePeer& peer : distance_peers()) out.push_back(std::move(peer));
  return out;
}

PointResult measure_distances(const DistancePoint& point, MeasurementContext& lab) {
  for (const DistancePeer& contestant : distance_contestants()) {
    if (contestant.name == point.contestant) return measure_distances(point, contestant, lab);
  }
  throw std::logic_error("measure_distances: no contestant " + point.contestant);
}

std::string library_of_distances(const Point& point) {
  const auto* asked = std::get_if<DistancePoint>(&point);
  if (asked == nullptr) return "";
  for (const DistancePeer& contestant : distance_contestants()) {
    if (contestant.name == asked->contestant)
      return contestant.missing.empty() ? contestant.library : "";
  }
  return "";
}

Study proximity_study() {
  const auto grid = [](const GridChoice& choice) {
    std::vector<Point> out;
    add_scenes_at_rest(choice.quick, out);
    add_clusters(choice, out);
    add_motion(choice.quick, out);
    add_counts(choice.quick, out);
    return out;
  };
  const auto measure = [](const Point& point, MeasurementContext& lab) {
    if (const auto* of = std::get_if<NeighbourPoint>(&point)) return measure_neighbours(*of, lab);
    return measure_distances(std::get<DistancePoint>(point), lab);
  };
  return {.name = "proximity",
          .title = "Potential neighbours and distances",
          .question =
              "How many objects and triangles may hold the nearest neighbour of an object, how "
              "many nearest neighbours does a grid lose at which resolution, and how far are the "
              "distances of libraries off, in which time?",
          .grid = grid,
          .measure = measure,
          .library = library_of_distances,
          .campaign = true};
}

}  // namespace farcull
