// The study "radius": the lemmas and the misses against the radius.
#include <fmt/format.h>

#include "experiments/builtin_shapes.h"
#include "experiments/lemma.h"
#include "experiments/scene_build.h"
#include "experiments/studies/lab.h"
#include "experiments/studies/lemma_point.h"

namespace farcull {
namespace {

// Factors on the budget radius, 1 among them.
std::vector<double> factors(bool quick) {
  std::vector<double> out;
  const int steps = quick ? 11 : 22;
  for (int i = 0; i <= steps; ++i) {
    const double factor = static_cast<double>(i) * 11 / steps / 10;
    out.push_back(factor);
    if (!quick && i == 18)
      for (const double finer : {0.91, 0.92, 0.93, 0.94}) out.push_back(finer);
    if (!quick && i == 19)
      for (const double finer : {0.96, 0.97, 0.98, 0.985, 0.99, 0.995, 0.999}) out.push_back(finer);
  }
  return out;
}

std::vector<std::string> radii(bool quick) {
  std::vector<std::string> out;
  for (const double factor : factors(quick))
    out.push_back(factor == 1 ? "budget" : fmt::format("{:.4g}", factor));
  out.push_back("published");
  return out;
}

// Two objects of segments, each of the one crossed by one of the other at 45 degrees, within 2^-10
// px of a corner of a pixel in the view z at this resolution: both boxes are as many units wide as
// the window has pixels, so that a unit is a pixel and corners are whole numbers (core/view.h,
// fit_window).
constexpr const char* kCorners = "pixel-corners";
constexpr int kCornersResolution = 96;

Scene pixel_corners() {
  using shapes::Corners;
  constexpr int kHalf = kCornersResolution / 2;
  constexpr double kReach = 0x1p-12;
  shapes::Random random(16);
  std::vector<Corners> one, other;
  for (int y = 3 - kHalf; y <= kHalf - 3; y += 3) {
    for (int x = 3 - kHalf; x <= kHalf - 3; x += 3) {
      const auto near = [&random] {
        return (static_cast<double>(random.below(33)) - 16) * 0x1p-14;
      };
      const double dx = near(), dy = near();
      const Vec3 q(x + dx, y + dy, static_cast<double>(random.below(64)));
      const Vec3 up(kReach, kReach, 0), down(kReach, -kReach, 0);
      one.push_back({q - up, q + up, q + up});
      other.push_back({q - down, q + down, q + down});
    }
  }
  for (const double at : {-1.0, 1.0}) {  // points: they make the boxes as large, and touch
    const Vec3 p(at * kHalf, at * kHalf, 64);
    for (auto* list : {&one, &other}) list->push_back({p, p, p});
  }
  SceneBuilder scene(kCorners, kCorners);
  scene.add(shapes::soup(one), "rising", Split::kNone, {});
  scene.add(shapes::soup(other), "falling", Split::kNone, {});
  return scene.finish();
}

std::vector<Point> grid(const GridChoice& choice) {
  const std::uint64_t points = choice.quick ? 400 : 4000;
  std::vector<Point> out;
  for (const std::string& generator : lemma_generators()) {
    // Its own window has 16 million pixels.
    const bool rim = generator == "pixel corners at the rim";
    for (const char* depth : {"fragment", "fixed", "worst"}) {
      const bool worst = std::string(depth) == "worst";
      for (const std::string& radius : radii(choice.quick)) {
        out.push_back({.scene = LemmaScene{generator, points}.name(),
                       .method = worst ? "lemma-worst" : "lemma",
                       .offset = "obb",
                       .radius = radius,
                       .depth_format = {},
                       .depth_mode = worst ? "fragment" : depth,
                       .resolution = rim && choice.quick ? 1020 : 0,
                       .views = {},
                       .frame = -1,
                       .seed = choice.seed});
      }
    }
  }
  struct Small {
    const char* scene;
    int resolution;
    const char* views;
  };
  std::vector<Small> scenes = {{kCorners, kCornersResolution, "z"},
                               {"gap:216:0", 64, ""},
                               {"degenerate", 64, ""},
                               {"needles:100", 64, ""}};
  if (!choice.quick)
    scenes.insert(scenes.end(), {{"slivers:200:1e6", 128, ""}, {"crowd", 128, ""}});
  for (const Small& small : scenes) {
    for (const char* depth : {"fragment", "fixed"}) {
      for (const std::string& radius : radii(choice.quick)) {
        out.push_back({.scene = small.scene,
                       .method = "far",
                       .offset = "obb",
                       .radius = radius,
                       .depth_format = {},
                       .depth_mode = depth,
                       .resolution = small.resolution,
                       .views = small.views,
                       .frame = -1,
                       .seed = 0});
      }
    }
  }
  return out;
}

Measurement measure(const Point& point, Lab& lab) {
  if (point.method != "far") return measure_lemma(point, lab);
  if (point.scene == kCorners) {
    lab.scene(kCorners, pixel_corners);
  } else {
    lab.scene(point.scene);
  }
  return measure_run(point, lab);
}

}  // namespace

Study radius_study() {
  return {.name = "radius",
          .title = "Violations and misses against the radius",
          .question =
              "How large must the ball be that fattens a primitive, so that no pixel lacks "
              "a sample or a bound, and what happens below that?",
          .grid = grid,
          .measure = measure};
}

}  // namespace farcull
