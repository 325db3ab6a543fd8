// The two passes on a scene of twelve triangles, and the crossings that the published radius loses.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "core/base/error.h"
#include "core/cull/cull.h"
#include "core/native/canvas.h"
#include "core/view/clip.h"
#include "experiments/picture/drawing.h"
#include "experiments/picture/paper.h"
#include "experiments/scenes/mesh/scene_build.h"
#include "experiments/scenes/mesh/shapes.h"
#include "experiments/scenes/scene_file.h"
#include "offsets/fit.h"
#include "offsets/minkowski.h"
#include "offsets/obb.h"

namespace farcull {
namespace {

// Three objects, seen along y: x, depth of one end, x, depth of the other. Two pairs cross.
constexpr std::array<std::array<std::array<double, 4>, 4>, 3> kPassScene = {{
    {{{1, 4, 7, 5}, {10, 9, 16, 4}, {19, 4, 25, 5}, {28, 4, 35, 3}}},
    {{{1, 8, 7, 9}, {10, 4, 16, 9}, {19, 12, 25, 8}, {28, 15, 35, 16}}},
    {{{1, 13, 7, 12}, {10, 13, 16, 12}, {19, 8, 25, 12}, {28, 9, 35, 8}}},
}};

Scene pass_scene() {
  SceneBuilder scene("passes", "passes");
  for (std::size_t o = 0; o < kPassScene.size(); ++o) {
    std::vector<shapes::Corners> list;
    for (const auto& s : kPassScene[o])
      list.push_back({Vec3(s[0], -2, s[1]), Vec3(s[2], -2, s[3]),
                      Vec3(0.5 * (s[0] + s[2]), 2, 0.5 * (s[1] + s[3]))});
    scene.add(shapes::soup(list), std::string(1, static_cast<char>('A' + o)), Split::kNone, {});
  }
  return scene.finish();
}

struct Look {
  const char* colour;
  const char* meaning;
};
constexpr std::array<Look, 4> kLooks = {{{"#b30", "no bit"},
                                         {"#07a", "F: meets nothing earlier"},
                                         {"#283", "L: meets nothing later"},
                                         {"#bbb", "F and L: culled"}}};

void draw_bits(Drawing& d, double top, const std::string& heading,
               const std::vector<std::uint8_t>& bits) {
  d.begin({10, top, 700, 240, {0, 18}, {37, 1}});
  d.words({0, 1}, 4, 12, heading);
  std::size_t at = 0;
  for (std::size_t o = 0; o < kPassScene.size(); ++o) {
    for (const auto& s : kPassScene[o]) {
      const Look& look = kLooks.at(bits.at(at++));
      d.line({{s[0], s[1]}, {s[2], s[3]}},
             fmt::format(R"(stroke="{}" stroke-width="4")", look.colour));
      d.words({s[0], s[1]}, -4, 5, std::string(1, static_cast<char>('A' + o)), "end",
              fmt::format(R"(fill="{}")", look.colour));
    }
  }
}

// A proxy's corners as a device with 8 subpixel bits draws them.
constexpr double kGrid = 256;
std::vector<DrawnPoint> corners_of(const std::array<float, 8>& proxy, bool snapped) {
  std::vector<DrawnPoint> out;
  for (std::size_t i = 0; i < 8; i += 2) {
    const DrawnPoint p = {proxy[i], proxy[i + 1]};
    out.push_back(
        snapped ? DrawnPoint{std::rint(p[0] * kGrid) / kGrid, std::rint(p[1] * kGrid) / kGrid} : p);
  }
  return out;
}

// How far p is inside the convex polygon, which goes around counterclockwise: the least distance
// from the lines of its edges.
double inside(const std::vector<DrawnPoint>& polygon, const DrawnPoint& p) {
  double out = HUGE_VAL;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const DrawnPoint &a = polygon[i], &b = polygon[(i + 1) % polygon.size()];
    const double x = b[0] - a[0], y = b[1] - a[1];
    out = std::min(out, (x * (p[1] - a[1]) - y * (p[0] - a[0])) / std::hypot(x, y));
  }
  return out;
}

// Two crossing segments beside the corner of a pixel, in pixel space relative to that corner.
struct Crossing {
  std::array<Patch, 2> patches;
  Window window;
  double radius;

