// Writes gnuplot scripts with every place, range and tick given, runs them, and mends the SVG.
#include "experiments/report/figures.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <limits>
#include <sstream>
#include <stdexcept>

#include "core/base/error.h"
#include "experiments/record/output.h"
#include "experiments/report/figure_layout.h"
#include "experiments/report/gnuplot.h"
#include "experiments/report/html.h"
#include "experiments/report/style.h"
#include "experiments/system/output_file.h"

namespace farcull {
namespace {

constexpr const char* kFont = "farcull-font";                     // replaced in the SVG by families
constexpr const char* kFill = "transparent solid 0.25 noborder";  // of areas
constexpr const char* kFamilies =
    "Helvetica Neue, Helvetica, Arial, Liberation Sans, DejaVu Sans, sans-serif";

void check(const Figure& figure) {
  const auto require = [&](bool holds, const char* what) {
    if (!holds) throw std::logic_error("figure '" + figure.name + "': " + what);
  };
  require(!figure.name.empty() && figure.name.find_first_not_of(
                                      "abcdefghijklmnopqrstuvwxyz0123456789-") == std::string::npos,
          "the name is no name of a file");
  require(!figure.panels.empty(), "no panel");
  for (const Panel& panel : figure.panels) {
    require(
        !panel.drawing || (panel.marks.empty() && panel.x.label.empty() && panel.y.label.empty() &&
                           !panel.x.logarithmic && !panel.y.logarithmic),
        "a drawing has axes or marks");
    for (const Series& series : panel.series) {
      require(series.x.size() == series.y.size(), "x and y differ in length");
      for (const auto& [low, high] :
           {std::pair{&series.x_low, &series.x_high}, std::pair{&series.y_low, &series.y_high}}) {
        require(low->size() == high->size() && (low->empty() || low->size() == series.x.size()),
                "intervals differ in length from their points");
      }
    }
  }
}

class Script {
 public:
  explicit Script(const Figure& figure)
      : figure_(figure),
        layout_(layout_of(figure)),
        names_(series_names(figure)),
        keys_(key_names(figure)),
        styles_(styles_of(names_)) {}

  FigureScript made() {
    head();
    for (std::size_t i = 0; i < figure_.panels.size(); ++i) panel(i);
    line("unset multiplot");
    line("unset output");
    return {script_, data_};
  }

 private:
  void line(const std::string& text) { script_ += text + "\n"; }

  std::string screen_x(double x) const { return fmt::format("{:.5f}", x / kFigureWidth); }
  std::string screen_y(double y) const { return fmt::format("{:.5f}", 1 - y / layout_.height); }

  // The emphasised ones get thinner in the order in which they are drawn over each other, so that
  // those with the same values (0, where nothing is missed) all stay visible.
  double order_of(std::size_t style) const {
    double before = 0;
    for (std::size_t i = 0; i < style; ++i) before += first_of(names_[i])->emphasis ? 1 : 0;
    return std::min(before, 2.0);
  }
  double width_of(std::size_t style) const {
    return first_of(names_[style])->emphasis
               ? (columns_for(figure_) == 3 ? 3.4 : 4.2) - 1.1 * order_of(style)
               : 1.5;
  }
  double size_of(std::size_t style) const {
    const double usual = first_of(names_[style])->emphasis ? 1.15 - 0.25 * order_of(style) : 0.7;
    return columns_for(figure_) == 3 ? 0.75 * usual : usual;  // small panels, small points
  }

  void head() {
    const std::string& name = figure_.name;
    line("# " + gnuplot_text(figure_.title));
    line("# Draws " + name + ".svg: gnuplot " + name + ".gp");
    line("# and " + name + ".pdf: gnuplot -e \"kind='pdf'\" " + name + ".gp");
    line("if (!exists('kind')) kind = 'svg'");
    line("set encoding utf8");
    line("if (kind eq 'pdf') {");
    // 17 cm are 482 pt, so that a pixel of the SVG is 0.669 pt.
    const double cm = 17.0 / kFigureWidth;
    line(
        fmt::format("  set terminal pdfcairo color noenhanced size {:.3f}cm,{:.3f}cm font "
                    "'DejaVu Sans,{:.2f}' fontscale 0.76 pointscale 1.2 linewidth 0.85 rounded",
                    cm * kFigureWidth, cm * layout_.height, kFigureText * cm / 2.54 * 72));
    line("  set output '" + name + ".pdf'");
    line("} else {");
    line(
        fmt::format("  set terminal svg noenhanced size {},{:.0f} font '{},{}' rounded "
                    "background '#ffffff'",
                    kFigureWidth, layout_.height, kFont, kFigureText));
    line("  set output '" + name + ".svg'");
    line("}");
    line("set multiplot");
    frame_of_plots();
    line("set tics nomirror out scale 0.6,0.3 textcolor rgb '#222222'");
    line("set xtics offset 0,character 0.4");
    line("unset key");
    key();
  }

