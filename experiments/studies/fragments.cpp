// Counts, on the cores of the CPU, the pixel centres that proxies cover.
#include "experiments/studies/fragments.h"

#include <algorithm>
#include <cmath>

#include "core/base/parallel.h"
#include "core/canvas/fatten.h"
#include "core/view/regions.h"
#include "core/view/view.h"
#include "offsets/minkowski.h"
#include "offsets/obb.h"

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

}  // namespace farcull