  std::vector<DrawnPoint> proxy(int which, double of_radius, bool snapped) const {
    return corners_of(proxy_rectangle(patches[which].points(), of_radius, proxy_bounds(window)),
                      snapped);
  }
  bool hit(int which, const DrawnPoint& c) const {
    const auto points = patches[which].points();
    float entry = 0, exit = 0;
    return minkowski_fattener().solid.interval(
        static_cast<float>(c[0]), static_cast<float>(c[1]),
        minkowski_solid(points[0], points[1], points[2], radius), entry, exit);
  }
};

// The third triangle of either object of the case, moved so that the whole numbers nearest to where
// they cross become the origin.
Crossing first_crossing(const std::string& path) {
  const std::filesystem::path file(path);
  const std::string text =
      "{\"objects\": [{\"mesh\": \"" + file.filename().string() + "\", \"split\": \"groups\"}]}";
  const Scene scene = parse_scene_file(text, (file.parent_path() / "scene.json").string());
  if (scene.objects.size() != 2 || scene.objects[0].triangle_count < 3)
    throw Error(path, "is not the case of the crossings", "restore the file");
  const Regions regions = find_regions(scene);
  const Window window = *fit_window(parse_view("z"), regions.places, 16);
  Crossing out{{}, window, published_radius(depth_step(window, 32))};
  for (int o = 0; o < 2; ++o) {
    std::array<Vec3, 3> corners = scene.corners(scene.objects[o].first_triangle + 2);
    const Vec3 q = 0.5 * (corners[0] + corners[1]);
    for (Vec3& p : corners) p -= Vec3(std::rint(q[0]), std::rint(q[1]), 0);
    out.patches[o] = clip_to_region(window, corners);
  }
  return out;
}

void draw_four_centres(Drawing& d, const Crossing& crossing) {
  d.begin({10, 40, 400, 400, {-1.25, -1.25}, {1.25, 1.25}});
  d.pixels();
  const std::array<const char*, 2> colours = {"#07a", "#b30"};
  const std::array<std::string, 2> names = {"rising", "falling"};
  double farthest = 0;
  d.outline(crossing.proxy(0, crossing.radius, true),
            R"(fill="#9ab" fill-opacity="0.3" stroke="#234" stroke-width="2")");
  for (const double y : {-0.5, 0.5}) {
    for (const double x : {-0.5, 0.5}) {
      const DrawnPoint c = {x, y};
      d.dot(c, 5, R"(fill="#fff" stroke="#000" stroke-width="2")");
      for (int o = 0; o < 2; ++o) {
        farthest =
            std::max(farthest, std::abs(inside(crossing.proxy(o, crossing.radius, true), c)));
        const double down = (y > 0 ? -24 : 18) + 18 * o;
        d.words(c, x > 0 ? 12 : -12, down, names[o] + (crossing.hit(o, c) ? ": hit" : ": miss"),
                x > 0 ? "start" : "end", fmt::format(R"(fill="{}" font-size="13")", colours[o]));
      }
    }
  }
  d.words({0, -1.25}, 0, -8,
          fmt::format("distance of the four centres from the edges: {}", farthest), "middle",
          R"(font-size="13")");
  const Vec3 q = 0.5 * (crossing.patches[0].corners[0] + crossing.patches[0].corners[1]);
  d.dot({q[0], q[1]}, 3, R"(fill="#000")");
  d.words({0, 0}, 8, -6, "Q");
}

void draw_edges(Drawing& d, const Crossing& crossing) {
  constexpr double kReach = 0.012;
  const Budget budget = budget_for({.subpixel_bits = 8, .depth_bits = 32, .max_resolution = 4096},
                                   viewport_side(crossing.window.width));
  d.begin({430, 40, 400, 400, {0.5 - kReach, 0.5 - kReach}, {0.5 + kReach, 0.5 + kReach}});
  d.outline(crossing.proxy(0, crossing.radius, true),
            R"(fill="#9ab" fill-opacity="0.3" stroke="#234" stroke-width="4")");
  d.outline(crossing.proxy(0, crossing.radius, false),
            R"(fill="none" stroke="#07a" stroke-width="2" stroke-dasharray="6 4")");
  d.outline(crossing.proxy(1, crossing.radius, false),
            R"(fill="none" stroke="#b30" stroke-width="2" stroke-dasharray="2 4")");
  d.outline(crossing.proxy(0, budget.radius(), true),
            R"(fill="none" stroke="#283" stroke-width="2.5")");
  d.dot({0.5, 0.5}, 5, R"(fill="#fff" stroke="#000" stroke-width="2")");
  d.words({0.5, 0.5}, -10, 18, "c", "end");
  const DrawnPoint corner = {0.5 - kReach, 0.5 - kReach};
  const auto legend = [&](double down, const std::string& text, const char* colour) {
    d.words(corner, 6, down, text, "start", fmt::format(R"(fill="{}" font-size="13")", colour));
  };
  legend(-70, "rising, published radius, as computed", "#07a");
  legend(-50, "falling, the same", "#b30");
  legend(-30, "both, snapped to 2^-8 px: c is on the edge", "#234");
  legend(-10, "rising, radius of the budget, snapped", "#283");
}

}  // namespace

PaperFigure passes_figure() {
  const Scene scene = pass_scene();
  CullSettings settings{
      .views = parse_views("z"), .resolution = 36, .fattener = obb_fattener(), .radius = {}};
  settings.least_objects = kFewObjects;
  std::vector<std::vector<std::uint8_t>> states;
  settings.watch = [&states](const CullStep& step) { states.push_back(step.bits); };
  NativeCanvas canvas(settings.fattener.mode, settings.fattener.solid, {.threads = 1});
  const CullResult result = cull(scene, find_regions(scene), settings, canvas);
  if (states.size() < 2) throw std::logic_error("passes_figure: fewer than two passes");
  Drawing d(720, 830, "The two passes",
            "Triangles of three objects A, B and C from the side. The first pass goes from A to C, "
            "the second from C to A. What crosses never gets both bits.");
  draw_bits(d, 10, "After the first pass: A, B, C", states[0]);
  draw_bits(d, 265, "After the second pass: C, B, A", states[1]);
  draw_bits(d, 520, fmt::format("At the end, after {} passes", states.size()), result.bits);
  d.begin({10, 770, 700, 50, {0, 0}, {700, 50}});
  for (std::size_t i = 0; i < kLooks.size(); ++i) {
    const double x = 30 + 340.0 * static_cast<double>(i % 2), y = i < 2 ? 34 : 12;
    d.line({{x - 24, y}, {x, y}}, fmt::format(R"(stroke="{}" stroke-width="4")", kLooks[i].colour));
    d.words({x, y}, 8, 5, kLooks[i].meaning);
  }
  return {"paper-passes", d.svg()};
}

PaperFigure published_figure(const std::string& crossings) {
  const Crossing crossing = first_crossing(crossings);
  Drawing d(
      840, 450, "Why the published radius fails",
      "Two segments cross 2^-11 px to the right of a pixel's corner. After snapping, all four "
      "centres lie on the edges of both proxies, and only the two on the right are hit by "
      "both.");
  d.begin({10, 0, 820, 40, {0, 0}, {820, 40}});
  d.words({0, 14}, 0, 0,
          fmt::format("radius {:.5f} px: four pixels around the corner", crossing.radius));
  d.words({420, 14}, 0, 0, "0.024 px around the upper right centre");
  draw_four_centres(d, crossing);
  draw_edges(d, crossing);
  return {"paper-published", d.svg()};
}

}  // namespace farcull
