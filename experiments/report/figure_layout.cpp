// Scales each panel, leaves room for the longest labels of a column, and puts the key below.
#include "experiments/report/figure_layout.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "experiments/report/style.h"

namespace farcull {
namespace {

double plot_height(std::size_t columns) { return columns == 1 ? 300 : columns == 2 ? 215 : 150; }

std::vector<double> values_along(const Panel& panel, bool horizontal) {
  std::vector<double> out;
  for (const Series& series : panel.series) {
    // A point that has no place on the other axis is still part of this one's range.
    const std::vector<double>& values = horizontal ? series.x : series.y;
    out.insert(out.end(), values.begin(), values.end());
    for (const auto* ends : horizontal ? std::array{&series.x_low, &series.x_high}
                                       : std::array{&series.y_low, &series.y_high})
      out.insert(out.end(), ends->begin(), ends->end());
  }
  for (const Mark& mark : panel.marks) {
    if (mark.vertical == horizontal) out.push_back(mark.at);
  }
  return out;
}

constexpr double kDrawingRoom = 10;  // px left of a drawing, and below it

// The scales of a drawing in its box: as many px for a unit of x as for one of y, the corners in
// the middle, and a tenth of the longer side free around them.
void fit_drawing(const Panel& panel, PlacedPanel& placed) {
  struct Range {
    double from = 0, to = 0;
  };
  const auto range = [&](bool horizontal) {
    std::optional<Range> out;
    for (const double value : values_along(panel, horizontal)) {
      if (!std::isfinite(value)) continue;
      if (!out) out = Range{value, value};
      out->from = std::min(out->from, value);
      out->to = std::max(out->to, value);
    }
    return out.value_or(Range{});
  };
  const Range x = range(true), y = range(false);
  const double wide = placed.box.right - placed.box.left, high = placed.box.bottom - placed.box.top;
  const double tight = std::max((x.to - x.from) / wide, (y.to - y.from) / high);
  // Corners that are all the same, or nearly, still have a range around them.
  const double size =
      std::max({std::abs(x.from), std::abs(x.to), std::abs(y.from), std::abs(y.to)});
  const double unit = std::max(1.1 * tight, size > 0 ? 1e-9 * size : 1);  // of the drawing, a px
  const auto scale = [unit](const Range& along, double px) {
    const double middle = along.from + (along.to - along.from) / 2;
    Scale out;
    out.from = middle - unit * px / 2;
    out.to = middle + unit * px / 2;
    return out;
  };
  placed.x = scale(x, wide);
  placed.y = scale(y, high);
}

// The scales of all panels, and the room for labels left of each column of panels.
std::vector<double> scale_panels(const Figure& figure, Layout& out) {
  const std::size_t count = figure.panels.size();
  const std::size_t columns = columns_for(figure);
  const double high = plot_height(columns);
  const double cell = static_cast<double>(kFigureWidth) / static_cast<double>(columns);
  // Labels that a panel shares with the first of its row, or the last of its column, stand there.
  const auto same = [&](auto label) {
    return std::all_of(figure.panels.begin(), figure.panels.end(), [&](const Panel& panel) {
      return label(panel) == label(figure.panels.front());
    });
  };
  const bool one_x = same([](const Panel& p) { return p.x.label; });
  const bool one_y = same([](const Panel& p) { return p.y.label; });

  std::vector<double> left(columns, 0);
  for (std::size_t i = 0; i < count; ++i) {
    const Panel& panel = figure.panels[i];
    PlacedPanel placed;
    if (panel.drawing) {
      placed.x_label = placed.y_label = false;
      left[i % columns] = std::max(left[i % columns], kDrawingRoom);
      out.panels.push_back(std::move(placed));
      continue;
    }
    const double wide = cell - 70;
    placed.x =
        scale_of(panel.x, values_along(panel, true), static_cast<std::size_t>(wide / kCharacter));
    placed.y = scale_of(panel.y, values_along(panel, false),
                        static_cast<std::size_t>(8 * high / (2.1 * kLine)));
    placed.x_label = !one_x || i + columns >= count;
    placed.y_label = !one_y || i % columns == 0;
    placed.y_room = kCharacter * static_cast<double>(placed.y.label_width()) + 17 + kLine / 2;
    left[i % columns] =
        std::max(left[i % columns], placed.y_room + (placed.y_label ? kLine / 2 : -kLine / 2) + 2);
    out.panels.push_back(std::move(placed));
  }
  return left;
}

// Lays the key below the panels, which end at `top`, and ends the figure below it.
void place_key(const Figure& figure, double top, Layout& out) {
  const std::vector<std::string> names = key_names(figure);
  std::size_t longest = 1;
  for (const std::string& name : names) longest = std::max(longest, characters(name));
  const double entry = 52 + kCharacter * static_cast<double>(longest);
  out.key_columns = std::clamp<std::size_t>(static_cast<std::size_t>((kFigureWidth - 20) / entry),
                                            1, std::max<std::size_t>(names.size(), 1));
  out.key_top = top + 4;
  if (!names.empty()) {
    const std::size_t lines = (names.size() + out.key_columns - 1) / out.key_columns;
    // As even as it goes: four and three rather than six and one.
    out.key_columns = (names.size() + lines - 1) / lines;
    top = out.key_top + kLine * static_cast<double>(lines) + 6;
  }
  if (std::any_of(out.panels.begin(), out.panels.end(),
                  [](const PlacedPanel& p) { return p.x.linear_to > 0 || p.y.linear_to > 0; })) {
    out.note =
        "Shaded: the axis is linear, from 0 to the end of the shade. Beyond, it is logarithmic.";
    out.note_top = top;
    top += kLine + 4;
  }
  out.height = std::ceil(top);
}

constexpr double kSamePlace = 1.5;  // px: points that are nearer hide each other
constexpr double kApart = 3;        // px from one to the next
constexpr double kAllApart = 10;    // px from the lowest to the highest, so that 0 stays near 0

}  // namespace

std::vector<std::string> key_names(const Figure& figure) {
  std::vector<std::string> out = series_names(figure);
  for (const Panel& panel : figure.panels) {
    for (const Mark& mark : panel.marks) {
      if (!mark.name.empty() && std::find(out.begin(), out.end(), mark.name) == out.end())
        out.push_back(mark.name);
    }
  }
  return out;
}

std::vector<std::vector<double>> shifts_of(const Panel& panel, const PlacedPanel& placed) {
  struct Point {
    std::size_t series, index;
    double x, y;  // px
  };
  std::vector<std::vector<double>> out;
  std::vector<Point> points;
  const double wide = placed.box.right - placed.box.left, high = placed.box.bottom - placed.box.top;
  for (std::size_t s = 0; s < panel.series.size(); ++s) {
    const Series& series = panel.series[s];
    out.emplace_back(series.x.size(), 0.0);
    // Elsewhere a shift would be another value.
    if (series.style == Series::Style::lines || !(placed.y.linear_to > 0)) continue;
    for (std::size_t i = 0; i < series.x.size(); ++i) {
      if (series.y[i] != 0) continue;
      const double x = wide * placed.x.along(placed.x.place(series.x[i]));
      const double y = high * placed.y.along(placed.y.place(series.y[i]));
      if (std::isfinite(x) && std::isfinite(y)) points.push_back({s, i, x, y});
    }
  }
  for (const Point& point : points) {
    // One of each series: those of a cloud may hide each other.
    std::vector<std::size_t> here;
    for (const Point& other : points) {
      if (std::abs(other.x - point.x) < kSamePlace && std::abs(other.y - point.y) < kSamePlace &&
          (here.empty() || here.back() != other.series))
        here.push_back(other.series);
    }
    const auto rank = std::find(here.begin(), here.end(), point.series) - here.begin();
    const double middle = 0.5 * static_cast<double>(here.size() - 1);
    const double apart = here.size() < 2 ? 0 : std::min(kApart, kAllApart / (2 * middle));
    // At an end of the axis all of them move inwards: a point outside would not be drawn.
    const double reach = apart * middle;
    const double inwards = std::min(0.0, high - point.y - reach) + std::max(0.0, reach - point.y);
    out[point.series][point.index] = apart * (middle - static_cast<double>(rank)) + inwards;
  }
  return out;
}

std::size_t columns_for(const Figure& figure) {
  const std::size_t panels = figure.panels.size();
  if (panels <= 1) return 1;
  if (panels != 3 && panels < 5) return 2;
  // Three where every title fits above its panel.
  return std::all_of(figure.panels.begin(), figure.panels.end(),
                     [](const Panel& panel) {
                       return kCharacter * static_cast<double>(characters(panel.title)) <
                              kFigureWidth / 3.0 - 60;
                     })
             ? 3
             : 2;
}

Layout layout_of(const Figure& figure) {
  Layout out;
  const std::size_t count = figure.panels.size(), columns = columns_for(figure);
  const std::size_t rows = (count + columns - 1) / columns;
  const double high = plot_height(columns);
  const std::vector<double> left = scale_panels(figure, out);
  const bool titled = std::any_of(figure.panels.begin(), figure.panels.end(),
                                  [](const Panel& p) { return !p.title.empty(); });
  // The last label of an x axis reaches beyond it.
  constexpr double kRight = 20;
  double wide = kFigureWidth - kRight * static_cast<double>(columns);
  for (const double l : left) wide -= l;
  wide /= static_cast<double>(columns);

  double top = 6;
  for (std::size_t row = 0; row < rows; ++row) {
    top += titled ? kLine + 5 : 4;
    double x = 0;
    bool labelled = false, plots = false;
    for (std::size_t column = 0; column < columns; ++column) {
      const std::size_t i = row * columns + column;
      x += left[column];
      if (i < count) {
        out.panels[i].box = {x, x + wide, top, top + high};
        labelled = labelled || out.panels[i].x_label;
        plots = plots || !figure.panels[i].drawing;
        if (figure.panels[i].drawing) fit_drawing(figure.panels[i], out.panels[i]);
      }
      x += wide + kRight;
    }
    top += high + (plots ? kLine + 16 : kDrawingRoom) + (labelled ? kLine : 0);
  }
  place_key(figure, top, out);
  return out;
}

}  // namespace farcull