  void frame_of_plots() {
    line("set border 3 lc rgb '#444444' lw 1");
    line("set grid xtics ytics back lt 1 lc rgb '#e4e4e4' lw 0.8, lt 0 lw 0");
  }
  void frame_of_drawings() {
    line("set border 15 lc rgb '#dddddd' lw 0.8");
    line("unset grid");
  }

  // Names in columns below the panels: a sample of the line, the point, the name.
  void key() {
    const std::size_t columns = layout_.key_columns;
    std::vector<double> widths(columns, 0);
    for (std::size_t i = 0; i < keys_.size(); ++i) {
      widths[i % columns] = std::max(widths[i % columns],
                                     52 + kCharacter * static_cast<double>(characters(keys_[i])));
    }
    double total = 0;
    for (const double width : widths) total += width;
    const double start = std::max(10.0, (kFigureWidth - total) / 2);
    if (!layout_.note.empty()) {
      line(fmt::format("set label {} at screen 0.5,{} center front textcolor rgb '#555555'",
                       gnuplot_text(layout_.note), screen_y(layout_.note_top + 0.5 * kLine)));
    }
    for (std::size_t i = 0; i < keys_.size(); ++i) {
      double x = start;
      for (std::size_t c = 0; c < i % columns; ++c) x += widths[c];
      const double y = layout_.key_top + kLine * (static_cast<double>(i / columns) + 0.5);
      line(fmt::format("set label {} at screen {},{} left front textcolor rgb '#222222'",
                       gnuplot_text(keys_[i]), screen_x(x + 38), screen_y(y)));
      if (i >= names_.size()) {
        line(fmt::format("set arrow from screen {0},{2} to screen {1},{2} {3}", screen_x(x),
                         screen_x(x + 30), screen_y(y), look_of_mark(keys_[i])));
        continue;
      }
      const Series* series = first_of(names_[i]);
      const bool lines = series->style != Series::Style::points;
      const bool area = series->style == Series::Style::area;
      const bool dots = !area && series->style != Series::Style::lines;
      if (area) {
        line(
            fmt::format("set object rectangle from screen {},{} to screen {},{} front fillcolor "
                        "rgb '{}' fillstyle {}",
                        screen_x(x), screen_y(y - 5), screen_x(x + 30), screen_y(y + 5),
                        styles_[i].colour, kFill));
      }
      if (lines) {
        line(fmt::format(
            "set arrow from screen {0},{2} to screen {1},{2} nohead front dt {3} "
            "lc rgb '{4}' lw {5}",
            screen_x(x), screen_x(x + 30), screen_y(y), dash(i), styles_[i].colour,
            // The plotter draws arrows of one colour and width as one path, with one dash.
            width_of(i) + 0.001 * static_cast<double>(i)));
      }
      if (dots) {
        line(fmt::format("set label '' at screen {},{} front point pt {} ps {} lc rgb '{}'",
                         screen_x(x + 15), screen_y(y), styles_[i].point, size_of(i),
                         styles_[i].colour));
      }
    }
  }

  const Series* first_of(const std::string& name) const {
    for (const Panel& panel : figure_.panels) {
      for (const Series& series : panel.series) {
        if (series.name == name) return &series;
      }
    }
    throw std::logic_error("no series of that name");
  }

