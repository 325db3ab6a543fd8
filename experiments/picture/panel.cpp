// Parts of every panel: triangles painted over an image, missed triangles with rings around them,
// and the text above a panel. The panel of --view-depth runs only one view, reads its stored depths
// back and draws them pixel by pixel, with the triangles that the view culls over them.
#include "experiments/picture/panel.h"

#include <fmt/format.h>

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <map>

#include "core/base/error.h"
#include "core/view/regions.h"
#include "experiments/method/run.h"
#include "experiments/record/tables.h"
#include "experiments/system/text_table.h"

namespace farcull {
namespace {

constexpr Rgba kGood = {0, 98, 84};
// A disc of diameter 2 sqrt(2) px contains a whole pixel wherever it lies: the middle of the disc
// is at most half a diagonal from the middle of a pixel, and the pixel's corners are another half
// from there. So one pixel has the pure colour.
constexpr double kWholePixel = 2.83;

// Groups missed triangles that are close together in the picture.
class Clusters2d {
 public:
  explicit Clusters2d(double reach) : reach_(reach) {}

  void add(double x, double y, double radius) {
    const std::pair cell(std::lround(x / reach_), std::lround(y / reach_));
    Group& group = cells_[cell];
    group.add(x - radius, y - radius);
    group.add(x + radius, y + radius);
  }

  struct Group {
    double x0 = HUGE_VAL, y0 = HUGE_VAL, x1 = -HUGE_VAL, y1 = -HUGE_VAL;
    void add(double x, double y) {
      x0 = std::min(x0, x), y0 = std::min(y0, y), x1 = std::max(x1, x), y1 = std::max(y1, y);
    }
    void add(const Group& other) {
      add(other.x0, other.y0);
      add(other.x1, other.y1);
    }
  };

  // Cells that touch, also at corners, form one group.
  std::vector<Group> groups() const {
    std::vector<Group> out;
    std::map<std::pair<long, long>, bool> done;
    for (const auto& [cell, group] : cells_) {
      if (done[cell]) continue;
      done[cell] = true;
      Group all = group;
      std::vector<std::pair<long, long>> open = {cell};
      while (!open.empty()) {
        const auto [cx, cy] = open.back();
        open.pop_back();
        for (long dx = -1; dx <= 1; ++dx) {
          for (long dy = -1; dy <= 1; ++dy) {
            const auto next = cells_.find({cx + dx, cy + dy});
            if (next == cells_.end() || done[next->first]) continue;
            done[next->first] = true;
            all.add(next->second);
            open.push_back(next->first);
          }
        }
      }
      out.push_back(all);
    }
    return out;
  }

