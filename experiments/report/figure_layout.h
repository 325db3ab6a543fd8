// Places of panels, labels and the key of a figure, decided here and not by the plotter.
#pragma once

#include <string>
#include <vector>

#include "experiments/report/axes.h"
#include "experiments/report/chapters/chapter.h"

namespace farcull {

/// Width of every figure in CSS pixels, and the size of its text: at the 170 mm that A4 leaves
/// between margins a pixel is 0.67 pt, so that the text has 8.7 pt.
constexpr int kFigureWidth = 720;
constexpr int kFigureText = 13;

/// px of a letter of kFigureText px, on average: names are drawn where they fit by this measure.
constexpr double kCharacter = 7.3;
constexpr double kLine = 19;  // px from line to line
/// In pixels from the top left corner.
struct PlotBox {
  double left = 0, right = 0, top = 0, bottom = 0;
};

struct PlacedPanel {
  Scale x, y;
  PlotBox box;
  bool x_label = true, y_label = true;
  double y_room = 0;  // from the axis to the middle of its label
};

struct Layout {
  std::vector<PlacedPanel> panels;
  double key_top = 0;
  std::size_t key_columns = 1;
  std::string note;  // below the key: how to read axes that show zeros; empty: there is none
  double note_top = 0;
  double height = 0;
};

/// The names of the key: of the series, then of the marks, each once.
std::vector<std::string> key_names(const Figure& figure);

/// For each series of a panel and each of its points, by how many px upwards it is drawn, so that
/// zeros of several series at the same place stand above each other: 3 px apart, less where that
/// would be more than 10 px in all. Only on an axis that has a part for zeros; all else is drawn
/// where it is.
std::vector<std::vector<double>> shifts_of(const Panel& panel, const PlacedPanel& placed);

/// How many panels stand side by side.
std::size_t columns_for(const Figure& figure);

/// Precondition: the figure has a panel.
Layout layout_of(const Figure& figure);

}  // namespace farcull
