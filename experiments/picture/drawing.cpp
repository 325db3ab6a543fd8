// SVG elements are appended to a text. Coordinates have two decimals, so that a drawing is the same
// text on every machine.
#include "experiments/picture/drawing.h"

#include <fmt/format.h>

#include <cmath>

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

}  // namespace farcull
