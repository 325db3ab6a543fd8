// The study "accuracy": what every method misses, by the number of pixels.
#include "experiments/studies/points.h"
#include "experiments/studies/run_point.h"
#include "experiments/studies/study.h"

namespace farcull {
namespace {

using enum Method;

struct AccuracyScene {
  const char* name;
  bool self = false;  // one object against itself, by S-CULLIDE and FAR pairs
};

// Scenes of small triangles, or few: at 4096 px large ones take a software device minutes.
std::vector<AccuracyScene> scenes_of(bool quick) {
  if (quick) return {{"two-tori"}, {"needles:60"}, {"mannequin-devil", true}};
  return {{"two-tori"}, {"needles:60"}, {"field"}, {"two-bunnies"}, {"mannequin-devil", true}};
}

// Where nothing is promised no view is left out, so that the published radius takes up to five
// times as long as the budget's and sets the time of the study.
int most_published(const std::string& offset, bool quick) {
  return quick || offset == "exact" ? 1024 : 4096;
}

std::vector<Point> grid(const GridChoice& choice) {
  std::vector<Point> out;
  for (const AccuracyScene& scene : scenes_of(choice.quick)) {
    const int most =
        scene.self && choice.quick ? 1024 : 4096;  // S-CULLIDE takes a step per triangle
    const NamedScene named{scene.name};
    for (int resolution = 64; resolution <= most; resolution *= 2) {
      if (scene.self) {
        out.push_back(cullide_point(named, s_cullide, resolution));
      } else {
        out.push_back(cullide_point(named, cullide, resolution));
        out.push_back(cullide_point(named, quick_cullide, resolution));
        for (const std::string offset : {"obb", "exact"}) {
          out.push_back(far_point(named, offset, kBudgetRadius, resolution));
          if (resolution <= most_published(offset, choice.quick)) {
            out.push_back(far_point(named, offset, kPublishedRadius, resolution));
          }
        }
      }
      out.push_back(plain_point(named, far_pairs, resolution));
    }
    out.push_back(plain_point(named, far_pairs));
  }
  return out;
}

PointResult measure(const Point& point, Lab& lab) {
  return measure_run(std::get<RunPoint>(point), lab);
}

}  // namespace

Study accuracy_study() {
  return {.name = "accuracy",
          .title = "Missed collisions against resolution",
          .question =
              "How many colliding pairs and colliding triangles does each method miss against the "
              "exact answer, and do more pixels help?",
          .grid = grid,
          .measure = measure};
}

}  // namespace farcull
