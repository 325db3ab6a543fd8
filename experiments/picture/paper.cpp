// One pixel, one triangle: its ball, its proxy, its solid, its depth interval. SVG elements are
// appended to a text. Coordinates have two decimals, so that a drawing is the same text on every
// machine.
#include "experiments/picture/paper.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/canvas/canvas.h"
#include "core/pairs/grid.h"
#include "core/view/budget.h"
#include "core/view/view.h"
#include "offsets/offsets.h"

namespace farcull {
namespace {

// Without "-0.00", which would depend on how zero was reached.
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

// A window of 8 x 8 px, one of its pixels a unit of the world, on a device with the coarsest grid
// that OpenGL allows (4 bits), so that all is large enough to be seen.
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

// A triangle that reaches with one corner, Q, into the pixel [0, 1] x [0, 1].
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

// How often a polygon winds around a point that lies on none of its edges.
int winding(const std::vector<DrawnPoint>& polygon, const DrawnPoint& p) {
  int out = 0;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const DrawnPoint &a = polygon[i], &b = polygon[(i + 1) % polygon.size()];
    if (a[1] <= p[1] && b[1] > p[1] && cross(a, b, p) > 0) ++out;
    if (b[1] <= p[1] && a[1] > p[1] && cross(a, b, p) < 0) --out;
  }
  return out;
}

// Points at which lines of sight in the plane y = 0.5 enter and leave a solid, by its kernel.
struct Followed {
  std::vector<DrawnPoint> near, far;

  std::vector<DrawnPoint> outline() const {
    std::vector<DrawnPoint> out = near;
    out.insert(out.end(), far.rbegin(), far.rend());
    return out;
  }
};
// The lines at x = i / per_px + shift with -5 <= x <= 4.
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
  // Inward, along the diagonals: what is worst for the corners' neighbourhood.
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
  // The triangle over the row: what its interval kernel finds between y = 0 and y = 1.
  interval::FarStrip strip;
  const auto corner = [&](int i) {
    return glsl::vec4{static_cast<float>(corners[i][0]), static_cast<float>(corners[i][1]),
                      static_cast<float>(corners[i][2]), 0};
  };
  interval::far_strip(corner(0), corner(1), corner(2), 0, 1, strip);
  for (int i = 0; i < strip.count; ++i) {
    const glsl::vec4& s = strip.segment[i];
    d.line({{s.x, s.y}, {s.z, s.w}}, R"(stroke="#234" stroke-width="2.5")");
  }
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

PaperFigure strip_figure() {
  const std::array<glsl::vec4, 3> t = {
      glsl::vec4{0.6f, 0.3f, 0.7f, 0}, {6.3f, 1.4f, 1.4f, 0}, {2.2f, 4.6f, 3.2f, 0}};
  const float x0 = 3, x1 = 4, y0 = 2, y1 = 3;
  interval::FarStrip strip;
  interval::far_strip(t[0], t[1], t[2], y0, y1, strip);
  float near = 0, far = 0;
  interval::far_depths(strip, x0, x1, near, far);
  Drawing d(
      720, 620, "A strip of the interval kernel",
      "Above, the image of a triangle and a row of pixels. Below, the part of the triangle in "
      "this row, seen along y: its boundary, and the depths over one pixel.");
  d.begin({10, 10, 700, 340, {0, 0}, {7, 3.4 / 7 * 10}});
  d.outline({{x0, y0}, {x1, y0}, {x1, y1}, {x0, y1}}, kPixel);
  d.pixels();
  d.outline({{t[0].x, t[0].y}, {t[1].x, t[1].y}, {t[2].x, t[2].y}},
            R"(fill="#9ab" fill-opacity="0.5" stroke="#234" stroke-width="2")");
  for (const double y : {y0, y1}) d.line({{0, y}, {7, y}}, R"(stroke="#07a" stroke-width="2.5")");
  d.words({0, y1}, 6, 18, "the strip: a row of pixels", "start", R"(fill="#07a")");
  d.words({x0, y0}, 6, -6, "X");
  d.words({7, 0}, -6, -8, "image: x to the right, y up", "end");
  d.begin({10, 370, 700, 240, {0, 0.6}, {7, 3}});
  for (int x = 0; x <= 7; ++x)
    d.line({{x * 1.0, 0.6}, {x * 1.0, 3}}, R"(stroke="#ccc" stroke-width="1")");
  d.outline({{x0, near}, {x1, near}, {x1, far}, {x0, far}}, kPixel);
  for (int i = 0; i < strip.count; ++i) {
    const glsl::vec4& s = strip.segment[i];
    d.line({{s.x, s.y}, {s.z, s.w}}, R"(stroke="#234" stroke-width="2.5")");
    d.dot({s.x, s.y}, 4, R"(fill="#234")");
    d.dot({s.z, s.w}, 4, R"(fill="#234")");
  }
  d.words({x1, far}, 8, -4, fmt::format("far = {:.3f}", far));
  d.words({x1, near}, 8, 14, fmt::format("near = {:.3f}", near));
  d.words({0, 3}, 6, 20, fmt::format("{} segments bound the strip", strip.count));
  d.words({7, 0.6}, -6, -8, "x to the right, depth up", "end");
  return {"paper-strip", d.svg()};
}

std::vector<PaperFigure> paper_figures(const std::string& pair) {
  return {ball_figure(),   coverage_figure(), entry_and_exit_figure(),
          passes_figure(), strip_figure(),    published_figure(pair)};
}

}  // namespace farcull
