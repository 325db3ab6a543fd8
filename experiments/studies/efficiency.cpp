// How much smaller than I-COLLIDE's the sets are that FAR keeps, and what Quick-CULLIDE saves
// against CULLIDE, frame by frame over scenes that move.
//
// Govindaraju, Lin and Manocha, Fast and Reliable Collision Culling using Graphics Hardware, TVCG
// 2006, section 6 (FAR against I-COLLIDE); Quick-CULLIDE, IEEE VR 2005 (against CULLIDE).
#include "experiments/studies/lab.h"

namespace farcull {
namespace {

struct MovingCase {
  const char* scene;
  bool self = false;  // its objects are tested against themselves as well, which few methods do
};

// All scenes that move, as large as the methods that draw can take on a software device.
const std::vector<MovingCase>& cases(bool quick) {
  static const std::vector<MovingCase> full = {
      {"two-spheres"},     {"needles:60"},  {"crowd:60"},           {"field:4000"},
      {"cylinders:30"},    {"torii:800"},   {"tree-leaves:60"},     {"shells:6"},
      {"cloth:800", true}, {"two-bunnies"}, {"bunny-dragon:19994"}, {"breaking-dragon:19994"}};
  static const std::vector<MovingCase> few = {{"crowd:30"}, {"cylinders:12"}, {"tree-leaves:20"}};
  return quick ? few : full;
}

long frames_of(bool quick) { return quick ? 4 : 12; }

constexpr int kResolution = 256;

std::vector<Point> methods_at(const MovingCase& moving, long frame) {
  std::vector<Point> out;
  const auto add = [&](const char* method, const char* offset, bool drawn) {
    Point point;
    point.scene = moving.scene;
    point.method = method;
    point.offset = offset;
    if (drawn) {
      const bool far = point.method == "far";
      if (far) point.radius = "budget";
      point.depth_format = "float32";
      point.depth_mode = far ? "fragment" : "fixed";
      point.resolution = kResolution;
    }
    point.frame = frame;
    out.push_back(std::move(point));
  };
  add("i-collide", "", false);
  if (!moving.self) {
    add("far", "obb", true);
    add("far", "exact", true);
    add("cullide", "", true);
    add("quick-cullide", "", true);
  }
  add("far-pairs", "", false);
  return out;
}

// The number of frames of the grid that a point is of: the same motion in more frames moves less
// from one to the next.
long frames_with(const std::string& scene) {
  for (const MovingCase& moving : cases(true)) {
    if (scene == moving.scene) return frames_of(true);
  }
  return frames_of(false);
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
    for (const MovingCase& moving : cases(choice.quick)) {
      for (long frame = 0; frame < frames_of(choice.quick); ++frame) {
        for (Point& point : methods_at(moving, frame)) out.push_back(std::move(point));
      }
    }
    return out;
  };
  study.measure = [](const Point& point, Lab& lab) {
    lab.scene(point.scene, point.frame, frames_with(point.scene));
    return measure_run(point, lab);
  };
  return study;
}

}  // namespace farcull
