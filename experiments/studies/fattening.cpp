// Studies of the proxies that are drawn in place of triangles. "offsets" compares three ways to
// bound a fattened triangle in a pixel; the CPU counts the pixel centres that proxies cover.
// "precision" tests lemmas 1 and 2 (docs/reliability.md) for each format of the depth buffer and
// each source of depth. "radius" tests both lemmas for each radius, and counts the pairs that FAR
// misses in scenes and on randomly placed patches.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "core/base/parallel.h"
#include "core/base/stopwatch.h"
#include "core/native/canvas.h"
#include "experiments/lemma/lemma.h"
#include "experiments/studies/run_point.h"
#include "offsets/offsets.h"
#include "verify/worst_canvas.h"

namespace farcull {
namespace {

// ---- "offsets" ----

// The interval of x in which a convex quadrilateral covers the row `y`. Empty if from > to.
struct Span {
  double from = HUGE_VAL, to = -HUGE_VAL;
};

Span span_at(const std::array<float, 8>& corners, double y) {
  Span out;
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

// Counts the fragments (run_point.h) of the elements `from` to `to` - 1. The coordinates of pixel
// centres are half-integers.
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

constexpr int kRepeat = 3 * kRounds;  // nine runs in all, as in the study "scaling"

std::vector<Point> offsets_grid(const GridChoice& choice) {
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
    }
  }
  return out;
}

PointResult measure_offsets(const Point& of, MeasurementContext& lab) {
  const RunPoint& point = std::get<RunPoint>(of);
  Record record;
  PointResult out = measure_with_risk(point, lab, &record);
  const Fragments fragments = count_fragments(lab.current(), record, point.offset);
  std::get<RunCounts>(out.counts).fragments = FragmentCounts{
      .elements = fragments.elements, .covered = fragments.covered, .fragments = fragments.solid};
  return out;
}

// ---- "precision" and "radius" ----

// The native canvas with a depth buffer in 16-bit fixed point. Only depths are offered, so run()
// throws. depths() rounds the nearest or farthest depth of each pixel. Rounding is monotone, so the
// result equals the nearest or farthest of the rounded depths.
class CoarseCanvas final : public Canvas {
 public:
  CoarseCanvas(DepthMode mode, const SolidProgram& solid)
      : canvas_(mode, solid), limits_(canvas_.limits()) {
    limits_.depth_bits = 16;
  }
  const RasterLimits& limits() const override { return limits_; }
  void begin(const Window& window, const Drawables& drawables) override {
    canvas_.begin(window, drawables);
  }
  std::vector<std::uint8_t> run(const Pass&) override {
    throw std::logic_error("CoarseCanvas: only depths are offered");
  }
  std::vector<float> samples(Verb verb, const std::vector<Draw>& draws) override {
    return canvas_.samples(verb, draws);
  }
  std::vector<float> depths(Verb verb, const std::vector<Draw>& draws) override {
    std::vector<float> out = canvas_.depths(verb, draws);
    for (float& z : out) z = std::nearbyint(z * 0xffff) / 0xffff;
    return out;
  }

