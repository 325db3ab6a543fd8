// The figures of the paper (docs/reliability.md, docs/budget.md). Each is drawn from the results of
// the program's own functions: proxies, kernels, passes, budget. Only the scenes are typed in. The
// figures are line drawings as SVG text: panels with their own coordinates, with lines, outlines,
// points and words.
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
  /// A white sheet of width x height units. Readers that show no pictures read out title and
  /// description.
  Drawing(double width, double height, const std::string& title, const std::string& description);

  /// Draws in this panel from now on; clips everything but words at its borders.
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

struct PaperFigure {
  std::string name;  // of the file docs/figures/NAME.svg
  std::string svg;
};

/// The figures in the order of the paper. `pair`: the path of
/// tests/cases/published-far-loses-this-pair.obj, the input of the last one. Throws Error if it
/// cannot be read.
std::vector<PaperFigure> paper_figures(const std::string& pair);

// The single figures; those of the two passes come last.
PaperFigure ball_figure();
PaperFigure coverage_figure();
PaperFigure entry_and_exit_figure();
PaperFigure passes_figure();
PaperFigure published_figure(const std::string& pair);

}  // namespace farcull
