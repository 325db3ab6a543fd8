// The study "precision": what a depth buffer's format and the way in which depth is made cost.
#include "experiments/studies/lemma_point.h"
#include "experiments/studies/points.h"
#include "experiments/studies/study.h"

namespace farcull {
namespace {

// Generators whose depth varies inside a pixel; the triangles of the others are too small for it.
constexpr const char* kGenerators[] = {
    "random triangles", "edges at 45 degrees", "parallel to the view",  "almost flat",
    "needles",          "segments and points", "steep at pixel corners"};

std::vector<Point> grid(const GridChoice& choice) {
  const std::uint64_t points = choice.quick ? 500 : 4000;
  // Each with its border makes a viewport of a power of two; the depth reaches what a window may
  // have (core/view/view.h, fit_window).
  const std::vector<int> sides =
      choice.quick ? std::vector{508, 1020} : std::vector{508, 2044, 4092};
  const std::vector<double> depths =
      choice.quick ? std::vector{0x1p8, 0x1p20} : std::vector{0x1p8, 0x1p12, 0x1p16, 0x1p20};
  std::vector<Point> out;
  for (const char* generator : kGenerators) {
    for (const double depth : depths) {
      LemmaPoint point{
          .generator = generator, .points = points, .depth = depth, .seed = choice.seed};
      for (const int side : sides) {
        point.side = side;
        for (const DepthMode mode : {DepthMode::fragment, DepthMode::fixed}) {
          point.depth_mode = mode;
          for (const DepthFormat format : {DepthFormat::float32, DepthFormat::fixed24}) {
            point.depth_format = format;
            for (const RadiusRule& radius : {kPublishedRadius, kBudgetRadius}) {
              point.radius = radius;
              out.push_back(point);
            }
          }
        }
      }
    }
  }
  return out;
}

PointResult measure(const Point& point, Lab& lab) {
  return measure_lemma(std::get<LemmaPoint>(point), lab);
}

}  // namespace

Study precision_study() {
  return {.name = "precision",
          .title = "Bounds on depth, as depth buffers hold them",
          .question =
              "Do samples bound the depth of every point, in a buffer of 24 bits and of 32, "
              "when the rasterizer interpolates depth and when a fragment program computes "
              "it, at any resolution and depth of the scene?",
          .grid = grid,
          .measure = measure};
}

}  // namespace farcull
