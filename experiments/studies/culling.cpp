// The study "culling": how many pairs boxes, oriented boxes and far-pairs leave to exact
// predicates, for each pair that collides.
#include <fmt/format.h>

#include <variant>

#include "experiments/studies/points.h"
#include "experiments/studies/run_point.h"
#include "experiments/studies/study.h"

namespace farcull {
namespace {

constexpr const char* kBoxes = "cgal-boxes";  // triangles whose boxes meet
constexpr const char* kOriented = "fcl-obb";  // leaves of FCL's trees whose oriented boxes meet

// Scans and models, smooth bodies, thin triangles, cloth.
std::vector<PointScene> scenes(bool quick) {
  if (quick) {
    return {
        NamedScene{"two-bunnies"}, NamedScene{"two-spheres"},   NamedScene{"crowd:60"},
        NamedScene{"needles:60"},  NamedScene{"random-soup"},   NamedScene{"slivers:100"},
        NamedScene{"fans:2000"},   NamedScene{"crumpled:2000"}, MotionFrame{"cloth:450", 40, 100}};
  }
  return {NamedScene{"two-bunnies"},        NamedScene{"armadillo-elephant"},
          NamedScene{"dragon-bunny"},       NamedScene{"mannequin-devil"},
          NamedScene{"two-tori"},           NamedScene{"crowd:400"},
          NamedScene{"spheres:20000"},      NamedScene{"needles:400"},
          NamedScene{"needles-crossed"},    NamedScene{"random-soup"},
          NamedScene{"fans:8000"},          NamedScene{"crumpled:20000"},
          MotionFrame{"cloth:800", 80, 100}};
}

std::vector<Point> grid(const GridChoice& choice) {
  const std::vector<int> resolutions =
      choice.quick ? std::vector{64, 256, 1024} : std::vector{64, 128, 256, 512, 1024, 2048};
  std::vector<Point> out;
  for (const PointScene& scene : scenes(choice.quick)) {
    out.emplace_back(PeerPoint{scene, kBoxes});
    out.emplace_back(PeerPoint{scene, kOriented});
    out.emplace_back(plain_point(scene, Method::far_pairs));
    for (const char* views : {"z", "x,y,z"}) {
      for (const int resolution : resolutions) {
        RunPoint point = plain_point(scene, Method::far_pairs, resolution);
        point.views = views;
        out.emplace_back(point);
      }
    }
  }
  return out;
}

// Libraries leave neighbours out. far-pairs hands them to the predicates, so that they are counted
// here, for the candidates without them.
PointResult measure(const Point& point, Lab& lab) {
  if (const auto* peer = std::get_if<PeerPoint>(&point)) return measure_peer(*peer, lab, 1);
  Record record;
  PointResult out = measure_run(std::get<RunPoint>(point), lab, &record);
  std::get<RunCounts>(out.counts).neighbours =
      NeighbourCounts{record.collisions.neighbours, record.collisions.neighbour_pairs.size()};
  return out;
}

}  // namespace

Study culling_study() {
  return {.name = "culling",
          .title = "What far-pairs culls",
          .question =
              "How many pairs do boxes, oriented boxes, and far-pairs without views, in one view "
              "and in three leave to exact predicates, for each pair that collides?",
          .grid = grid,
          .measure = measure,
          .library = library_of_peer};
}

}  // namespace farcull
