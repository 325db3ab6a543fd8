// How much smaller than I-COLLIDE's the sets are that FAR keeps, and what Quick-CULLIDE saves
// against CULLIDE, frame by frame over scenes that move.
//
// Govindaraju, Lin and Manocha, Fast and Reliable Collision Culling using Graphics Hardware, TVCG
// 2006, section 6 (FAR against I-COLLIDE); Quick-CULLIDE, IEEE VR 2005 (against CULLIDE).
#include <utility>

#include "experiments/studies/points.h"
#include "experiments/studies/run_point.h"
#include "experiments/studies/study.h"

namespace farcull {
namespace {

using enum Method;

struct MovingCase {
  const char* scene;
  bool self = false;  // its objects are tested against themselves as well, by few methods
};

// All scenes that move, no larger than the methods that draw can take on a software device.
const std::vector<MovingCase>& cases(bool quick) {
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
  out.push_back(plain_point(frame, far_pairs));
}

}  // namespace

Study efficiency_study() {
  Study study;
  study.name = "efficiency";
  study.title = "Culling efficiency in motion";
  study.question =
      "How much smaller than what I-COLLIDE leaves is what FAR leaves to exact tests, and how much "
      "does Quick-CULLIDE draw and ask less than CULLIDE, frame by frame over scenes that move?";
  study.grid = [](const GridChoice& choice) {
    std::vector<Point> out;
    // Six frames at least: the range of fewer does not contain the median with 95 %.
    const long frames = choice.quick ? 6 : 12;
    for (const MovingCase& moving : cases(choice.quick)) {
      for (long frame = 0; frame < frames; ++frame)
        add_methods(out, moving, {moving.scene, frame, frames});
    }
    return out;
  };
  study.measure = [](const Point& point, Lab& lab) {
    return measure_run(std::get<RunPoint>(point), lab);
  };
  return study;
}

}  // namespace farcull
