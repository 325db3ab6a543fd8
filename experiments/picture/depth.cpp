// Runs one view alone, reads its stored depths back and draws them pixel by pixel, with the
// triangles that the view culls over them.
#include "experiments/picture/depth.h"

#include <fmt/format.h>

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <limits>

#include "core/base/error.h"
#include "core/view/regions.h"
#include "experiments/method/run.h"
#include "experiments/record/tables.h"
#include "experiments/system/text_table.h"

namespace farcull {
namespace {

constexpr Rgba kEmpty = {255, 255, 255}, kNear = {244, 244, 245}, kFar = {48, 52, 62},
               kBoth = {0, 112, 186}, kFirst = {232, 160, 32}, kSecond = {128, 92, 190};
constexpr double kOpacity = 0.4;  // the depth shows through

struct ViewRun {
  Window window;                         // of the canvas
  std::vector<float> depth;              // height rows from below, 1 where nothing is stored
  std::vector<std::uint32_t> triangles;  // that can take part
  Candidates found;
};

ViewRun look(RunOptions options, const std::string& view, const Scene& scene, Session& session) {
  options.views = view;
  options.depth_format = DepthFormat::float32;
  Plan planned = plan(scene, options);
  // The method's own offset alone, to the end, without clusters: the picture is about this view.
  auto& work = std::get<DrawPlan>(planned.work);
  work.settings.enough = 0;
  work.settings.clusters = {};
  if (work.fatteners.empty()) {
    throw Error(scene.name, "no triangle meets the box of another object: nothing is drawn",
                "leave --view-depth out, or give another scene or frame");
  }
  work.fatteners = {work.fatteners.back()};
  ViewRun out{.window = {},
              .depth = {},
              .triangles = work.regions.triangles,
              .found = find(scene, planned, session)};
  const ViewReport& report = out.found.views().front();
  if (!report.drawn) {
    throw Error(scene.name, "doubles cannot tell the pixels of this view apart: nothing is drawn",
                "leave --view-depth out, or look along another view");
  }
  out.window = *fit_window(parse_view(view), work.regions.places, work.settings.resolution);
  const Fattener& fattener = work.fatteners.front();
  Canvas& canvas = session.canvas(fattener, {.depth_format = options.depth_format,
                                             .query = query_of(options),
                                             .conservative = options.conservative});
  FattenCounts counts;
  const Drawables drawables =
      fatten(scene, out.triangles, out.window, fattener, report.radius_px, counts);
  canvas.begin(out.window, drawables);
  std::vector<Draw> draws;
  for (std::uint32_t e = 0; e < drawables.elements(); ++e) draws.push_back({e, 0});
  out.depth = canvas.depths(Verb::store, draws);
  return out;
}

// The canvas's pixels, each a square of `scale` px (a part of one where the panel is smaller), the
// nearest light, the farthest dark.
Image depth_image(const ViewRun& run, int width, int height, double scale, bool mirrored) {
  float nearest = 1, farthest = 0;
  for (const float d : run.depth) {
    if (d >= 1) continue;
    nearest = std::min(nearest, d);
    farthest = std::max(farthest, d);
  }
  const double range = farthest > nearest ? farthest - nearest : 1;
  Image out(width, height, kEmpty);
  const int w = run.window.width, h = run.window.height;
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      // From the middle, which is the middle of the canvas's window.
      const int dx = static_cast<int>(std::floor(0.5 * w + (x + 0.5 - 0.5 * width) / scale));
      const int j = static_cast<int>(std::floor(0.5 * h - (y + 0.5 - 0.5 * height) / scale));
      const int i = mirrored ? w - 1 - dx : dx;
      if (i < 0 || i >= w || j < 0 || j >= h) continue;
      const float d = run.depth[static_cast<std::size_t>(j) * w + i];
      if (d >= 1) continue;
      Rgba colour = kNear;
      blend(colour, kFar, (d - nearest) / range);
      out.at(x, y) = colour;
    }
  }
  return out;
}