 private:
  NativeCanvas canvas_;
  RasterLimits limits_;
};

LemmaSettings settings_of(const LemmaPoint& point) {
  LemmaSettings settings;
  settings.points = point.points * lemma_generators().size();
  settings.generator = point.generator;
  settings.seed = point.seed;
  settings.displace = point.worst;
  settings.stored =
      point.coarse || point.depth_mode == DepthMode::fixed || point.depth_format.has_value();
  settings.side = point.side;
  settings.depth = point.depth / 2;
  return settings;
}

// Generators whose triangles vary in depth inside a pixel. Other generators make smaller triangles.
constexpr const char* kGenerators[] = {
    "random triangles", "edges at 45 degrees", "parallel to the view",  "almost flat",
    "needles",          "segments and points", "steep at pixel corners"};

std::vector<Point> precision_grid(const GridChoice& choice) {
  const std::uint64_t points = choice.quick ? 500 : 4000;
  // Each side plus the border of 4 px is a power of two. 2^20 px is the largest depth of a window
  // (core/view/view.h, fit_window). At this depth, a step of a 24-bit buffer is longer than the
  // ball's chord on the view ray through a pixel's corner. At a depth of 2^13 px, a step of a
  // 16-bit buffer is longer than this chord.
  const std::vector<int> sides = choice.quick ? std::vector{508, 1020} : std::vector{508, 4092};
  const std::vector<double> depths =
      choice.quick ? std::vector{0x1p8, 0x1p20} : std::vector{0x1p8, 0x1p13, 0x1p20};
  std::vector<Point> out;
  for (const char* generator : kGenerators) {
    for (const double depth : depths) {
      LemmaPoint point{
          .generator = generator, .points = points, .depth = depth, .seed = choice.seed};
      for (const int side : sides) {
        point.side = side;
        const auto add = [&](DepthMode mode, std::optional<DepthFormat> format,
                             const std::vector<RadiusRule>& radii) {
          point.depth_mode = mode;
          point.depth_format = format;
          point.coarse = !format;
          for (const RadiusRule& radius : radii) {
            point.radius = radius;
            out.push_back(point);
          }
        };
        // Violations at 0.9 times the budget radius show that the points can reveal a radius that
        // is too small.
        const std::vector<RadiusRule> computed = {parse_radius("0.9"), kPublishedRadius,
                                                  kBudgetRadius};
        for (const DepthFormat format : {DepthFormat::float32, DepthFormat::fixed24}) {
          add(DepthMode::fragment, format, computed);
          add(DepthMode::fixed, format, {kPublishedRadius, kBudgetRadius});
        }
        add(DepthMode::fragment, {}, {parse_radius("0.9"), kBudgetRadius});
      }
    }
  }
  return out;
}

// Returns the published radius, and factors of the budget radius from 0 to 1.1. There are more
// factors near 1.
std::vector<RadiusRule> radii(bool quick) {
  std::vector<double> factors;
  const int steps = quick ? 11 : 22;
  for (int i = 0; i <= steps; ++i) factors.push_back(static_cast<double>(i) * 11 / steps / 10);
  if (!quick) {
    factors.insert(factors.end(),
                   {0.91, 0.92, 0.93, 0.94, 0.96, 0.97, 0.98, 0.985, 0.99, 0.995, 0.999});
    std::ranges::sort(factors);
  }
  std::vector<RadiusRule> out;
  // Rounds each factor to its text in a store, so that reading the store gives the same number.
  for (const double factor : factors) out.push_back(parse_radius(fmt::format("{:.4g}", factor)));
  out.push_back(kPublishedRadius);
  return out;
}

// Placements of pairs. For each number of subpixel bits, one row has the published radius and the
// side at which most pairs are missed. Other rows differ in one value from the row of 8 bits: no
// snapping; the budget radius; 0.9 of the budget radius, to count pairs at risk; other sides; a
// stratum of twice the width, which must give the same rate of misses. The last row draws pairs
// anywhere. It has 3 bits, since with more bits too few such pairs are missed.
constexpr struct {
  const char* radius;
  double side;  // px
  int bits, widening;
  std::uint64_t thousands;  // number of placements / 1000
} kPairs[] = {{"published", 0x1p-4, 4, 1, 250},   {"published", 0x1p-6, 6, 1, 250},
              {"published", 0x1p-8, 8, 1, 1000},  {"published", 0x1p-8, 0, 1, 250},
              {"budget", 0x1p-8, 8, 1, 250},      {"0.9", 0x1p-8, 8, 1, 250},
              {"published", 0x1p-10, 10, 1, 250}, {"published", 0x1p-9, 8, 1, 250},
              {"published", 0x1p-5, 8, 1, 250},   {"published", 0x1p-8, 8, 2, 1000},
              {"published", 0x1p-3, 3, 1, 100},   {"published", 0x1p-3, 3, 0, 1000}};

struct Size {
  double side;  // px
  std::uint64_t placements;
};

constexpr double kSmallest = 0x1p-5;  // px; nearby pairs rarely decide whether a pair is culled

// Returns four series of points:
// (1) With 8 subpixel bits, triangles of each size at the published radius, 10^6 placements in
//     all; and triangles up to 4 px at 0.5 to 0.95 times the budget radius.
// (2) The smallest triangles at the published radius, with other numbers of subpixel bits and at
//     other resolutions.
// (3) The smallest triangles at the budget radius, at which no pair may be missed.
// (4) Pairs of triangles (kPairs).
std::vector<PlacementPoint> placements(const GridChoice& choice) {
  constexpr int kUsualBits = 8;
  const int usual_resolution = choice.quick ? 512 : 1024;
  const std::vector<Size> sizes =
      choice.quick
          ? std::vector<Size>{{kSmallest, 4000}, {1, 2000}}
          : std::vector<Size>{
                {kSmallest, 100'000}, {0.25, 75'000}, {1, 50'000}, {4, 22'000}, {16, 3000}};
  const std::uint64_t few = choice.quick ? 2000 : 25'000;
  std::vector<PlacementPoint> out;
  for (const char* from : {"dragon-bunny", "random-soup"}) {
    for (const bool grazing : {false, true}) {
      const auto add = [&](const Size& size, int bits, const RadiusRule& radius, int resolution) {
        out.push_back({.from = from,
                       .grazing = grazing,
                       .side = size.side,
                       .placements = size.placements,
                       .subpixel_bits = bits,
                       .radius = radius,
                       .resolution = resolution,
                       .seed = choice.seed});
      };
      for (const Size& size : sizes) add(size, kUsualBits, kPublishedRadius, usual_resolution);
      for (const Size& size : sizes) {
        if (size.side > 4) continue;  // a window holds few larger triangles
        const Size fewer = {size.side, std::min<std::uint64_t>(size.placements / 4, 5000)};
        for (const char* factor : {"0.5", "0.7", "0.8", "0.9", "0.95"})
          add(fewer, kUsualBits, parse_radius(factor), usual_resolution);
      }
      const Size smallest = {kSmallest, few};
      for (const int bits : {0, 4, 6, 10}) add(smallest, bits, kPublishedRadius, usual_resolution);
      for (const int resolution : {usual_resolution / 4, usual_resolution * 4})
        add(smallest, kUsualBits, kPublishedRadius, resolution);
      for (const int bits : {0, 4, kUsualBits})
        add(smallest, bits, kBudgetRadius, usual_resolution);
    }
    for (const auto& row : kPairs) {
      out.push_back({.from = from,
                     .pairs = true,
                     .widening = row.widening,
                     .side = row.side,
                     .placements = row.thousands * (choice.quick ? 20 : 1000),
                     .subpixel_bits = row.bits,
                     .radius = parse_radius(row.radius),
                     .resolution = usual_resolution,
                     .seed = choice.seed});
    }
  }
  return out;
}

std::vector<Point> radius_grid(const GridChoice& choice) {
  const std::vector<RadiusRule> rules = radii(choice.quick);
  std::vector<Point> out;
  for (const std::string& generator : lemma_generators()) {
    LemmaPoint point{.generator = generator,
                     .points = choice.quick ? std::uint64_t{400} : 4000,
                     .seed = choice.seed};
    // The default window of this generator has 16 million pixels.
    if (choice.quick && generator == "pixel corners at the rim") point.side = 1020;
    for (const auto& [mode, worst] :
         {std::pair(DepthMode::fragment, false), std::pair(DepthMode::fixed, false),
          std::pair(DepthMode::fragment, true)}) {
      point.depth_mode = mode;
      point.worst = worst;
      for (const RadiusRule& rule : rules) {
        point.radius = rule;
        out.push_back(point);
      }
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
        point.form.views = small.views;
        out.push_back(std::move(point));
      }
    }
  }
  for (PlacementPoint& point : placements(choice)) out.push_back(std::move(point));
  return out;
}

