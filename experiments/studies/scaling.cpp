// The papers' three plots, time against the number of objects, of polygons and of pixels, and two
// more: against density and against the pairs that collide.
//
// CULLIDE (Graphics Hardware 2003), figures of time against objects, polygons and resolution.
#include <fmt/format.h>

#include <set>

#include "experiments/studies/points.h"
#include "experiments/studies/run_point.h"
#include "experiments/studies/study.h"

namespace farcull {
namespace {

using enum Method;

// A scene of one of the plots. A scene may serve in several, where it is measured once.
struct Case {
  std::string scene;
  int resolution;  // of the methods that draw
  bool drawn;      // whether they take part: they are far slower on a software device
};

std::vector<Case> cases(bool quick) {
  constexpr int kUsual = 256;
  std::vector<Case> out;
  const auto add = [&out](std::string scene, int resolution, bool drawn) {
    out.push_back({std::move(scene), resolution, drawn});
  };
  // At least six sizes of each, so that a fitted exponent has an interval.
  // Objects: of about the same size, in a box that grows with their number.
  for (const int n :
       quick ? std::vector{5, 10, 20, 40, 80, 160} : std::vector{25, 50, 100, 200, 400, 800}) {
    add(fmt::format("crowd:{}", n), kUsual, true);
  }
  if (!quick) {
    for (const int n : {1600, 3200, 6400}) add(fmt::format("crowd:{}", n), kUsual, false);
  }
  // Density: the same objects closer together. What collides grows with it.
  const int objects = quick ? 20 : 100;
  for (const double density : {0.05, 0.1, 0.2, 0.4, 0.8, 1.6}) {
    add(fmt::format("crowd:{}:{}", objects, density), kUsual, true);
  }
  // Polygons: six tori, ever finer.
  for (const int n :
       quick ? std::vector{72, 128, 200, 320, 500, 800} : std::vector{72, 200, 400, 800, 1600}) {
    add(fmt::format("torii:{}", n), kUsual, true);
  }
  if (!quick) {
    for (const int n : {5000, 20000, 80000}) add(fmt::format("torii:{}", n), kUsual, n <= 5000);
  }
  // Pixels.
  for (const int pixels : quick ? std::vector{32, 64, 128, 256, 512, 1024}
                                : std::vector{64, 128, 256, 512, 1024, 2048}) {
    add("two-spheres", pixels, true);
  }
  return out;
}

// Times vary by a third on a shared machine. Nine runs are the fewest odd number whose bootstrap
// interval contains the median with 95 % (docs/experiments.md, "Statistics").
constexpr int kRepeat = 9;

std::vector<RunPoint> points_of(const Case& c) {
  const NamedScene scene{c.scene};
  std::vector<RunPoint> out;
  if (c.drawn) {
    out = {far_point(scene, "obb", kBudgetRadius, c.resolution),
           cullide_point(scene, cullide, c.resolution)};
  }
  for (const Method method : {far_pairs, i_collide, exact}) {
    // Alone of these far-pairs has pixels; where the plot is of pixels it takes those.
    const bool pixels = method == far_pairs && c.scene == "two-spheres";
    out.push_back(plain_point(scene, method, pixels ? c.resolution : 0));
  }
  for (RunPoint& point : out) point.repeat = kRepeat;
  return out;
}

}  // namespace

Study scaling_study() {
  Study study;
  study.name = "scaling";
  study.title = "Time against size";
  study.question =
      "How does the time from triangles to exact pairs grow with the number of objects, of "
      "triangles, of pixels, with density, and with the pairs that collide?";
  study.grid = [](const GridChoice& choice) {
    std::vector<Point> out;
    std::set<PointKey> had;
    for (const Case& c : cases(choice.quick)) {
      for (RunPoint& point : points_of(c)) {
        if (had.insert(key_of(point)).second) out.push_back(std::move(point));
      }
    }
    return out;
  };
  study.measure = [](const Point& point, Lab& lab) {
    return measure_run(std::get<RunPoint>(point), lab);
  };
  return study;
}

}  // namespace farcull
