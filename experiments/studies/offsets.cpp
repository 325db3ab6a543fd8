// The study "offsets": three ways to bound what a triangle may touch in a pixel.
#include "experiments/studies/fragments.h"
#include "experiments/studies/points.h"
#include "experiments/studies/run_point.h"
#include "experiments/studies/study.h"

namespace farcull {
namespace {

using enum Method;

// As in the study "scaling".
constexpr int kRepeat = 9;

std::vector<Point> grid(const GridChoice& choice) {
  const std::vector<const char*> scenes =
      choice.quick ? std::vector<const char*>{"two-spheres", "needles:60"}
                   : std::vector<const char*>{"two-tori", "needles:100", "field", "two-bunnies"};
  const std::vector<int> resolutions =
      choice.quick ? std::vector{64, 256, 1024} : std::vector{64, 128, 256, 512, 1024, 2048};
  std::vector<Point> out;
  for (const char* scene : scenes) {
    for (const int resolution : resolutions) {
      const NamedScene named{scene};
      for (const char* offset : {"obb", "exact"})
        out.push_back(repeated(far_point(named, offset, kBudgetRadius, resolution), kRepeat));
      out.push_back(repeated(plain_point(named, far_pairs, resolution), kRepeat));
    }
  }
  return out;
}

FragmentCounts fragments_of(const std::vector<PairView>& views) {
  FragmentCounts out{.tests = 0, .views = 0};
  for (const PairView& view : views) {
    if (!view.looked) continue;
    ++*out.views;
    out.fragments += view.counts.entries;
    *out.tests += view.counts.tests;
  }
  return out;
}

PointResult measure(const Point& of, Lab& lab) {
  const RunPoint& point = std::get<RunPoint>(of);
  Record record;
  PointResult out = measure_run(point, lab, &record);
  FragmentCounts& counts = std::get<RunCounts>(out.counts).fragments.emplace();
  if (point.method == far) {
    const Fragments fragments = count_fragments(lab.current(), record, point.offset);
    counts = {
        .elements = fragments.elements, .covered = fragments.covered, .fragments = fragments.solid};
  } else {
    counts = fragments_of(record.found.pair_views());
  }
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
