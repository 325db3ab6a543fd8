// One generator of the lemma experiment on a device or on the worst canvas.
#include "experiments/studies/lemma_point.h"

#include <fmt/format.h>

#include <memory>

#include "core/base/stopwatch.h"
#include "experiments/lemma/lemma.h"
#include "offsets/obb.h"
#include "verify/worst_canvas.h"

namespace farcull {
namespace {

LemmaSettings settings_of(const LemmaPoint& point) {
  LemmaSettings settings;
  settings.points = point.points * lemma_generators().size();
  settings.generator = point.generator;
  settings.seed = point.seed;
  settings.displace = point.worst;
  settings.stored = point.depth_mode == DepthMode::fixed || point.depth_format.has_value();
  settings.side = point.side;
  settings.depth = point.depth / 2;
  return settings;
}

}  // namespace

PointResult measure_lemma(const LemmaPoint& point, Lab& lab) {
  const bool fixed = point.depth_mode == DepthMode::fixed;
  const Fattener fattener = fixed ? obb_surface_fattener() : obb_fattener();
  const bool bits24 = point.depth_format == DepthFormat::fixed24;
  PointResult out;
  LemmaCounts counts;
  // The rule of promises() in method/run.h for runs of FAR.
  counts.promises = !fixed && !point.radius.published && point.radius.factor >= 1;
  std::unique_ptr<WorstCanvas> worst;
  Canvas* canvas = nullptr;
  if (point.worst) {
    worst = std::make_unique<WorstCanvas>(fattener.solid,
                                          WorstCanvasOptions{.depth_bits = bits24 ? 24 : 32});
    canvas = worst.get();
    out.device = "cpu";
  } else {
    const bool native = lab.session().canvas_device().native;
    if (counts.promises && !native)
      counts.revoked = !lab.session().verdict(Reliance::drawing).holds;
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

}  // namespace farcull