// Explains the colours that the panel has.
void add_legend(DrawnPanel& panel, bool fattened) {
  const PanelResult& result = panel.result;
  const auto entry = [&](Rgba colour, const std::string& text) {
    panel.sheet.legend.push_back({.sign = LegendEntry::Sign::box, .colour = colour, .text = text});
  };
  panel.sheet.legend.push_back({.sign = LegendEntry::Sign::ramp,
                                .colour = kFar,
                                .text = fattened ? "depth of the fattened triangles, near to far"
                                                 : "depth of the triangles, near to far",
                                .light = kNear});
  entry(kBoth, fmt::format("fully visible in both passes, culled: {}", grouped(result.culled)));
  if (result.first_pass > 0)
    entry(kFirst, fmt::format("in the first pass alone: {}", grouped(result.first_pass)));
  if (result.second_pass > 0)
    entry(kSecond, fmt::format("in the second pass alone: {}", grouped(result.second_pass)));
  if (result.missed > 0) {
    entry(kMissedColour, "culled though they collide: " + counted(result.missed, "pair", "pairs"));
  }
  if (result.rings > 0) {
    panel.sheet.legend.push_back({.sign = LegendEntry::Sign::ring,
                                  .colour = kMissedColour,
                                  .text = "of these, easily overlooked"});
  }
}

}  // namespace

DrawnPanel depth_panel(const RunOptions& options, const PictureArguments& arguments,
                       const Scene& scene, const Truth& truth, Session& session,
                       const GlContext& context) {
  const View view = parse_view(*arguments.depth_view);
  const bool promised = promises(options) && session.verdict(Reliance::drawing).holds;
  const ViewRun run = look(options, *arguments.depth_view, scene, session);
  const std::vector<std::uint8_t>& bits = run.found.bits;

  const double fit = std::min(static_cast<double>(arguments.width) / run.window.width,
                              static_cast<double>(arguments.height) / run.window.height);
  const double scale = fit >= 1 ? std::floor(fit) : fit;
  // The canvas may look at the mirror image: its depth grows where an eye's would, its x may not.
  const bool mirrored = view.rows.determinant() > 0;
  Window window = run.window;
  if (mirrored) window.view.rows.row(0) *= -1;
  window.pixel_size = run.window.pixel_size / scale;
  window.map = window.view.rows / window.pixel_size;
  window.width = arguments.width;
  window.height = arguments.height;
  window.lo *= scale;
  window.hi *= scale;

  DrawnPanel panel;
  PanelResult& result = panel.result;
  result.title = panel_title(options) + ", along " + *arguments.depth_view;
  result.device = run.found.device.gl->renderer;
  result.colliding = truth.pairs.size();
  result.neighbours = result.colliding - without_neighbours(scene, truth).pairs.size();
  result.kept = run.found.triangles.size();
  std::vector<PictureTriangle> visible;
  for (const std::uint32_t t : run.triangles) {
    if (bits[t] == 0) continue;
    result.culled += bits[t] == 3;
    result.first_pass += bits[t] == 1;
    result.second_pass += bits[t] == 2;
    visible.push_back({.triangle = t,
                       .colour = bits[t] == 3   ? kBoth
                                 : bits[t] == 1 ? kFirst
                                                : kSecond,
                       .shaded = false});
  }
  std::vector<TrianglePair> missed;
  for (const TrianglePair& pair : truth.pairs) {
    if (bits[pair.a] == 3 || bits[pair.b] == 3) missed.push_back(pair);
  }
  const std::vector<std::uint32_t> lost = members_of(missed);
  result.missed = missed.size();
  result.missed_triangles = lost.size();
  result.broken = promised && !missed.empty();

  Image& image = panel.sheet.image;
  image = depth_image(run, window.width, window.height, scale, mirrored);
  lay_over(image, painted(context, scene, window, visible), kOpacity);
  result.rings = draw_missed(context, scene, window, lost, image);

  set_headline(panel, "this view loses");
  add_legend(panel, fattens(options.method));
  return panel;
}

}  // namespace farcull
