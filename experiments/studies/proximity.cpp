// How large potential neighbour sets are, what a grid loses of them, and how far the distances of
// libraries are off, against time.
//
// Sud, Govindaraju, Gayle, Kabul and Manocha, Fast Proximity Computation Among Deformable Models
// using Discrete Voronoi Diagrams, SIGGRAPH 2006.
#include <fmt/format.h>

#include <string>
#include <utility>
#include <vector>

#include "experiments/studies/points.h"
#include "experiments/studies/proximity_point.h"
#include "experiments/studies/study.h"

namespace farcull {
namespace {

using enum NeighbourMethod;

std::vector<int> resolutions(bool quick) {
  return quick ? std::vector{64, 128, 256} : std::vector{64, 128, 256, 512, 1024};
}
constexpr int kFrameResolution = 256;  // cells, of scenes that move
constexpr int kCountResolution = 128;  // cells, of times against the number of objects
constexpr int kMostInDiagrams = 400;   // objects there
constexpr int kRepeat = 9;             // as in the study "scaling"
constexpr int kSeeds = 3;              // of clusters

// Both diagrams at each resolution, beside the methods without cells.
void add_sets(const PointScene& scene, bool quick, bool unwidened, std::vector<Point>& out) {
  for (const NeighbourMethod method : {boxes, trees})
    out.emplace_back(NeighbourPoint{.scene = scene, .method = method});
  for (const int cells : resolutions(quick)) {
    out.emplace_back(NeighbourPoint{.scene = scene, .method = voronoi, .resolution = cells});
    out.emplace_back(
        NeighbourPoint{.scene = scene, .method = voronoi_reliable, .resolution = cells});
    if (unwidened)
      out.emplace_back(NeighbourPoint{
          .scene = scene, .method = voronoi_reliable, .resolution = cells, .widening = 0});
  }
}

void add_distances(const PointScene& scene, DistanceTask task, std::vector<Point>& out) {
  for (const DistancePeer& contestant : distance_contestants())
    out.emplace_back(DistancePoint{
        .scene = scene, .contestant = contestant.name, .task = task, .repeat = kRepeat});
}

struct RestCase {
  const char* scene;
  DistanceTask task = DistanceTask::nearest;  // that libraries are asked
};

// Scenes in which not all objects meet.
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
  // Far from the origin doubles have fewer digits left for what is between objects.
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
  // Six frames at least, as in the study "efficiency".
  const long frames = quick ? 6 : 12;
  for (const std::string& name : quick ? few : full) {
    for (long frame = 0; frame < frames; ++frame) {
      const MotionFrame scene{name, frame, frames};
      for (const NeighbourMethod method : {boxes, trees, voronoi, voronoi_reliable}) {
        out.emplace_back(NeighbourPoint{.scene = scene,
                                        .method = method,
                                        .resolution = has_cells(method) ? kFrameResolution : 0});
      }
    }
  }
}

// Objects of about the same size, in a box that grows with their number.
void add_counts(bool quick, std::vector<Point>& out) {
  for (const int n : quick ? std::vector{10, 20, 40, 80, 160, 320}
                           : std::vector{25, 50, 100, 200, 400, 800, 1600, 3200}) {
    const NamedScene scene{fmt::format("crowd:{}", n)};
    for (const NeighbourMethod method : {boxes, trees, voronoi, voronoi_reliable}) {
      // The diagrams take seconds each beyond this.
      if (has_cells(method) && n > kMostInDiagrams) continue;
      out.emplace_back(NeighbourPoint{.scene = scene,
                                      .method = method,
                                      .resolution = has_cells(method) ? kCountResolution : 0,
                                      .repeat = kRepeat});
    }
    add_distances(scene, DistanceTask::nearest, out);
  }
}

}  // namespace

Study proximity_study() {
  Study study;
  study.name = "proximity";
  study.title = "Potential neighbours and distances";
  study.question =
      "How many objects and triangles may hold the nearest neighbour of an object, how many "
      "nearest "
      "neighbours does a grid lose at which resolution, and how far are the distances of libraries "
      "off, in which time?";
  study.grid = [](const GridChoice& choice) {
    std::vector<Point> out;
    add_scenes_at_rest(choice.quick, out);
    add_clusters(choice, out);
    add_motion(choice.quick, out);
    add_counts(choice.quick, out);
    return out;
  };
  study.measure = [](const Point& point, Lab& lab) {
    if (const auto* of = std::get_if<NeighbourPoint>(&point)) return measure_neighbours(*of, lab);
    return measure_distances(std::get<DistancePoint>(point), lab);
  };
  study.library = library_of_distances;
  study.campaign = true;
  return study;
}

}  // namespace farcull