 private:
  double reach_;
  std::map<std::pair<long, long>, Group> cells_;
};

}  // namespace

double line_of(const Window& window) {
  return std::clamp(std::min(window.width, window.height) / 380.0, 1.0, 8.0);
}

Image painted(const GlContext& context, const Scene& scene, const Window& window,
              const std::vector<PictureTriangle>& triangles) {
  const int larger = std::max(window.width, window.height);
  return draw_picture(context, scene, window, triangles,
                      {.samples = larger <= 1200   ? 4
                                  : larger <= 2400 ? 3
                                                   : 2});
}

std::uint64_t draw_missed(const GlContext& context, const Scene& scene, const Window& window,
                          const std::vector<std::uint32_t>& missed, Image& image) {
  if (missed.empty()) return 0;
  const double line = line_of(window);
  std::vector<PictureTriangle> over;
  // Misses farther apart than the width of a ring get their own rings.
  const double ring = 11 * line;
  Clusters2d clusters(ring);
  for (const std::uint32_t t : missed) {
    over.push_back({.triangle = t,
                    .colour = kMissedColour,
                    .shaded = false,
                    .outline = static_cast<float>(std::max(kWholePixel, 1.5 * line))});
    Box box = Box::empty();
    for (const Vec3& corner : scene.corners(t)) box.add(to_pixel(window, corner).p);
    const Vec3 middle = 0.5 * (box.lo + box.hi);
    if (!(std::abs(middle[0]) <= window.width) || !(std::abs(middle[1]) <= window.height)) continue;
    const double radius = 0.5 * (box.hi - box.lo).head<2>().maxCoeff();
    clusters.add(0.5 * window.width + middle[0], 0.5 * window.height - middle[1], radius);
  }
  lay_over(image, painted(context, scene, window, over), 1);
  std::uint64_t rings = 0;
  for (const Clusters2d::Group& group : clusters.groups()) {
    const double size = std::max(group.x1 - group.x0, group.y1 - group.y0);
    if (size > 2 * ring) continue;  // visible without a ring
    draw_ring(image, 0.5 * (group.x0 + group.x1), 0.5 * (group.y0 + group.y1),
              0.5 * size + 0.6 * ring, std::max(1.5, line), kMissedColour);
    ++rings;
  }
  return rings;
}

std::string method_title(const RunOptions& options) {
  std::string out = to_string(options.method);
  if (!fattens(options.method)) return out;
  if (options.offset != "obb") out += ", " + options.offset + " offset";
  const std::string radius = radius_text(options.radius);
  if (radius == "published") out += ", published radius";
  if (radius != "published" && radius != "budget") out += ", radius " + radius + " of the budget";
  if (depth_of(options) == DepthMode::fixed) out += ", fixed depth";
  return out;
}

std::string panel_title(const RunOptions& options) {
  std::string out = method_title(options);
  if (out != to_string(options.method)) out += ",";
  if (draws(options.method)) out += fmt::format(" at {} px", resolution_of(options));
  return out;
}

std::string headline_of(const PanelResult& result, const std::string& verb) {
  std::string out = fmt::format("{} {} of {}", verb, grouped(result.missed),
                                counted(result.colliding, "colliding pair", "colliding pairs"));
  if (result.neighbours > 0) {
    out += fmt::format(" = {} + {} of neighbours", grouped(result.colliding - result.neighbours),
                       grouped(result.neighbours));
  }
  return out;
}

void set_heading(DrawnPanel& panel) {
  panel.sheet.title = panel.result.title;
  panel.sheet.headline = panel.result.headline;
  panel.sheet.headline_colour = panel.result.missed > 0 ? kMissedColour : kGood;
}

void explain(DrawnPanel& panel, Rgba colour, const std::string& text) {
  panel.sheet.legend.push_back({.sign = LegendEntry::Sign::box, .colour = colour, .text = text});
}

void explain_rings(DrawnPanel& panel, const std::string& text) {
  if (panel.result.rings == 0) return;
  panel.sheet.legend.push_back(
      {.sign = LegendEntry::Sign::ring, .colour = kMissedColour, .text = text});
}

// ---- the panel of --view-depth ----

namespace {

constexpr Rgba kEmpty = {255, 255, 255}, kNear = {244, 244, 245}, kFar = {48, 52, 62},
               kBoth = {0, 112, 186}, kFirst = {232, 160, 32}, kSecond = {128, 92, 190};
constexpr double kOpacity = 0.4;  // of triangles over the depth

struct ViewRun {
  Window window;                         // of the canvas
  std::vector<float> depth;              // height rows from below; 1 if nothing is stored
  std::vector<std::uint32_t> triangles;  // that can take part
  Candidates found;
};

ViewRun look(RunOptions options, const std::string& view, const Scene& scene, Session& session) {
  options.views = view;
  options.depth_format = DepthFormat::float32;
  Plan planned = plan(scene, options);
  // Runs only the method's own offset, to the end, without clusters: the picture shows its depth.
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

// The canvas's pixels as squares of `scale` px (a fraction if the panel is smaller); the nearest is
// light, the farthest dark.
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
      // Counts from the middle of the image, which shows the middle of the canvas's window.
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

// Explains the colours in the panel.
void add_legend(DrawnPanel& panel, bool fattened) {
  const PanelResult& result = panel.result;
  panel.sheet.legend.push_back({.sign = LegendEntry::Sign::ramp,
                                .colour = kFar,
                                .text = fattened ? "depth of the fattened triangles, near to far"
                                                 : "depth of the triangles, near to far",
                                .light = kNear});
  explain(panel, kBoth, "fully visible in both passes, culled: " + grouped(result.culled));
  if (result.first_pass > 0)
    explain(panel, kFirst, "in the first pass alone: " + grouped(result.first_pass));
  if (result.second_pass > 0)
    explain(panel, kSecond, "in the second pass alone: " + grouped(result.second_pass));
  if (result.missed > 0) {
    explain(panel, kMissedColour,
            "culled though they collide: " + counted(result.missed, "pair", "pairs"));
  }
  explain_rings(panel, "of these, easily overlooked");
}

}  // namespace

DrawnPanel depth_panel(const RunOptions& options, const PictureArguments& arguments,
                       const Scene& scene, const Truth& truth, Session& session,
                       const GlContext& context) {
  const View view = parse_view(*arguments.depth_view);
  const bool promised = promises(options) && session.verdict().holds;
  const ViewRun run = look(options, *arguments.depth_view, scene, session);
  const std::vector<std::uint8_t>& bits = run.found.bits;

  const double fit = std::min(static_cast<double>(arguments.width) / run.window.width,
                              static_cast<double>(arguments.height) / run.window.height);
  const double scale = fit >= 1 ? std::floor(fit) : fit;
  // The canvas may show a mirror image: depth grows away from the eye, but x may be reversed.
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
  result.drew = true;
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
  std::ranges::set_difference(truth.pairs, run.found.pairs, std::back_inserter(missed));
  const std::vector<std::uint32_t> lost = members_of(missed);
  result.missed = missed.size();
  result.missed_triangles = lost.size();
  result.broken = promised && !missed.empty();

  Image& image = panel.sheet.image;
  image = depth_image(run, window.width, window.height, scale, mirrored);
  lay_over(image, painted(context, scene, window, visible), kOpacity);
  result.rings = draw_missed(context, scene, window, lost, image);

  result.headline = headline_of(result, "this view loses");
  set_heading(panel);
  add_legend(panel, fattens(options.method));
  return panel;
}

}  // namespace farcull
