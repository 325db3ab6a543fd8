// The two passes on a scene of twelve triangles, and the pair that FAR as published loses.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "core/base/error.h"
#include "core/cull/cull.h"
#include "core/native/canvas.h"
#include "core/view/view.h"
#include "experiments/picture/paper.h"
#include "experiments/scenes/mesh/scene_build.h"
#include "experiments/scenes/scene_file.h"
#include "offsets/offsets.h"

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
    scene.add(shapes::soup(list), std::string(1, static_cast<char>('A' + o)));
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

// The published path draws this of two triangles, in pixel space, where a corner of four pixels is
// the origin.
constexpr double kGrid = 256;  // of a device with 8 subpixel bits
struct Pair {
  std::array<Patch, 2> patches;
  Window window;
  double radius;

  // The triangles of the surface of the box around `which`, as computed or as the device draws
  // them.
  std::vector<std::vector<DrawnPoint>> surface(int which, double of_radius, bool snapped) const {
    Drawables drawn;
    obb_surface_fattener().fatten(patches[which], of_radius, proxy_bounds(window), drawn);
    const auto at = [&](double x) { return snapped ? std::rint(x * kGrid) / kGrid : x; };
    std::vector<std::vector<DrawnPoint>> out;
    for (const auto& t : drawn.triangles)
      out.push_back({{at(t[0]), at(t[1])}, {at(t[4]), at(t[5])}, {at(t[8]), at(t[9])}});
    return out;
  }
  // How far the centre c of a pixel is inside what is drawn of `which`, at the most.
  double inside(int which, const DrawnPoint& c) const {
    double out = -HUGE_VAL;
    for (const auto& t : surface(which, radius, true)) {
      double least = HUGE_VAL;
      const auto side = [&t](int i, const DrawnPoint& p) {
        const DrawnPoint &from = t[i], &to = t[(i + 1) % 3];
        const double x = to[0] - from[0], y = to[1] - from[1];
        return (x * (p[1] - from[1]) - y * (p[0] - from[0])) / std::hypot(x, y);
      };
      const double turn = side(0, t[2]);
      if (turn == 0 || std::isnan(turn)) continue;  // no area: draws nothing
      for (int i = 0; i < 3; ++i) least = std::min(least, std::copysign(1, turn) * side(i, c));
      out = std::max(out, least);
    }
    return out;
  }
};

Pair pair_of(const std::string& path) {
  const std::filesystem::path file(path);
  const std::string text =
      "{\"objects\": [{\"mesh\": \"" + file.filename().string() + "\", \"split\": \"groups\"}]}";
  const Scene scene = parse_scene_file(text, (file.parent_path() / "scene.json").string());
  if (scene.objects.size() != 2 || scene.triangles.size() != 2)
    throw Error(path, "is not the case of two triangles", "restore the file");
  const Window window = *fit_window(parse_view("z"), find_regions(scene).places, 2);
  Pair out{{}, window, published_radius(depth_step(window, 32))};
  for (int o = 0; o < 2; ++o) out.patches[o] = clip_to_region(window, scene.corners(o));
  return out;
}

constexpr std::array<const char*, 2> kPairColours = {"#07a", "#b30"};
constexpr std::array<const char*, 2> kPairNames = {"rising", "falling"};
// Words over lines.
constexpr const char* kHalo =
    R"(fill="{}" font-size="13" stroke="#fff" stroke-width="4" paint-order="stroke")";

void draw_four_centres(Drawing& d, const Pair& pair) {
  d.begin({10, 40, 400, 400, {-2.3, -2.3}, {2.3, 2.3}});
  d.pixels();
  for (int o = 0; o < 2; ++o) {
    const std::string colour = kPairColours[o];
    for (const auto& t : pair.surface(o, pair.radius, true)) {
      d.outline(t, fmt::format(R"(fill="{0}" fill-opacity="0.08" stroke="{0}" stroke-width="0.7")",
                               colour));
    }
    const auto& corners = pair.patches[o].corners;
    d.line({{corners[0][0], corners[0][1]}, {corners[1][0], corners[1][1]}},
           fmt::format(R"(stroke="{}" stroke-width="3")", colour));
  }
  double least = HUGE_VAL;
  for (const double y : {-0.5, 0.5}) {
    for (const double x : {-0.5, 0.5}) {
      const DrawnPoint c = {x, y};
      d.dot(c, 5, R"(fill="#fff" stroke="#000" stroke-width="2")");
      for (int o = 0; o < 2; ++o) {
        const double in = pair.inside(o, c);
        if (in < 0) least = std::min(least, -in);
        const double down = (y > 0 ? -24 : 18) + 18 * o;
        d.words(c, x > 0 ? 12 : -12, down,
                kPairNames[o] + std::string(in >= 0 ? ": hit" : ": miss"), x > 0 ? "start" : "end",
                fmt::format(kHalo, kPairColours[o]));
      }
    }
  }
  d.words({0, -2.3}, 0, -6, fmt::format("least miss: {:.5f} px", least), "middle",
          R"(font-size="13")");
}

void draw_edges(Drawing& d, const Pair& pair) {
  constexpr double kReach = 0.012;
  const Budget budget = budget_for({.subpixel_bits = 8, .depth_bits = 32, .max_resolution = 4096},
                                   viewport_side(std::max(pair.window.width, pair.window.height)));
  d.begin({430, 40, 400, 400, {-0.5 - kReach, 0.5 - kReach}, {-0.5 + kReach, 0.5 + kReach}});
  const auto draw = [&](double radius, bool snapped, const std::string& style) {
    for (const auto& t : pair.surface(0, radius, snapped)) d.outline(t, "fill=\"none\" " + style);
  };
  draw(pair.radius, true, R"(stroke="#07a" stroke-width="4")");
  draw(pair.radius, false, R"(stroke="#000" stroke-width="1.5")");
  draw(budget.radius(), true, R"(stroke="#283" stroke-width="2.5")");
  d.dot({-0.5, 0.5}, 5, R"(fill="#fff" stroke="#000" stroke-width="2")");
  d.words({-0.5, 0.5}, -10, -10, "c", "end");
  const DrawnPoint corner = {-0.5 + kReach, 0.5 - kReach};
  const auto legend = [&](double down, const std::string& text, const char* colour) {
    d.words(corner, -6, down, text, "end", fmt::format(R"(fill="{}" font-size="13")", colour));
  };
  legend(-50, "rising, radius of the budget, snapped", "#283");
  legend(-30, "published radius, as computed: c is inside", "#000");
  legend(-10, "the same, snapped to 2^-8 px: c is outside", "#07a");
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

PaperFigure published_figure(const std::string& pair_file) {
  const Pair pair = pair_of(pair_file);
  Drawing d(840, 450, "Why the published radius fails",
            "Two triangles that pierce each other, seen edge-on, and the boxes that are drawn for "
            "them. After snapping, each box misses two of the four centres around the corner where "
            "they meet, and no centre is in both.");
  d.begin({10, 0, 820, 40, {0, 0}, {820, 40}});
  d.words({0, 14}, 0, 0, fmt::format("radius {:.5f} px: the boxes as drawn", pair.radius));
  d.words({420, 14}, 0, 0, "0.024 px around the upper left centre");
  draw_four_centres(d, pair);
  draw_edges(d, pair);
  return {"paper-published", d.svg()};
}

}  // namespace farcull
