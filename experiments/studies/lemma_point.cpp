#include "experiments/studies/lemma_point.h"

#include <fmt/format.h>

#include <charconv>
#include <memory>
#include <stdexcept>

#include "core/stopwatch.h"
#include "core/view.h"
#include "experiments/lemma.h"
#include "offsets/exact.h"
#include "offsets/obb.h"
#include "verify/worst_canvas.h"

namespace farcull {
namespace {

Fattener drawn_as(const Point& point) {
  if (point.depth_mode == "fixed") return obb_surface_fattener();
  return point.offset == "exact" ? exact_fattener() : obb_fattener();
}

// As promises() of run.h says of FAR's own runs.
bool promises_of(const Point& point, const RadiusRule& rule) {
  return point.depth_mode == "fragment" && !rule.published && rule.factor >= 1;
}

template <class Number>
Number number(const std::string& text) {
  Number value{};
  const auto [end, code] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (code != std::errc() || end != text.data() + text.size())
    throw std::logic_error("parse_lemma_scene: " + text);
  return value;
}

}  // namespace

std::string LemmaScene::name() const {
  return fmt::format("lemma:{}:{}:{}", generator, points, depth);
}

LemmaScene parse_lemma_scene(const std::string& text) {
  const std::vector<std::string> words = split_list(text, ':');
  if (words.size() != 4 || words[0] != "lemma")
    throw std::logic_error("parse_lemma_scene: " + text);
  return {words[1], number<std::uint64_t>(words[2]), number<double>(words[3])};
}

Measurement measure_lemma(const Point& point, Lab& lab) {
  const LemmaScene scene = parse_lemma_scene(point.scene);
  const Fattener fattener = drawn_as(point);
  const bool worst = point.method == "lemma-worst";
  const bool bits24 = point.depth_format == "fixed24";
  const RadiusRule rule = parse_radius(point.radius.empty() ? "budget" : point.radius);

  Measurement out;
  bool promised = promises_of(point, rule);
  std::unique_ptr<WorstCanvas> made;
  Canvas* canvas = nullptr;
  if (worst) {
    made = std::make_unique<WorstCanvas>(fattener.solid,
                                         WorstCanvasOptions{.depth_bits = bits24 ? 24 : 32});
    canvas = made.get();
    out.device = "cpu";
  } else {
    if (promised) promised = lab.session().verdict(Reliance::drawing).holds;
    canvas = &lab.session().canvas(
        fattener, {.depth_format = bits24 ? DepthFormat::fixed24 : DepthFormat::float32,
                   .query = bits24 ? QueryMode::occlusion : QueryMode::flags});
    out.device = lab.session().context().info().renderer;
  }
  if (point.resolution > canvas->limits().max_resolution) {
    out.left_out = fmt::format("{} px are beyond the device's {}", point.resolution,
                               canvas->limits().max_resolution);
    return out;
  }

  double budget_px = 0, radius_px = 0, step_px = 0;
  LemmaSettings settings;
  settings.points = scene.points * lemma_generators().size();
  settings.generator = scene.generator;
  settings.seed = point.seed;
  settings.displace = worst;
  settings.stored = point.depth_mode == "fixed" || !point.depth_format.empty();
  settings.side = point.resolution;
  settings.depth = scene.depth / 2;
  settings.radius = [&](const Budget& budget, double step) {
    step_px = step;
    budget_px = budget.radius();
    radius_px = rule.published ? published_radius(step) : rule.factor * budget_px;
    return radius_px;
  };
  const Stopwatch watch;
  const LemmaRow row = lemma_experiment(*canvas, fattener, settings, lab.progress()).front();
  out.times = {{"total", watch.ms()}};
  out.counts = {{"points", row.points},
                {"violations", row.violations()},
                {"no_sample", row.no_sample},
                {"not_bounding", row.not_bounding},
                {"rounded", row.rounded},
                {"largest_px", row.largest_px},
                {"largest_steps", row.largest_steps},
                {"step_px", step_px},
                {"radius_px", radius_px},
                {"budget_px", budget_px},
                {"promises", promised}};
  return out;
}

}  // namespace farcull