  // Marks are grey lines that differ in their dashes.
  std::string look_of_mark(const std::string& name) const {
    static const std::vector<std::string> kDashes = {"(6,4)", "(2,3)", "(12,4)", "(8,3,2,3)"};
    const auto at =
        static_cast<std::size_t>(std::find(keys_.begin(), keys_.end(), name) - keys_.begin()) -
        names_.size();
    return "nohead front lc rgb '#444444' lw 1.2 dt " + kDashes[at % kDashes.size()];
  }

  std::string dash(std::size_t style) const {
    return dashes()[static_cast<std::size_t>(styles_[style].dash)];
  }

  void axis(const char* name, const Scale& scale) {
    // A range that both kinds of axes have, so that the one of the panel before is never taken
    // over.
    line(fmt::format("unset logscale {0}\nset {0}range [1:10]", name));
    if (scale.logarithmic) line(fmt::format("set logscale {}", name));
    line(fmt::format("set {}range [{:.17g}:{:.17g}]", name, scale.from, scale.to));
    if (scale.ticks.empty()) {
      line(fmt::format("unset {}tics", name));
      return;
    }
    std::string ticks;
    for (const Tick& tick : scale.ticks) {
      ticks += fmt::format("{}{} {:.17g}{}", ticks.empty() ? "" : ", ", gnuplot_text(tick.label),
                           tick.at, tick.label.empty() ? " 1" : "");
    }
    line(fmt::format("set {}tics ({})", name, ticks));
  }

  // Centred below and left of the panel, at places of our own: the plotter's depend on its fonts.
  void axis_labels(const Panel& panel, const PlacedPanel& placed) {
    constexpr const char* kText = "front textcolor rgb '#222222'";
    const PlotBox& box = placed.box;
    if (placed.x_label && !panel.x.label.empty()) {
      line(fmt::format("set label {} at screen {},{} center {}", gnuplot_text(panel.x.label),
                       screen_x((box.left + box.right) / 2),
                       screen_y(box.bottom + 2.05 * kLine + 2), kText));
    }
    if (placed.y_label && !panel.y.label.empty()) {
      line(fmt::format("set label {} at screen {},{} center rotate by 90 {}",
                       gnuplot_text(panel.y.label), screen_x(box.left - placed.y_room),
                       screen_y((box.top + box.bottom) / 2), kText));
    }
  }

  // Where an axis that shows zeros is linear it is shaded, with a line at 0.
  void linear_parts(const Scale& x, const Scale& y) {
    constexpr const char* kShade = "behind fillcolor rgb '#f1f1ee' fillstyle solid 1 noborder";
    constexpr const char* kZero = "nohead back lc rgb '#999999' lw 0.8 dt (2,4)";
    if (y.linear_to > 0) {
      line(fmt::format("set object rectangle from graph 0,graph 0 to graph 1,first {:.17g} {}",
                       y.linear_to, kShade));
      line(fmt::format("set arrow from graph 0,first {0:.17g} to graph 1,first {0:.17g} {1}",
                       y.zero, kZero));
    }
    if (x.linear_to > 0) {
      line(fmt::format("set object rectangle from graph 0,graph 0 to first {:.17g},graph 1 {}",
                       x.linear_to, kShade));
      line(fmt::format("set arrow from first {0:.17g},graph 0 to first {0:.17g},graph 1 {1}",
                       x.zero, kZero));
    }
  }

  // The key names it: a label inside the panel would lie over data.
  void mark(const Mark& mark, const PlacedPanel& placed) {
    const double at = (mark.vertical ? placed.x : placed.y).place(mark.at);
    if (std::isnan(at)) return;
    const std::string from = mark.vertical ? fmt::format("first {:.17g},graph ", at) : "graph ";
    const std::string end = mark.vertical ? "" : fmt::format(",first {:.17g}", at);
    line(fmt::format("set arrow from {0}0{1} to {0}1{1} {2}", from, end, look_of_mark(mark.name)));
  }

