// Draws the figures of the paper: a triangle at a pixel, its proxy, solid and depth interval, and
// the two passes. Appends SVG elements to a text. Coordinates have two decimals, so that a drawing
// is the same text on every machine.
#include "experiments/picture/paper.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "core/base/error.h"
#include "core/canvas/canvas.h"
#include "core/cull/cull.h"
#include "core/native/canvas.h"
#include "core/view/budget.h"
#include "core/view/view.h"
#include "experiments/scenes/mesh/scene_build.h"
#include "experiments/scenes/scene_file.h"
#include "offsets/offsets.h"

namespace farcull {
namespace {

// Never returns "-0.00", whose sign would depend on how zero was computed.
std::string number(double x) {
  const std::string text = fmt::format("{:.2f}", x);
  return text == "-0.00" ? "0.00" : text;
}

std::string escaped(const std::string& text) {
  std::string out;
  for (const char c : text) {
    if (c == '<') {
      out += "&lt;";
    } else if (c == '>') {
      out += "&gt;";
    } else if (c == '&') {
      out += "&amp;";
    } else {
      out += c;
    }
  }
  return out;
}

}  // namespace

Drawing::Drawing(double width, double height, const std::string& title,
                 const std::string& description)
    : head_(fmt::format(
          "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {0} {1}\" width=\"{0}\" "
          "height=\"{1}\" font-family=\"DejaVu Sans, Helvetica, Arial, sans-serif\" "
          "font-size=\"15\" role=\"img\">\n<title>{2}</title>\n<desc>{3}</desc>\n"
          "<rect width=\"{0}\" height=\"{1}\" fill=\"#fff\"/>\n",
          width, height, escaped(title), escaped(description))) {}

DrawnPoint Drawing::on_sheet(const DrawnPoint& p) const {
  return {panel_.left + (p[0] - panel_.lo[0]) / (panel_.hi[0] - panel_.lo[0]) * panel_.width,
          panel_.top + (panel_.hi[1] - p[1]) / (panel_.hi[1] - panel_.lo[1]) * panel_.height};
}

double Drawing::scale() const { return panel_.width / (panel_.hi[0] - panel_.lo[0]); }

std::string Drawing::path(const std::vector<DrawnPoint>& points) const {
  std::string out;
  for (const DrawnPoint& p : points) {
    const DrawnPoint q = on_sheet(p);
    out += (out.empty() ? "" : " ") + number(q[0]) + "," + number(q[1]);
  }
  return out;
}

void Drawing::begin(const DrawingPanel& panel) {
  panel_ = panel;
  ++panels_;
  body_ += fmt::format(
      "<clipPath id=\"panel{}\"><rect x=\"{}\" y=\"{}\" width=\"{}\" height=\"{}\"/></clipPath>\n",
      panels_, number(panel.left), number(panel.top), number(panel.width), number(panel.height));
}

void Drawing::pixels() {
  const auto first = [this](std::size_t axis, double shift) {
    return static_cast<int>(std::ceil(panel_.lo[axis] - shift));
  };
  for (std::size_t axis = 0; axis < 2; ++axis) {
    for (int i = first(axis, 0); i <= panel_.hi[axis]; ++i) {
      const double at = i;
      DrawnPoint from = panel_.lo, to = panel_.hi;
      from[axis] = to[axis] = at;
      line({from, to}, R"(stroke="#ccc" stroke-width="1")");
    }
  }
  for (int j = first(1, 0.5); j + 0.5 <= panel_.hi[1]; ++j)
    for (int i = first(0, 0.5); i + 0.5 <= panel_.hi[0]; ++i)
      dot({i + 0.5, j + 0.5}, 2, R"(fill="#999")");
}

void Drawing::line(const std::vector<DrawnPoint>& points, const std::string& style) {
  body_ += fmt::format("<polyline clip-path=\"url(#panel{})\" points=\"{}\" fill=\"none\" {}/>\n",
                       panels_, path(points), style);
}

void Drawing::outline(const std::vector<DrawnPoint>& corners, const std::string& style) {
  body_ += fmt::format("<polygon clip-path=\"url(#panel{})\" points=\"{}\" {}/>\n", panels_,
                       path(corners), style);
}

void Drawing::circle(const DrawnPoint& centre, double radius, const std::string& style) {
  dot(centre, radius * scale(), style);
}

void Drawing::dot(const DrawnPoint& at, double radius, const std::string& style) {
  const DrawnPoint p = on_sheet(at);
  body_ += fmt::format("<circle clip-path=\"url(#panel{})\" cx=\"{}\" cy=\"{}\" r=\"{}\" {}/>\n",
                       panels_, number(p[0]), number(p[1]), number(radius), style);
}

void Drawing::words(const DrawnPoint& at, double right, double down, const std::string& text,
                    const std::string& anchor, const std::string& style) {
  const DrawnPoint p = on_sheet(at);
  body_ += fmt::format("<text x=\"{}\" y=\"{}\" text-anchor=\"{}\" {}>{}</text>\n",
                       number(p[0] + right), number(p[1] + down), anchor, style, escaped(text));
}

std::string Drawing::svg() const { return head_ + body_ + "</svg>\n"; }

namespace {

constexpr const char* kThin = R"(stroke="#000" stroke-width="1.5")";
constexpr const char* kTriangle = R"(fill="#9ab" stroke="#234" stroke-width="2")";
constexpr const char* kProxy = R"(fill="none" stroke="#b30" stroke-width="2")";
constexpr const char* kExact =
    R"(fill="none" stroke="#b30" stroke-width="1.5" stroke-dasharray="6 4")";
constexpr const char* kPixel = R"(fill="#fe9" stroke="#a80" stroke-width="2")";
const std::vector<DrawnPoint> kPixelCorners = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};

// A window of 8 x 8 px, with pixels of one world unit, on a device with the coarsest grid that
// OpenGL allows (4 bits), so that everything is large enough to see.
struct Scenery {
  Window window;
  Budget budget;
  double wander;  // how far a corner of a proxy may move: input, vertex and snap

  Scenery() {
    const Box region{Vec3(-4, -4, -4), Vec3(4, 4, 4)};
    window = *fit_window(parse_view("z"), std::vector<Box>{region}, 8);
    const RasterLimits coarse{.subpixel_bits = 4, .depth_bits = 32, .max_resolution = 4096};
    budget = budget_for(coarse, viewport_side(std::max(window.width, window.height)));
    wander = budget.input + budget.vertex + budget.snap;
  }
  std::vector<DrawnPoint> proxy_of(const std::array<Vec3, 3>& corners) const {
    const Patch patch = clip_to_region(window, corners);
    const std::array<float, 8> p =
        proxy_rectangle(patch.points(), budget.radius(), proxy_bounds(window));
    return {{p[0], p[1]}, {p[2], p[3]}, {p[4], p[5]}, {p[6], p[7]}};
  }
};

// A triangle whose corner Q reaches into the pixel [0, 1] x [0, 1].
const std::array<Vec3, 3> kReaching = {Vec3(0.05, 0.03, 0), Vec3(-2.6, -0.5, 1),
                                       Vec3(-1.2, -1.9, 2)};

std::vector<DrawnPoint> image_of(const std::array<Vec3, 3>& corners) {
  std::vector<DrawnPoint> out;
  for (const Vec3& p : corners) out.push_back({p[0], p[1]});
  return out;
}

double cross(const DrawnPoint& a, const DrawnPoint& b, const DrawnPoint& p) {
  return (b[0] - a[0]) * (p[1] - a[1]) - (b[1] - a[1]) * (p[0] - a[0]);
}

// The winding number of a polygon around a point that is on none of its edges.
int winding(const std::vector<DrawnPoint>& polygon, const DrawnPoint& p) {
  int out = 0;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const DrawnPoint &a = polygon[i], &b = polygon[(i + 1) % polygon.size()];
    if (a[1] <= p[1] && b[1] > p[1] && cross(a, b, p) > 0) ++out;
    if (b[1] <= p[1] && a[1] > p[1] && cross(a, b, p) < 0) --out;
  }
  return out;
}

// Points where lines of sight in the plane y = 0.5 enter and leave a solid, computed by its kernel.
struct Followed {
  std::vector<DrawnPoint> near, far;

  std::vector<DrawnPoint> outline() const {
    std::vector<DrawnPoint> out = near;
    out.insert(out.end(), far.rbegin(), far.rend());
    return out;
  }
};
// Follows the lines at x = i / per_px + shift with -5 <= x <= 4.
Followed follow(const SolidProgram& by, const Solid& solid, int per_px, float shift) {
  Followed out;
  for (int i = -5 * per_px; i <= 4 * per_px; ++i) {
    const float x = static_cast<float>(i) / static_cast<float>(per_px) + shift;
    float entry = 0, exit = 0;
    if (x > 4 || !by.interval(x, 0.5f, solid, entry, exit)) continue;
    out.near.push_back({x, entry});
    out.far.push_back({x, exit});
  }
  return out;
}

}  // namespace

PaperFigure ball_figure() {
  const Scenery on;
  Drawing d(720, 500, "The ball and the pixel",
            "A triangle reaches into a pixel but not to its centre. Fattened by the radius of the "
            "budget it contains the centre.");
  d.begin({10, 10, 700, 480, {-4.6, -3.2}, {2.4, 1.6}});
  d.outline(kPixelCorners, kPixel);
  d.pixels();
  const double r = on.budget.radius();
  // An outline with round joins is the image fattened by a disc.
  d.outline(
      image_of(kReaching),
      fmt::format(R"(fill="#9ab" stroke="#9ab" stroke-width="{:.2f}" stroke-linejoin="round" )"
                  R"(opacity="0.35")",
                  2 * r * d.scale()));
  d.outline(image_of(kReaching), kTriangle);
  const std::vector<DrawnPoint> proxy = on.proxy_of(kReaching);
  d.outline(proxy, kProxy);
  const DrawnPoint q = {kReaching[0][0], kReaching[0][1]}, c = {0.5, 0.5};
  d.circle(q, r, R"(fill="none" stroke="#000" stroke-width="1.5" stroke-dasharray="5 4")");
  d.line({q, c}, kThin);
  d.dot(q, 4, R"(fill="#000")");
  d.dot(c, 5, R"(fill="#fff" stroke="#000" stroke-width="2")");
  d.words(q, -4, 20, "Q", "end");
  d.words(c, 9, 4, "c");
  d.words({1, 0}, -16, -8, "X");
  d.words({-1.35, -0.8}, 0, 0, "triangle", "middle");
  d.words({-4.5, 1.3}, 0, 20, fmt::format("dashed: ball of radius r = {:.4f} px", r));
  d.words({-3.2, -2.2}, 0, 0, "proxy", "end", R"(fill="#b30")");
  d.words({-4.5, 1.3}, 0, 0,
          fmt::format("|Q - c| = {:.4f} px", std::hypot(q[0] - 0.5, q[1] - 0.5)));
  return {"paper-ball", d.svg()};
}

PaperFigure coverage_figure() {
  const Scenery on;
  Drawing d(720, 500, "Coverage by winding",
            "Each corner of the proxy moves by at most the wander. The moved quadrilateral still "
            "winds once around the centre c. Its two triangles share that number.");
  d.begin({10, 10, 700, 480, {-4.6, -3.2}, {2.4, 1.6}});
  d.outline(kPixelCorners, kPixel);
  d.pixels();
  const std::vector<DrawnPoint> exact = on.proxy_of(kReaching);
  std::vector<DrawnPoint> moved = exact;
  // Moves each corner inward along its diagonal: the worst direction for the area near the corners.
  for (std::size_t i = 0; i < 4; ++i) {
    const DrawnPoint &p = exact[i], &over = exact[(i + 2) % 4];
    const double length = std::hypot(over[0] - p[0], over[1] - p[1]);
    for (int k = 0; k < 2; ++k) moved[i][k] += on.wander * (over[k] - p[k]) / length;
    d.circle(p, on.wander, R"(fill="#fdb" stroke="none")");
  }
  d.outline(exact, kExact);
  d.outline(moved, kProxy);
  d.line({moved[0], moved[2]}, R"(stroke="#b30" stroke-width="1.5" stroke-dasharray="2 4")");
  for (int j = -3; j < 2; ++j) {
    for (int i = -5; i < 2; ++i) {
      const double x = i + 0.5, y = j + 0.5;
      const int around = winding(moved, {x, y});
      d.words({x, y}, 6, -5, std::to_string(around), "start",
              around == 0 ? R"(fill="#888")" : R"(fill="#000" font-weight="bold")");
    }
  }
  const DrawnPoint c = {0.5, 0.5};
  d.dot(c, 5, R"(fill="#fff" stroke="#000" stroke-width="2")");
  d.words(c, -8, 16, "c", "end");
  const int first = winding({moved[0], moved[1], moved[2]}, c),
            second = winding({moved[0], moved[2], moved[3]}, c);
  d.words({-4.4, 1.3}, 0, 0,
          fmt::format("around c: {} = {} + {}", winding(moved, c), first, second));
  d.words({-4.4, 1.3}, 0, 20, fmt::format("wander w = {:.4f} px", on.wander));
  d.words({-1.7, 1.3}, 0, 0, "dashed: as computed", "start", R"(fill="#b30")");
  d.words({-1.7, 1.3}, 0, 20, "solid: as moved", "start", R"(fill="#b30")");
  return {"paper-coverage", d.svg()};
}

PaperFigure entry_and_exit_figure() {
  const Scenery on;
  const std::array<Vec3, 3> corners = {Vec3(-3.2, 0.1, -1.2), Vec3(2.2, 0.9, 1.6),
                                       Vec3(-0.6, 0.35, 0.9)};
  const double r = on.budget.radius();
  const Solid box = obb_of(corners, r),
              round = minkowski_solid(corners[0], corners[1], corners[2], r);
  const SolidProgram as_box = obb_fattener().solid, as_round = minkowski_fattener().solid;
  Drawing d(720, 490, "Entry and exit",
            "Along the line of sight through each pixel centre of a row, the part inside the "
            "fattened triangle, as the kernels compute it.");
  d.begin({10, 10, 700, 700 / 9.0 * 6, {-5, -3.2}, {4, 2.8}});
  for (int axis_x = -5; axis_x <= 4; ++axis_x) {
    const double x = axis_x;
    d.line({{x, -3.2}, {x, 2.8}}, R"(stroke="#ccc" stroke-width="1")");
  }
  // The outlines of both solids in the plane y = 0.5, from many lines of sight.
  const Followed around_box = follow(as_box, box, 64, 0), around = follow(as_round, round, 64, 0);
  d.outline(around_box.outline(),
            R"(fill="none" stroke="#07a" stroke-width="1.5" stroke-dasharray="6 4")");
  d.outline(around.outline(), R"(fill="#9ab" fill-opacity="0.4" stroke="#234" stroke-width="1.5")");
  const Followed centres = follow(as_round, round, 1, 0.5f);
  for (std::size_t i = 0; i < centres.near.size(); ++i) {
    d.line({centres.near[i], centres.far[i]}, R"(stroke="#b30" stroke-width="4")");
    d.dot(centres.near[i], 4, R"(fill="#b30")");
    d.dot(centres.far[i], 4, R"(fill="#b30")");
  }
  // The triangle in the plane y = 0.5: from edge to edge.
  std::vector<DrawnPoint> cut;
  for (int i = 0; i < 3; ++i) {
    const Vec3 &a = corners[i], &b = corners[(i + 1) % 3];
    const double t = (0.5 - a[1]) / (b[1] - a[1]);
    if (t >= 0 && t <= 1) cut.push_back({a[0] + t * (b[0] - a[0]), a[2] + t * (b[2] - a[2])});
  }
  d.line(cut, R"(stroke="#234" stroke-width="2.5")");
  // A point of the triangle in the pixel of the centre (0.5, 0.5).
  const Vec3 q = 0.2 * corners[0] + 0.62 * corners[1] + 0.18 * corners[2];
  d.dot({q[0], q[2]}, 4, R"(fill="#000")");
  d.words({q[0], q[2]}, 6, 18, "Q");
  float entry = 0, exit = 0;
  as_round.interval(0.5f, 0.5f, round, entry, exit);
  d.words({0.5, entry}, 6, 18, "entry", "start", R"(fill="#b30")");
  d.words({0.5, exit}, -6, -6, "exit", "end", R"(fill="#b30")");
  d.words({-4.9, 2.5}, 0, 0, "depth grows upward; thin lines: borders of pixels");
  d.words({3.9, -2.75}, 0, 0, "filled: triangle and ball; dashed: oriented box", "end");
  d.words({3.9, -3.05}, 0, 0, fmt::format("{:.3f} <= Q.z = {:.3f} <= {:.3f}", entry, q[2], exit),
          "end");
  return {"paper-entry-exit", d.svg()};
}

std::vector<PaperFigure> paper_figures(const std::string& pair) {
  return {ball_figure(), coverage_figure(), entry_and_exit_figure(), passes_figure(),
          published_figure(pair)};
}

// The two passes on a scene of twelve triangles, and the pair that FAR as published loses.

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

// Two triangles as the published path draws them, in pixel space: the origin is a corner shared by
// four pixels.
constexpr double kGrid = 256;  // of a device with 8 subpixel bits
struct Pair {
  std::array<Patch, 2> patches;
  Window window;
  double radius;

  // The triangles of the surface of the box around `which`: as computed, or `snapped` as on the
  // device.
  std::vector<std::vector<DrawnPoint>> surface(int which, double of_radius, bool snapped) const {
    Drawables drawn;
    obb_surface_fattener().fatten(patches[which], of_radius, proxy_bounds(window), drawn);
    const auto at = [&](double x) { return snapped ? std::rint(x * kGrid) / kGrid : x; };
    std::vector<std::vector<DrawnPoint>> out;
    for (const auto& t : drawn.triangles)
      out.push_back({{at(t[0]), at(t[1])}, {at(t[4]), at(t[5])}, {at(t[8]), at(t[9])}});
    return out;
  }
  // How deep the pixel centre c lies inside the triangle of `which` that it is deepest in, in px.
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
// The style of words that stand over lines.
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
