// The study "offsets": three ways to bound what a triangle may touch in a pixel.
#include "experiments/studies/fragments.h"
#include "experiments/studies/lab.h"
#include "experiments/studies/points.h"

namespace farcull {
namespace {

constexpr int kRepeat = 3;  // the median of their times

std::vector<Point> grid(const GridChoice& choice) {
  const std::vector<const char*> scenes =
      choice.quick ? std::vector<const char*>{"two-spheres", "needles:60"}
                   : std::vector<const char*>{"two-tori", "needles:100", "field", "two-bunnies"};
  const std::vector<int> resolutions =
      choice.quick ? std::vector{64, 256, 1024} : std::vector{64, 128, 256, 512, 1024, 2048};
  std::vector<Point> out;
  for (const char* scene : scenes) {
    for (const int resolution : resolutions) {
      out.push_back(far_point(scene, "obb", "budget", resolution));
      out.push_back(far_point(scene, "exact", "budget", resolution));
      out.push_back(plain_point(scene, "far-pairs", resolution));
    }
  }
  return out;
}

Measurement measure(const Point& point, Lab& lab) {
  const Scene& scene = lab.scene(point.scene);
  RunRecord record;
  Measurement out = measure_run(point, lab, kRepeat, &record);
  if (point.method == "far") {
    const Fragments fragments = count_fragments(scene, record, point.offset);
    out.counts["elements"] = fragments.elements;
    out.counts["covered"] = fragments.covered;
    out.counts["fragments"] = fragments.solid;
    return out;
  }
  std::uint64_t entries = 0, tests = 0, looked = 0;
  for (const PairView& view : record.pair_views) {
    if (!view.looked) continue;
    ++looked;
    entries += view.counts.entries;
    tests += view.counts.tests;
  }
  out.counts["fragments"] = entries;
  out.counts["tests"] = tests;
  out.counts["views"] = looked;
  return out;
}

}  // namespace

Study offsets_study() {
  return {.name = "offsets",
          .title = "Boxes, exact offsets and intervals",
          .question =
              "What do the three ways to bound a fattened triangle in a pixel (the box around it, "
              "the Minkowski sum itself, the interval of its depths) keep, and at what cost?",
          .grid = grid,
          .measure = measure};
}

}  // namespace farcull