PointResult measure_radius(const Point& point, MeasurementContext& lab) {
  if (const auto* lemma = std::get_if<LemmaPoint>(&point)) return measure_lemma(*lemma, lab);
  if (const auto* placed = std::get_if<PlacementPoint>(&point))
    return measure_placements(*placed, lab);
  return measure_run(std::get<RunPoint>(point), lab);
}

}  // namespace

Fragments count_fragments(const Scene& scene, const Record& record, const std::string& offset) {
  const Fattener fattener = offset == "exact" ? minkowski_fattener() : obb_fattener();
  const Regions regions = find_regions(scene);
  Fragments sum;
  for (const ViewReport& view : record.found.views()) {
    const auto window =
        fit_window(parse_view(view.name), regions.places, resolution_of(record.options));
    if (!window) continue;
    FattenCounts counts;
    const Drawables drawables =
        fatten(scene, regions.triangles, *window, fattener, view.radius_px, counts);
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

PointResult measure_lemma(const LemmaPoint& point, MeasurementContext& lab) {
  const bool fixed = point.depth_mode == DepthMode::fixed;
  const Fattener fattener = fixed ? obb_surface_fattener() : obb_fattener();
  const bool bits24 = point.depth_format == DepthFormat::fixed24;
  PointResult out;
  LemmaCounts counts;
  // guaranteed() (method/run.h) applies the same rule to FAR.
  counts.promises = !fixed && !point.radius.published && point.radius.factor >= 1;
  std::unique_ptr<WorstCanvas> worst;
  std::unique_ptr<CoarseCanvas> coarse;
  Canvas* canvas = nullptr;
  if (point.worst) {
    worst = std::make_unique<WorstCanvas>(fattener.solid,
                                          WorstCanvasOptions{.depth_bits = bits24 ? 24 : 32});
    canvas = worst.get();
    out.device = "cpu";
  } else if (point.coarse) {
    coarse = std::make_unique<CoarseCanvas>(fattener.mode, fattener.solid);
    canvas = coarse.get();
    out.device = "native";
  } else {
    const bool native = lab.session().canvas_device().native;
    if (counts.promises && !native && !lab.session().verdict().holds) counts.revoked = true;
    canvas = &lab.session().canvas(
        fattener, {.depth_format = bits24 ? DepthFormat::fixed24 : DepthFormat::float32,
                   .query = bits24 ? QueryMode::occlusion : QueryMode::flags});
    out.device = native ? "native" : lab.session().context().info().renderer;
  }
  if (point.side > canvas->limits().max_resolution) {
    out.left_out = fmt::format("{} px are beyond the device's {}", point.side,
                               canvas->limits().max_resolution);
    return out;
  }

  LemmaSettings settings = settings_of(point);
  settings.radius = [&](const Budget& budget, double step) {
    counts.step_px = step;
    counts.budget_px = budget.radius();
    counts.radius_px = lemma_radius(point.radius, budget, step);
    return counts.radius_px;
  };
  const Stopwatch watch;
  const LemmaRow row = lemma_experiment(*canvas, fattener, settings, lab.progress()).front();
  out.times.total = watch.ms();
  counts.points = row.points;
  counts.violations = row.violations();
  counts.no_sample = row.no_sample;
  counts.not_bounding = row.not_bounding;
  counts.rounded = row.rounded;
  counts.largest_px = row.largest_px;
  counts.largest_steps = row.largest_steps;
  out.counts = counts;
  return out;
}

Study offsets_study() {
  return {.name = "offsets",
          .title = "Boxes, exact offsets and intervals",
          .question =
              "What do the three ways to bound a fattened triangle in a pixel (the box around it, "
              "the Minkowski sum itself, the interval of its depths) keep, and at what cost?",
          .grid = offsets_grid,
          .measure = measure_offsets};
}

Study precision_study() {
  return {.name = "precision",
          .title = "Bounds on depth, as depth buffers hold them",
          .question =
              "Do samples bound the depth of every point, in a buffer of 24 bits and of 32, "
              "when the rasterizer interpolates depth and when a fragment program computes "
              "it, at any resolution and depth of the scene?",
          .grid = precision_grid,
          .measure = [](const Point& point, MeasurementContext& lab) {
            return measure_lemma(std::get<LemmaPoint>(point), lab);
          }};
}

Study radius_study() {
  return {.name = "radius",
          .title = "Violations and misses against the radius",
          .question =
              "How large must the ball be that fattens a primitive, so that no pixel lacks "
              "a sample or a bound, what happens below that, and how often does the published "
              "radius miss a pair?",
          .grid = radius_grid,
          .measure = measure_radius,
          .plain = true};
}

}  // namespace farcull
