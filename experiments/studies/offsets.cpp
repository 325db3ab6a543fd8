// The study "offsets": three ways to bound what a triangle may touch in a pixel. The pixel centres
// that proxies cover are counted on the cores of the CPU.
#include <algorithm>
#include <cmath>

#include "core/base/parallel.h"
#include "core/canvas/fatten.h"
#include "core/view/regions.h"
#include "core/view/view.h"
#include "experiments/studies/point.h"
#include "experiments/studies/run_point.h"
#include "experiments/studies/study.h"
#include "offsets/offsets.h"

namespace farcull {
namespace {

// The part of a row of pixel centres at `y` that is inside the convex quadrilateral, as [from, to]
// in x; empty where from > to.
struct Span {
  double from = 0, to = -1;
};

Span span_at(const std::array<float, 8>& corners, double y) {
  Span out{HUGE_VAL, -HUGE_VAL};
  for (int i = 0; i < 4; ++i) {
    const double x0 = corners[2 * i], y0 = corners[2 * i + 1];
    const double x1 = corners[(2 * i + 2) % 8], y1 = corners[(2 * i + 3) % 8];
    if (std::min(y0, y1) > y || std::max(y0, y1) < y) continue;
    const auto add = [&out](double x) {
      out.from = std::min(out.from, x);
      out.to = std::max(out.to, x);
    };
    if (y0 == y1) {
      add(x0);
      add(x1);
    } else {
      add(x0 + (y - y0) / (y1 - y0) * (x1 - x0));
    }
  }
  return out;
}

// Counts the elements from .. to - 1. Pixel centres are the halves between the window's borders.
Fragments count_in(const Drawables& drawables, const SolidProgram& program, const Window& window,
                   std::size_t from, std::size_t to) {
  Fragments out;
  const double right = 0.5 * window.width - 0.5, top = 0.5 * window.height - 0.5;
  const auto first_centre = [](double x) { return std::ceil(x - 0.5) + 0.5; };
  for (std::size_t e = from; e < to; ++e) {
    const Proxy& proxy = drawables.proxies[e];
    double lo = HUGE_VAL, hi = -HUGE_VAL;
    for (int i = 0; i < 4; ++i) {
      lo = std::min<double>(lo, proxy.corners[2 * i + 1]);
      hi = std::max<double>(hi, proxy.corners[2 * i + 1]);
    }
    for (double y = first_centre(std::max(lo, -top)); y <= std::min(hi, top); ++y) {
      const Span span = span_at(proxy.corners, y);
      for (double x = first_centre(std::max(span.from, -right)); x <= std::min(span.to, right);
           ++x) {
        float entry = 0, exit = 0;
        ++out.covered;
        out.solid += program.interval(static_cast<float>(x), static_cast<float>(y), proxy.solid,
                                      entry, exit);
      }
    }
  }
  out.elements = to - from;
  return out;
}

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

Fragments count_fragments(const Scene& scene, const Record& record, const std::string& offset) {
  const Fattener fattener = offset == "exact" ? minkowski_fattener() : obb_fattener();
  const Regions regions = find_regions(scene);
  const std::vector<View> views = parse_views(views_of(record.options));
  Fragments sum;
  for (std::size_t v = 0; v < views.size() && v < record.found.views().size(); ++v) {
    const auto window = fit_window(views[v], regions.places, resolution_of(record.options));
    if (!window) continue;
    FattenCounts counts;
    const Drawables drawables = fatten(scene, regions.triangles, *window, fattener,
                                       record.found.views()[v].radius_px, counts);
    const std::size_t chunks = chunks_for(drawables.elements(), 256);
    std::vector<Fragments> parts(chunks);
    for_chunks(drawables.elements(), chunks,
               [&](std::size_t chunk, std::size_t from, std::size_t to) {
                 parts[chunk] = count_in(drawables, fattener.solid, *window, from, to);
               });
    for (const Fragments& part : parts) {
      sum.covered += part.covered;
      sum.solid += part.solid;
      sum.elements += part.elements;
    }
  }
  return sum;
}

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