  // Adds the block of a series to the data: x, y, the ends of both intervals, and how far upwards
  // the point is drawn (a factor on a logarithmic axis). False where no point of it has a place.
  bool add_data(const Series& series, const PlacedPanel& placed,
                const std::vector<double>& shifts) {
    bool any = false;
    x_bars_ = y_bars_ = false;
    std::string block =
        fmt::format("# {}\n# x y x_low x_high y_low y_high shift\n", gnuplot_text(series.name));
    const auto number = [](double v) {
      return std::isnan(v) ? std::string("NaN") : fmt::format("{:.17g}", v);
    };
    const auto end = [](const std::vector<double>& ends, std::size_t i, const Scale& scale) {
      return ends.empty() ? std::numeric_limits<double>::quiet_NaN() : scale.place(ends[i]);
    };
    const Scale& along = placed.y;
    const double px = (placed.box.bottom - placed.box.top);
    for (std::size_t i = 0; i < series.x.size(); ++i) {
      const double x = placed.x.place(series.x[i]), y = placed.y.place(series.y[i]);
      const bool there = !std::isnan(x) && !std::isnan(y);
      any = any || there;
      if (!there) {
        block += "NaN NaN NaN NaN NaN NaN NaN\n";
        continue;
      }
      const double x_low = end(series.x_low, i, placed.x), x_high = end(series.x_high, i, placed.x),
                   y_low = end(series.y_low, i, placed.y), y_high = end(series.y_high, i, placed.y);
      // Where no bar has a place, drawing bars would be a warning.
      x_bars_ = x_bars_ || !std::isnan(x_low + x_high);
      y_bars_ = y_bars_ || !std::isnan(y_low + y_high);
      const double part = shifts[i] / px;
      const double shift = along.logarithmic ? std::pow(along.to / along.from, part)
                                             : part * (along.to - along.from);
      block += fmt::format("{} {} {} {} {} {} {}\n", number(x), number(y), number(x_low),
                           number(x_high), number(y_low), number(y_high), number(shift));
    }
    if (!any) return false;
    if (blocks_++ > 0) data_ += "\n\n";
    data_ += block;
    return true;
  }

  std::string plot_of(const Series& series, const Scale& y) const {
    const auto style = static_cast<std::size_t>(
        std::find(names_.begin(), names_.end(), series.name) - names_.begin());
    const SeriesStyle& look = styles_[style];
    const char* const move = y.logarithmic ? "*" : "+";
    const std::string data = fmt::format("'{}.dat' index {}", figure_.name, blocks_ - 1);
    const std::string from = fmt::format("{} using 1:($2{}$7)", data, move);
    const std::string lines =
        fmt::format("dt {} lw {} lc rgb '{}'", dash(style), width_of(style), look.colour);
    const std::string dots =
        fmt::format("pt {} ps {} lw 1.2 lc rgb '{}'", look.point, size_of(style), look.colour);
    // Not gnuplot's error bars, which leave a gap around their point.
    const std::string bars =
        fmt::format("with vectors heads size screen 0.004,90 nofilled dt solid lw 1.1 lc rgb '{}'",
                    look.colour);
    std::vector<std::string> parts;
    if (x_bars_)
      parts.push_back(fmt::format("{} using 3:($2{}$7):($4-$3):(0) {}", data, move, bars));
    if (y_bars_) {
      parts.push_back(
          fmt::format("{0} using 1:($5{1}$7):(0):(($6{1}$7)-($5{1}$7)) {2}", data, move, bars));
    }
    if (series.style == Series::Style::area) {
      parts.push_back(fmt::format("{} with filledcurves closed fillcolor rgb '{}' fillstyle {}",
                                  from, look.colour, kFill));
    }
    if (series.style != Series::Style::points) parts.push_back(from + " with lines " + lines);
    if (series.style == Series::Style::points || series.style == Series::Style::lines_points)
      parts.push_back(from + " with points " + dots);
    return fmt::format("{}", fmt::join(parts, ", \\\n  "));
  }

