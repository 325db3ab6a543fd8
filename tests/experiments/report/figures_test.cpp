// Figures: what stands in them, and that they are drawn.
#include "experiments/report/figures.h"

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <limits>
#include <set>

#include "experiments/report/axes.h"
#include "experiments/report/chapters/numbers.h"
#include "experiments/report/chapters/rows.h"
#include "experiments/report/figure_layout.h"
#include "experiments/report/gnuplot.h"
#include "experiments/report/html.h"
#include "experiments/report/legible.h"
#include "experiments/report/markdown.h"
#include "experiments/report/style.h"
#include "tests/experiments/report/logarithmic.h"
#include "tests/lab/test.h"

namespace farcull {
namespace {

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

Figure two_panels() {
  Figure out{.name = "f", .title = "t", .caption = "c", .panels = {}};
  for (const char* title : {"first", "second"}) {
    Panel panel{.title = title};
    for (const char* name : {"CULLIDE", "Quick-CULLIDE", "FAR (OBB)"})
      panel.series.push_back({.name = name, .x = {1, 2}, .y = {5, name[0] == 'F' ? 0.0 : 7.0}});
    out.panels.push_back(panel);
  }
  return out;
}

std::vector<std::string> names_in(const Panel& panel) {
  std::vector<std::string> out;
  for (const Series& series : panel.series) out.push_back(series.name);
  return out;
}

TEST(ReportFigures, SeriesThatAgreeEverywhereAreOne) {
  const Figure merged = legible(two_panels());
  for (const Panel& panel : merged.panels) {
    EXPECT_EQ(names_in(panel), (std::vector<std::string>{"CULLIDE = Quick-CULLIDE", "FAR (OBB)"}));
  }
  // The twin: they differ at one point of one panel.
  Figure other = two_panels();
  other.panels[1].series[1].y[0] = 6;
  EXPECT_EQ(names_in(legible(other).panels[0]).size(), 3u);
}

TEST(ReportFigures, NamesThatAreTooLongForTheKeyGoToTheCaption) {
  Figure figure = two_panels();
  for (Panel& panel : figure.panels) {
    panel.series.resize(2);
    panel.series.push_back(panel.series[1]);
    panel.series[1].name = std::string(45, 'x');
    panel.series[2].name = std::string(45, 'y');
  }
  const Figure merged = legible(figure);
  EXPECT_EQ(names_in(merged.panels[0]), (std::vector<std::string>{"CULLIDE and 2 others"}));
  EXPECT_NE(merged.caption.find(std::string(45, 'x')), std::string::npos);
}

TEST(ReportFigures, PanelsWithoutADifferenceBecomeASentence) {
  Figure figure = two_panels();
  for (Series& series : figure.panels[0].series) series.y = {3, 3};
  figure.panels.push_back({.title = "third", .series = {{.name = "a", .x = {1}, .y = {kNone}}}});
  const Figure shown = legible(figure);
  ASSERT_EQ(shown.panels.size(), 1u);
  EXPECT_EQ(shown.panels[0].title, "second");
  EXPECT_EQ(shown.caption,
            "c. Not drawn, since every value is 3: first. Not drawn, since there is no value: "
            "third.");
  // The twin: a figure of such panels alone stays as it is.
  for (Series& series : figure.panels[1].series) series.y = {3, 3};
  EXPECT_EQ(legible(figure).panels.size(), 3u);
  EXPECT_EQ(legible(figure).caption, "c");
}

TEST(ReportFigures, ZerosAtTheSamePlaceStandAboveEachOtherAndNothingElseIsMoved) {
  Figure figure = two_panels();
  figure.panels[0].y = farcull::logarithmic("missed", true);
  std::vector<Series>& series = figure.panels[0].series;
  series[0].y = {0, 7};
  series[1].y = {0, 7};
  series[2].y = {0, 0};
  const auto shifts = [&] {
    const Layout layout = layout_of(figure);
    return shifts_of(figure.panels[0], layout.panels[0]);
  };
  // Three zeros at the first point; two values of 7 at the second, which stay where they are.
  EXPECT_EQ(shifts(), (std::vector<std::vector<double>>{{3, 0}, {0, 0}, {-3, 0}}));
  // A line without points has no place to stand aside.
  series[2].style = Series::Style::lines;
  EXPECT_EQ(shifts(), (std::vector<std::vector<double>>{{1.5, 0}, {-1.5, 0}, {0, 0}}));
  // However many: not so far that a 0 is taken for more.
  for (int i = 0; i < 20; ++i) {
    Series one = series[0];
    one.name += std::to_string(i);
    series.push_back(one);
  }
  for (const auto& of_series : shifts()) {
    for (const double shift : of_series) EXPECT_LE(std::abs(shift), 5 + 1e-9);
  }
  // On an axis without a part for zeros a shift would be another value.
  figure.panels[0].y = {.label = "missed", .from = 0, .to = 100};
  for (const auto& of_series : shifts()) {
    for (const double shift : of_series) EXPECT_EQ(shift, 0);
  }
}

// A triangle that is wide and low, and one that is neither.
Figure drawing() {
  Panel panel{.title = "drawn", .drawing = true};
  panel.series = {
      {.name = "a", .x = {0, 9, 4, 0}, .y = {0, 0, 1, 0}, .style = Series::Style::area},
      {.name = "b", .x = {3, 4, 4, 3}, .y = {0, 0, 1, 0}, .style = Series::Style::lines}};
  Figure out = two_panels();
  out.panels.insert(out.panels.begin(), panel);
  return out;
}

double px_per_unit(const Scale& scale, double px) { return px / (scale.to - scale.from); }

TEST(ReportFigures, ADrawingHasOneScaleForBothAxesAndHoldsAll) {
  for (const double scale : {1.0, 1e-200, 1e200}) {
    for (const bool high : {false, true}) {
      Figure figure = drawing();
      for (Series& series : figure.panels[0].series) {
        for (double& x : series.x) x *= scale;
        for (double& y : series.y) y *= scale;
        if (high) std::swap(series.x, series.y);
      }
      const PlacedPanel placed = layout_of(figure).panels[0];
      const double wide = placed.box.right - placed.box.left,
                   tall = placed.box.bottom - placed.box.top;
      // Some roundings of values of the size of the range.
      EXPECT_NEAR(px_per_unit(placed.x, wide) / px_per_unit(placed.y, tall), 1, 1e-14);
      for (const Series& series : figure.panels[0].series) {
        for (std::size_t i = 0; i < series.x.size(); ++i) {
          EXPECT_TRUE(placed.x.from < series.x[i] && series.x[i] < placed.x.to);
          EXPECT_TRUE(placed.y.from < series.y[i] && series.y[i] < placed.y.to);
        }
      }
    }
  }
  // The twin: in a plot each axis has its own.
  Figure plot = drawing();
  plot.panels[0].drawing = false;
  const PlacedPanel placed = layout_of(plot).panels[0];
  EXPECT_NE(px_per_unit(placed.x, placed.box.right - placed.box.left),
            px_per_unit(placed.y, placed.box.bottom - placed.box.top));
}

TEST(ReportFigures, ADrawingHasNoNumbersAndThePlotAfterItHas) {
  const std::string script = figure_script(drawing()).script;
  const std::size_t first = script.find("# panel 1"), second = script.find("# panel 2");
  const std::string drawn = script.substr(first, second - first), plotted = script.substr(second);
  for (const char* part : {"unset grid", "unset xtics", "unset ytics", "with filledcurves closed"})
    EXPECT_NE(drawn.find(part), std::string::npos) << part;
  EXPECT_EQ(drawn.find("set xtics ("), std::string::npos);
  EXPECT_LT(drawn.find("unset grid"), drawn.find("set grid"));  // for the next one
  EXPECT_NE(plotted.find("set xtics ("), std::string::npos);
  EXPECT_EQ(plotted.find("filledcurves"), std::string::npos);
  // One corner as high as all others is no reason to leave a drawing out.
  Figure flat = drawing();
  for (Series& series : flat.panels[0].series) series.y.assign(4, 0);
  EXPECT_EQ(legible(flat).panels.size(), 3u);
  // A drawing with an axis or a mark is a mistake.
  Figure mistaken = drawing();
  mistaken.panels[0].marks = {{true, 1, "mark"}};
  EXPECT_THROW(figure_script(mistaken), std::logic_error);
  mistaken = drawing();
  mistaken.panels[0].x.label = "length";
  EXPECT_THROW(figure_script(mistaken), std::logic_error);
}

TEST(ReportFigures, OfSeriesThatAgreeTheOneThatTheFigureIsAboutGivesTheStyle) {
  Figure figure = two_panels();
  for (Panel& panel : figure.panels) {
    panel.series[2].y = panel.series[0].y;
    panel.series[2].emphasis = true;
    panel.series[1].y = {1, 2};
  }
  EXPECT_EQ(names_in(legible(figure).panels[0]),
            (std::vector<std::string>{"Quick-CULLIDE", "FAR (OBB) = CULLIDE"}));
}

TEST(ReportFigures, MarksAreInTheKeyAndNotOverTheData) {
  Figure figure = two_panels();
  figure.panels[0].marks = {{true, 1, "budget"}, {false, 2, "rounding"}};
  EXPECT_EQ(key_names(figure), (std::vector<std::string>{"CULLIDE", "Quick-CULLIDE", "FAR (OBB)",
                                                         "budget", "rounding"}));
  const std::string script = figure_script(figure).script;
  EXPECT_NE(script.find("set label 'budget' at screen"), std::string::npos);
  EXPECT_EQ(script.find("set label 'budget' at first"), std::string::npos);
}

TEST(ReportFigures, BarsReachAsFarAsTheIntervals) {
  Figure figure = two_panels();
  Series& series = figure.panels[0].series[0];
  series.y_low = {4, 6};
  series.y_high = {50, kNone};
  EXPECT_NE(figure_script(figure).script.find("with vectors"), std::string::npos);
  EXPECT_GE(layout_of(figure).panels[0].y.to, 50);
  EXPECT_EQ(figure_script(two_panels()).script.find("with vectors"), std::string::npos);
  // An end is missing.
  series.y_high.pop_back();
  EXPECT_THROW(figure_script(figure), std::logic_error);
}

bool has_gnuplot() {
  try {
    require_gnuplot();
  } catch (const Error&) {
    return false;
  }
  return true;
}

// All that has made a plotter stumble: quotes, markup, gaps, zeros, nothing, one point, no end.
Figure trap() {
  Figure figure{.name = "trap",
                .title = "it's a \"trap\" & <b> \\ `date` $(date) 100 %",
                .caption = "`x` @macro",
                .panels = {}};
  for (const bool log : {false, true}) {
    for (const std::vector<double>& y :
         {std::vector<double>{1, kNone, 3}, std::vector<double>{0, 0, 0},
          std::vector<double>{kNone, kNone, kNone}, std::vector<double>{5, 5, 5},
          std::vector<double>{1e-300, 1, 1e300},
          std::vector<double>{-1, 0, std::numeric_limits<double>::infinity()}}) {
      Panel panel;
      panel.title = "%s a_b^{c} 'q' @x";
      panel.x = logarithmic(true);
      panel.x.label = "%g 'x'";
      panel.y = logarithmic(true);
      panel.y.logarithmic = log;
      for (const auto style :
           {Series::Style::lines_points, Series::Style::lines, Series::Style::points}) {
        Series series{
            .name = "s'" + std::to_string(static_cast<int>(style)), .x = {0, 1, 2}, .y = y};
        series.style = style;
        series.emphasis = style == Series::Style::lines;
        // Bars of every kind, and those of which none has a place.
        if (style == Series::Style::points) series.y_low = series.y_high = {kNone, kNone, kNone};
        if (style == Series::Style::lines) {
          series.x_low = {0, 0.5, kNone};
          series.x_high = {0.5, 2, 3};
          series.y_low = y;
          series.y_high = {7, 1e9, kNone};
        }
        panel.series.push_back(series);
      }
      panel.marks = {{true, 1, "it's"}, {false, 0, "%d"}};
      figure.panels.push_back(panel);
    }
  }
  figure.panels.emplace_back();
  for (const std::vector<double>& x :
       {std::vector<double>{0, 1, 2}, std::vector<double>{1, 1, 1},
        std::vector<double>{1e-300, 0, 0}, std::vector<double>{1e200, 1e200, 1e200},
        std::vector<double>{kNone, kNone, kNone}}) {
    Panel drawn{.title = "drawn", .drawing = true};
    drawn.series = {{.name = "area", .x = x, .y = {0, 0, 0}, .style = Series::Style::area},
                    {.name = "line", .x = x, .y = x, .style = Series::Style::lines}};
    figure.panels.push_back(drawn);
  }
  return figure;
}

TEST(ReportFigures, AreDrawnWithoutAWarningWhateverTheyHold) {
  if (!has_gnuplot()) GTEST_SKIP() << "gnuplot is not installed";
  const ScratchFolder folder;
  draw_figure(trap(), folder.folder());
  for (const char* kind : {".svg", ".pdf", ".gp", ".dat"}) {
    EXPECT_GT(std::filesystem::file_size(folder.folder() + "/trap" + kind), 0u) << kind;
  }
}

TEST(ReportFigures, AWarningOfThePlotterIsAnError) {
  if (!has_gnuplot()) GTEST_SKIP() << "gnuplot is not installed";
  const ScratchFolder folder;
  // Nothing but a warning comes of it: all points of the data are the same.
  std::ofstream(folder.folder() + "/warns.gp")
      << "set terminal svg\nset output 'x.svg'\n$d << end\n1 1\n1 1\nend\nplot $d\n";
  EXPECT_NE(
      error_of([&] { run_gnuplot(folder.folder(), "warns.gp", "svg"); }).reason.find("warned"),
      std::string::npos);
  std::ofstream(folder.folder() + "/fails.gp") << "no command of this name\n";
  EXPECT_EQ(
      error_of([&] { run_gnuplot(folder.folder(), "fails.gp", "svg"); }).reason.find("failed"), 0u);
}

TEST(ReportFigures, ThatBreakTheirHeaderAreMistakesOfTheProgram) {
  EXPECT_THROW(figure_script({.name = "a b", .title = {}, .caption = {}, .panels = {Panel{}}}),
               std::logic_error);
  EXPECT_THROW(figure_script({.name = "a", .title = {}, .caption = {}, .panels = {}}),
               std::logic_error);
  Figure figure = trap();
  figure.panels[0].series[0].x.pop_back();
  EXPECT_THROW(figure_script(figure), std::logic_error);
}

}  // namespace
}  // namespace farcull
