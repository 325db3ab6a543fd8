// Line drawings as SVG text: panels with coordinates of their own, in which lines, outlines, points
// and words are put. Made for the figures of the paper (experiments/picture/paper.h).
#pragma once

#include <array>
#include <string>
#include <vector>

namespace farcull {

/// x to the right, y up, in the units of the panel.
using DrawnPoint = std::array<double, 2>;

/// A rectangle of the sheet, in sheet units from its upper left corner, that shows a part of the
/// plane. Both axes have the same scale if the two rectangles have the same proportions.
struct DrawingPanel {
  double left, top, width, height;  // on the sheet
  DrawnPoint lo, hi;                // what it shows
};

class Drawing {
 public:
  /// A white sheet of width x height units. Readers that show no pictures read title and
  /// description.
  Drawing(double width, double height, const std::string& title, const std::string& description);

  /// What follows is drawn in this panel; what is outside of it is cut off, words excepted.
  void begin(const DrawingPanel& panel);
  /// The lines between pixels, which lie at whole numbers, and the centres of the pixels.
  void pixels();
  /// `style`: SVG attributes such as stroke="#000".
  void line(const std::vector<DrawnPoint>& points, const std::string& style);
  void outline(const std::vector<DrawnPoint>& corners, const std::string& style);
  /// A circle whose radius is in units of the panel.
  void circle(const DrawnPoint& centre, double radius, const std::string& style);
  /// A dot whose radius is in units of the sheet.
  void dot(const DrawnPoint& at, double radius, const std::string& style);
  /// Words at a point of the panel, moved by (right, down) units of the sheet. anchor: start,
  /// middle or end.
  void words(const DrawnPoint& at, double right, double down, const std::string& text,
             const std::string& anchor = "start", const std::string& style = "");
  /// Units of the sheet for one unit of the panel, along x.
  double scale() const;

  std::string svg() const;

 private:
  DrawnPoint on_sheet(const DrawnPoint& p) const;
  std::string path(const std::vector<DrawnPoint>& points) const;

  std::string head_, body_;
  DrawingPanel panel_{0, 0, 1, 1, {0, 0}, {1, 1}};
  int panels_ = 0;
};

}  // namespace farcull