  void panel(std::size_t index) {
    const Panel& panel = figure_.panels[index];
    const PlacedPanel& placed = layout_.panels[index];
    const PlotBox& box = placed.box;
    line(fmt::format("\n# panel {}", index + 1));
    line(fmt::format("set lmargin at screen {}", screen_x(box.left)));
    line(fmt::format("set rmargin at screen {}", screen_x(box.right)));
    line(fmt::format("set tmargin at screen {}", screen_y(box.top)));
    line(fmt::format("set bmargin at screen {}", screen_y(box.bottom)));
    if (panel.drawing) frame_of_drawings();
    axis("x", placed.x);
    axis("y", placed.y);
    axis_labels(panel, placed);
    linear_parts(placed.x, placed.y);
    if (!panel.title.empty()) {
      line(fmt::format("set label {} at screen {},{} left front textcolor rgb '#000000'",
                       gnuplot_text(panel.title), screen_x(box.left), screen_y(box.top - 12)));
    }
    for (const Mark& m : panel.marks) mark(m, placed);
    // Emphasised ones first: they are thick, so what has the same values stays visible above them.
    std::vector<std::string> plots;
    const std::vector<std::vector<double>> shifts = shifts_of(panel, placed);
    for (const bool emphasis : {true, false}) {
      for (std::size_t i = 0; i < panel.series.size(); ++i) {
        const Series& series = panel.series[i];
        if (series.emphasis == emphasis && add_data(series, placed, shifts[i]))
          plots.push_back(plot_of(series, placed.y));
      }
    }
    if (plots.empty()) {
      line(
          "set label 'nothing was measured' at graph 0.5,graph 0.5 center textcolor rgb '#666666'");
      // A point outside the ranges: axes without a plot are none to gnuplot.
      line(fmt::format("$nothing << end\n{0:.17g} {1:.17g}\nend",
                       placed.x.to + (placed.x.to - placed.x.from), placed.y.to));
      plots.push_back("$nothing using 1:2 with dots");
    }
    line(fmt::format("plot {}", fmt::join(plots, ", \\\n  ")));
    line("unset label");
    line("unset arrow");
    line("unset object");
    if (panel.drawing) frame_of_plots();
  }

  const Figure& figure_;
  Layout layout_;
  std::vector<std::string> names_, keys_;  // of series, and those of the key
  std::vector<SeriesStyle> styles_;
  std::string script_, data_;
  std::size_t blocks_ = 0;
  bool x_bars_ = false, y_bars_ = false;  // of the block that was added last
};

std::string replaced(std::string text, const std::string& what, const std::string& by) {
  for (std::size_t at = 0; (at = text.find(what, at)) != std::string::npos; at += by.size()) {
    text.replace(at, what.size(), by);
  }
  return text;
}

// The text between two others, both included, replaced; the text as it is where they are not there.
std::string replaced_between(std::string text, const std::string& begin, const std::string& end,
                             const std::string& by) {
  const std::size_t from = text.find(begin);
  const std::size_t to = from == std::string::npos ? from : text.find(end, from);
  if (to == std::string::npos) return text;
  return text.replace(from, to + end.size() - from, by);
}

std::string content_of(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  std::ostringstream out;
  out << file.rdbuf();
  return out.str();
}

}  // namespace

FigureScript figure_script(const Figure& figure) {
  check(figure);
  return Script(figure).made();
}

void draw_figure(const Figure& figure, const std::string& folder) {
  const FigureScript script = figure_script(figure);
  const std::string base = folder + "/" + figure.name;
  write_output(base + ".gp", script.script);
  write_output(base + ".dat", script.data);
  for (const std::string kind : {"svg", "pdf"}) {
    run_gnuplot(folder, figure.name + ".gp", kind);
    std::error_code ignored;
    if (std::filesystem::file_size(base + "." + kind, ignored) == 0 || ignored) {
      throw Error(base + "." + kind, "gnuplot left nothing there",
                  "see whether the disk is full, and that gnuplot draws " + kind);
    }
  }
  std::string svg = content_of(base + ".svg");
  svg = replaced(svg, kFont, kFamilies);
  svg = replaced_between(svg, "<title>", "</title>",
                         "<title>" + html_text(figure.title) + "</title>");
  svg =
      replaced_between(svg, "<desc>", "</desc>", "<desc>" + html_text(figure.caption) + "</desc>");
  write_output(base + ".svg", svg);
}

std::string inline_svg(const std::string& svg, const std::string& prefix) {
  const std::size_t begin = svg.find("<svg");
  if (begin == std::string::npos) throw std::logic_error("no SVG");
  std::string out = svg.substr(begin);
  for (const std::string mark : {"id=\"", "id='", "href=\"#", "href='#", "url(#", "url('#"}) {
    out = replaced(out, mark, mark + prefix);
  }
  return out;
}

}  // namespace farcull
