// Triangles painted over an image, rings around missed triangles, and the text above a panel.
#include "experiments/picture/panel.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "experiments/system/text_table.h"

namespace farcull {
namespace {

constexpr Rgba kGood = {0, 98, 84};
// A disc of diameter 2 sqrt(2) px contains a complete pixel, wherever its centre lies. Proof: the
// nearest pixel centre is at most half a pixel diagonal away. The corners of this pixel are another
// half diagonal away. A complete pixel has the unblended colour.
constexpr double kWholePixel = 2.83;

// Groups missed triangles that are close together in the picture.
class Clusters2d {
 public:
  using Cell = std::pair<long, long>;
  explicit Clusters2d(double reach) : reach_(reach) {}

  void add(double x, double y, double radius) {
    Group& group = cells_[{std::lround(x / reach_), std::lround(y / reach_)}];
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

  // Removes and returns the groups. Adjacent cells, also diagonally, are in the same group.
  std::vector<Group> take_groups() {
    std::vector<Group> out;
    while (!cells_.empty()) {
      Group& all = out.emplace_back();
      std::vector<Cell> open = {cells_.begin()->first};
      while (!open.empty()) {
        const auto found = cells_.find(open.back());
        open.pop_back();
        if (found == cells_.end()) continue;
        const auto [x, y] = found->first;
        all.add(found->second);
        cells_.erase(found);
        for (const long dx : {-1, 0, 1}) {
          for (const long dy : {-1, 0, 1}) open.emplace_back(x + dx, y + dy);
        }
      }
    }
    return out;
  }

 private:
  double reach_;  // side length of a cell in px
  std::map<Cell, Group> cells_;
};

}  // namespace

double line_of(const Window& window) {
  return std::clamp(std::min(window.width, window.height) / 380.0, 1.0, 8.0);
}

Image painted(const GlContext& context, const Scene& scene, const Window& window,
              const std::vector<PictureTriangle>& triangles) {
  const int larger = std::max(window.width, window.height);
  return draw_picture(context, scene, window, triangles,
                      larger <= 1200   ? 4
                      : larger <= 2400 ? 3
                                       : 2);
}

std::uint64_t draw_missed(const GlContext& context, const Scene& scene, const Window& window,
                          const std::vector<std::uint32_t>& missed, Image& image) {
  if (missed.empty()) return 0;
  const double line = line_of(window);
  std::vector<PictureTriangle> over;
  // Side of the square cells that group missed triangles, px. Each small group gets a ring.
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
  for (const Clusters2d::Group& group : clusters.take_groups()) {
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

std::string headline_of(const PanelResult& result) {
  std::string out = fmt::format("missed {} of {}", grouped(result.missed),
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

}  // namespace farcull
