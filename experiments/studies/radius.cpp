// The study "radius": the lemmas and the misses against the radius, and how often the published one
// misses a pair of patches that are placed at random.
#include <fmt/format.h>

#include "experiments/lemma/lemma.h"
#include "experiments/studies/lemma_point.h"
#include "experiments/studies/placements.h"
#include "experiments/studies/points.h"
#include "experiments/studies/run_point.h"
#include "experiments/studies/study.h"

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

// Factors as they are written, so that a key read back gives the same number.
std::vector<RadiusRule> radii(bool quick) {
  std::vector<RadiusRule> out;
  for (const double factor : factors(quick))
    out.push_back(parse_radius(fmt::format("{:.4g}", factor)));
  out.push_back(kPublishedRadius);
  return out;
}

struct Size {
  double side;  // px
  std::uint64_t placements;
};

// Placements at the published radius by the size of triangles, 10^6 in all on corners snapped to 8
// bits; then by subpixel bits and by resolution, with triangles of about a pixel; and at the budget
// radius, which has to miss none.
std::vector<PlacementPoint> placements(const GridChoice& choice) {
  constexpr int kUsualBits = 8, kUsualResolution = 1024;
  const std::vector<Size> sizes =
      choice.quick ? std::vector<Size>{{0.25, 4000}, {1, 2000}}
                   : std::vector<Size>{{0.25, 100'000}, {1, 100'000}, {4, 45'000}, {16, 5'000}};
  const std::uint64_t few = choice.quick ? 1000 : 25'000;
  const int resolution = choice.quick ? kUsualResolution / 2 : kUsualResolution;
  std::vector<PlacementPoint> out;
  for (const char* from : {"dragon-bunny", "random-soup"}) {
    for (const bool grazing : {false, true}) {
      const auto add = [&](double side, std::uint64_t count, int bits, const RadiusRule& radius,
                           int px) {
        out.push_back({.from = from,
                       .grazing = grazing,
                       .side = side,
                       .placements = count,
                       .subpixel_bits = bits,
                       .radius = radius,
                       .resolution = px,
                       .seed = choice.seed});
      };
      for (const Size& size : sizes)
        add(size.side, size.placements, kUsualBits, kPublishedRadius, resolution);
      for (const int bits : {0, 4, 6, 10}) add(1, few, bits, kPublishedRadius, resolution);
      for (const int px : {resolution / 4, resolution * 4}) {
        if (px <= kUsualResolution || !choice.quick) add(1, few, kUsualBits, kPublishedRadius, px);
      }
      for (const int bits : {0, 4, kUsualBits}) add(1, few, bits, kBudgetRadius, resolution);
    }
  }
  return out;
}

std::vector<Point> grid(const GridChoice& choice) {
  const std::vector<RadiusRule> rules = radii(choice.quick);
  std::vector<Point> out;
  for (const std::string& generator : lemma_generators()) {
    LemmaPoint point{.generator = generator,
                     .points = choice.quick ? std::uint64_t{400} : 4000,
                     .seed = choice.seed};
    // Its own window has 16 million pixels.
    if (choice.quick && generator == "pixel corners at the rim") point.side = 1020;
    for (const DepthMode mode : {DepthMode::fragment, DepthMode::fixed}) {
      point.depth_mode = mode;
      for (const RadiusRule& rule : rules) {
        point.radius = rule;
        out.push_back(point);
      }
    }
    point.depth_mode = DepthMode::fragment;
    point.worst = true;
    for (const RadiusRule& rule : rules) {
      point.radius = rule;
      out.push_back(point);
    }
  }
  struct Small {
    PointScene scene;
    int resolution;
    const char* views;
  };
  std::vector<Small> scenes = {{PixelCorners{}, 96, "z"},
                               {NamedScene{"gap:216:0"}, 64, ""},
                               {NamedScene{"degenerate"}, 64, ""},
                               {NamedScene{"needles:100"}, 64, ""}};
  if (!choice.quick) {
    scenes.push_back({NamedScene{"slivers:200:1e6"}, 128, ""});
    scenes.push_back({NamedScene{"crowd"}, 128, ""});
  }
  for (const Small& small : scenes) {
    for (const DepthMode mode : {DepthMode::fragment, DepthMode::fixed}) {
      for (const RadiusRule& rule : rules) {
        RunPoint point = far_point(small.scene, "obb", rule, small.resolution);
        point.depth_mode = mode;
        point.depth_format.reset();
        point.views = small.views;
        out.push_back(std::move(point));
      }
    }
  }
  for (PlacementPoint& point : placements(choice)) out.push_back(std::move(point));
  return out;
}

PointResult measure(const Point& point, Lab& lab) {
  if (const auto* lemma = std::get_if<LemmaPoint>(&point)) return measure_lemma(*lemma, lab);
  if (const auto* placed = std::get_if<PlacementPoint>(&point))
    return measure_placements(*placed, lab);
  return measure_run(std::get<RunPoint>(point), lab);
}

}  // namespace

Study radius_study() {
  return {.name = "radius",
          .title = "Violations and misses against the radius",
          .question =
              "How large must the ball be that fattens a primitive, so that no pixel lacks "
              "a sample or a bound, what happens below that, and how often does the published "
              "radius miss a pair?",
          .grid = grid,
          .measure = measure};
}

}  // namespace farcull
