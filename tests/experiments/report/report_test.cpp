// What figures, tables and the page are made of. The whole report in a browser: report_test.sh.
#include "experiments/report/report.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <limits>
#include <set>

#include "core/base/base64.h"
#include "experiments/report/axes.h"
#include "experiments/report/chapters/numbers.h"
#include "experiments/report/chapters/rows.h"
#include "experiments/report/figure_layout.h"
#include "experiments/report/figures.h"
#include "experiments/report/gnuplot.h"
#include "experiments/report/html.h"
#include "experiments/report/latex.h"
#include "experiments/report/legible.h"
#include "experiments/report/markdown.h"
#include "experiments/report/pictures.h"
#include "experiments/report/style.h"
#include "experiments/report/tables.h"
#include "experiments/system/shell_word.h"
#include "tests/experiments/system/error_of.h"

namespace farcull {
namespace {

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

std::vector<std::string> labels_of(const Scale& scale) {
  std::vector<std::string> out;
  for (const Tick& tick : scale.ticks) {
    if (!tick.label.empty()) out.push_back(tick.label);
  }
  return out;
}

Axis logarithmic(bool zero = false) {
  Axis axis;
  axis.label = "pairs";
  axis.logarithmic = true;
  axis.shows_zero = zero;
  return axis;
}

TEST(ReportAxis, ZerosHaveAPlaceOfTheirOwnBelowThePowers) {
  const Scale scale = scale_of(logarithmic(true), {0, 3, 5000}, 100);
  EXPECT_GT(scale.zero, scale.from);
  EXPECT_LT(scale.zero, 1);
  EXPECT_EQ(scale.place(0), scale.zero);
  EXPECT_EQ(scale.place(3), 3);
  EXPECT_EQ(labels_of(scale).front(), "0");
  // A tick below the smallest power would be taken for a value.
  for (const Tick& tick : scale.ticks)
    EXPECT_TRUE(tick.at == scale.zero || tick.at >= 1) << tick.at;
}

TEST(ReportAxis, WithZerosIsLinearToOneAndLogarithmicBeyond) {
  const Scale counts = scale_of(logarithmic(true), {0, 300, 5000}, 100);
  EXPECT_EQ(counts.linear_to, 1);
  EXPECT_NEAR(counts.place(1), 1, 1e-12);
  // Halfway between 0 and 1.
  EXPECT_NEAR(counts.along(counts.place(0.5)),
              (counts.along(counts.place(0)) + counts.along(1)) / 2, 1e-12);
  const std::vector<std::string> labels = labels_of(counts);
  EXPECT_NE(std::find(labels.begin(), labels.end(), "1"), labels.end());
  // Where values are below 1, linear to a power of ten below all of them.
  EXPECT_NEAR(scale_of(logarithmic(true), {0, 0.03, 50}, 100).linear_to, 0.01, 1e-15);
  // The twin: without zeros nothing is linear.
  EXPECT_EQ(scale_of(logarithmic(true), {3, 300, 5000}, 100).linear_to, 0);
}

TEST(ReportAxis, ZerosAreNoValuesOfALogarithmicAxisThatDoesNotShowThem) {
  const Scale scale = scale_of(logarithmic(), {0, 3, 5000}, 100);
  EXPECT_TRUE(std::isnan(scale.place(0)));
  EXPECT_EQ(scale.zero, 0);
}

TEST(ReportAxis, ZerosAloneStillHaveAnAxis) {
  const Scale scale = scale_of(logarithmic(true), {0, 0, 0}, 100);
  EXPECT_LT(scale.from, scale.to);
  EXPECT_GT(scale.zero, 0);
}

TEST(ReportAxis, HoldsEveryValueOfAnySize) {
  for (const bool log : {false, true}) {
    Axis axis;
    axis.logarithmic = log;
    for (int exponent = -300; exponent <= 300; exponent += 7) {
      for (const double m : {1.0, 1.9999999, 2.0, 4.2, 9.999999}) {
        const double value = m * std::pow(10, exponent);
        const Scale scale = scale_of(axis, {value, value * 3, kNone}, 60);
        EXPECT_LT(scale.from, scale.to) << value;
        EXPECT_LE(scale.from, value) << value;
        EXPECT_GE(scale.to, value * 3) << value;
        EXPECT_FALSE(scale.ticks.empty()) << value;
        EXPECT_LE(scale.ticks.size(), 60u) << value;
      }
    }
  }
}

TEST(ReportAxis, PowersOfTwoAreTicksThemselves) {
  EXPECT_EQ(labels_of(scale_of(logarithmic(), {64, 128, 256, 512}, 100)),
            (std::vector<std::string>{"64", "128", "256", "512"}));
}

TEST(ReportAxis, LessThanADecadeHasTicksAsWell) {
  EXPECT_GE(labels_of(scale_of(logarithmic(), {112, 131, 190}, 60)).size(), 3u);
}

TEST(ReportAxis, LabelsThatDoNotFitAreLeftOut) {
  const Scale wide = scale_of(logarithmic(), {1e-9, 1e9}, 200);
  const Scale narrow = scale_of(logarithmic(), {1e-9, 1e9}, 30);
  EXPECT_GT(labels_of(wide).size(), labels_of(narrow).size());
  EXPECT_GE(labels_of(narrow).size(), 2u);
}

TEST(ReportAxis, LabelsAreForPeople) {
  EXPECT_EQ(tick_label(1000), "1,000");
  EXPECT_EQ(tick_label(0.1), "0.1");
  EXPECT_EQ(tick_label(0), "0");
  EXPECT_EQ(tick_label(1e9), "10⁹");
  EXPECT_EQ(power_label(-12), "10⁻¹²");
  EXPECT_EQ(characters("10⁻¹²"), 5u);
}

TEST(ReportAxis, ANarrowRangeHasTicksAsWell) {
  Axis axis;
  axis.from = 0.96;
  axis.to = 1.04;
  EXPECT_GE(labels_of(scale_of(axis, {0.5, 1, 1.1}, 20)).size(), 3u);
  // The twin: no more than fit, and none added where there are enough.
  EXPECT_LT(labels_of(scale_of(axis, {0.5, 1, 1.1}, 8)).size(), 4u);
  axis.from = 0;
  EXPECT_EQ(labels_of(scale_of(axis, {0.5, 1, 1.1}, 20)),
            (std::vector<std::string>{"0", "0.5", "1"}));
}

TEST(ReportStyle, AMethodLooksTheSameInEveryFigure) {
  const auto alone = styles_of({"CULLIDE"});
  const auto among = styles_of({"FAR (OBB)", "FAR pairs", "Quick-CULLIDE", "CULLIDE"});
  EXPECT_EQ(alone[0].colour, among[3].colour);
  EXPECT_EQ(alone[0].point, among[3].point);
  std::set<std::string> colours;
  for (const SeriesStyle& style : among) colours.insert(style.colour);
  EXPECT_EQ(colours.size(), 4u);
}

TEST(ReportStyle, SeveralThatAgreeLookLikeTheFirst) {
  EXPECT_EQ(styles_of({"CULLIDE = Quick-CULLIDE"})[0].colour, styles_of({"CULLIDE"})[0].colour);
  EXPECT_NE(styles_of({"CULLIDE = Quick-CULLIDE"})[0].colour,
            styles_of({"Quick-CULLIDE"})[0].colour);
}

TEST(ReportStyle, WordsThatHoldAMethodsNameAreNone) {
  EXPECT_NE(styles_of({"farther"})[0].colour, styles_of({"far"})[0].colour);
}

TEST(ReportStyle, TwoOfOneMethodDifferInDashAndPoint) {
  const auto styles = styles_of({"far, obb, 64 px", "far, obb, 128 px"});
  EXPECT_EQ(styles[0].colour, styles[1].colour);
  EXPECT_NE(styles[0].dash, styles[1].dash);
  EXPECT_NE(styles[0].point, styles[1].point);
}

TEST(ReportStyle, ManyNamesDifferInColourOrPoint) {
  std::vector<std::string> names;
  for (int i = 0; i < 100; ++i) names.push_back("name " + std::to_string(i));
  for (int i = 0; i < 10; ++i) names.push_back("cgal " + std::to_string(i));
  std::set<std::pair<std::string, int>> looks;
  for (const SeriesStyle& style : styles_of(names)) looks.emplace(style.colour, style.point);
  EXPECT_EQ(looks.size(), names.size());
}

TEST(ReportNumbers, ExponentOfAPowerIsThePower) {
  std::vector<double> x, y;
  for (const double v : {2.0, 8.0, 32.0, 128.0}) {
    x.push_back(v);
    y.push_back(3 * v * std::sqrt(v));  // exact, but for logarithms
  }
  const auto e = exponent_of(x, y);
  ASSERT_TRUE(e);
  // Logarithms and sums of four terms: some tens of units of roundoff of values below 10.
  EXPECT_NEAR(e->value, 1.5, 1e-13);
  EXPECT_NEAR(e->error, 0, 1e-13);
  EXPECT_EQ(e->points, 4u);
  EXPECT_EQ(e->from, 2);
  EXPECT_EQ(e->to, 128);
}

TEST(ReportNumbers, StandardErrorIsThatOfTheTextbook) {
  // log y = 0, 1, 0 over log x = 0, 1, 2: slope 0, residuals -1/3, 2/3, -1/3, so that the error is
  // sqrt((6/9) / 1 / 2).
  const double e = std::exp(1.0);
  const auto fit = exponent_of({1, e, e * e}, {1, e, 1});
  ASSERT_TRUE(fit);
  EXPECT_NEAR(fit->value, 0, 1e-14);
  EXPECT_NEAR(fit->error, std::sqrt(1.0 / 3), 1e-14);
}

TEST(ReportNumbers, AnIntervalTakesSixPoints) {
  Exponent e{.value = 0.8, .low = 0.6, .high = 1, .points = 6};
  EXPECT_EQ(exponent_text(e), "0.80 (0.60 to 1.00)");
  e.points = 5;
  EXPECT_EQ(exponent_text(e), "0.80 (no interval of 5 points)");
  // t of one degree of freedom is 12.706.
  const double base = std::exp(1.0);
  const auto fit = exponent_of({1, base, base * base}, {1, base, 1});
  EXPECT_NEAR(fit->high, 12.706 * std::sqrt(1.0 / 3), 1e-3);
  EXPECT_EQ(fit->low, -fit->high);
}

TEST(ReportNumbers, WhatWasNeverSeenHasABound) {
  EXPECT_EQ(at_most(114014), "at most 2.6e-05");
  EXPECT_EQ(at_most(2), "at most 1");
  EXPECT_EQ(with_bound(0, 3000), "0 of 3,000 (a rate of at most 0.0010)");
  // The twin: what was seen has none.
  EXPECT_EQ(with_bound(4, 3000), "4 of 3,000");
}

TEST(ReportNumbers, TwoPointsAreNoFit) {
  EXPECT_FALSE(exponent_of({1, 2}, {1, 2}));
  EXPECT_FALSE(exponent_of({1, 2, 0}, {1, 2, 3}));
  EXPECT_FALSE(exponent_of({2, 2, 2}, {1, 2, 3}));
}

TEST(ReportNumbers, AreRoundedForPeople) {
  EXPECT_EQ(rounded(12345.6), "12,346");
  EXPECT_EQ(rounded(0.01234), "0.0123");
  EXPECT_EQ(rounded(0), "0");
  EXPECT_EQ(rounded(10), "10");
  EXPECT_EQ(rounded(1234567), "1,234,567");
  EXPECT_EQ(rounded(-1.5), "-1.50");
  EXPECT_EQ(listed({"a", "b", "c"}), "a, b and c");
  EXPECT_EQ(median({3, 1, 2}), 2);
  EXPECT_EQ(median({4, 1, 2, 3}), 2.5);
}

TEST(ReportText, IsNoMarkup) {
  EXPECT_EQ(html_text("<b>&\"'\n\x01"), "&lt;b&gt;&amp;&quot;&#39;\n ");
  EXPECT_EQ(html_prose("run `a<b` `"), "run <code>a&lt;b</code> `");
  EXPECT_EQ(latex_text("50 % of a_b & 10⁻³ ± 1"), "50 \\% of a\\_b \\& 10$^{-}$$^3$ $\\pm$ 1");
  EXPECT_EQ(gnuplot_text("it's\n\"x\" \\ `rm`"), "'it''s \"x\" \\ `rm`'");
}

TEST(ReportTables, CellsStayCells) {
  const DataTable table{.name = "t",
                        .caption = "c",
                        .columns = {text_column("a,b"), {"n"}},
                        .rows = {{"say \"so\"", "1,234"}}};
  EXPECT_EQ(table_csv(table), "\"a,b\",n\r\n\"say \"\"so\"\"\",\"1,234\"\r\n");
  EXPECT_NE(table_html(table).find("<td class=\"r\">1,234</td>"), std::string::npos);
  EXPECT_NE(table_latex(table).find("\\begin{tabular}{lr}"), std::string::npos);
}

TEST(ReportFigures, IdsOfTwoDrawingsDiffer) {
  const std::string svg =
      "<?xml version=\"1.0\"?>\n<svg><g id=\"a\"><use xlink:href='#p' clip=\"url(#q)\"/></g></svg>";
  EXPECT_EQ(inline_svg(svg, "x-"),
            "<svg><g id=\"x-a\"><use xlink:href='#x-p' clip=\"url(#x-q)\"/></g></svg>");
}

TEST(ReportText, CodeOfMarkdownEndsWhereItEnds) {
  EXPECT_EQ(markdown_code("farcull report results"), "`farcull report results`");
  EXPECT_EQ(markdown_code("a `b` ``c``"), "``` a `b` ``c`` ```");
  EXPECT_EQ(markdown_code("a\nb"), "`a b`");
  EXPECT_EQ(quoted("my results; rm `x`"), "'my results; rm `x`'");
  EXPECT_EQ(quoted("it's"), "'it'\\''s'");
  EXPECT_EQ(quoted("results/a-1"), "results/a-1");
}

Page page_with(const std::vector<Finding>& findings) {
  Page page;
  DrawnChapter drawn;
  drawn.chapter.study = "accuracy";
  drawn.chapter.title = "Accuracy";
  drawn.chapter.findings = findings;
  drawn.stored.declaration.study = "accuracy";
  page.chapters = {drawn};
  return page;
}

TEST(ReportPage, ClaimsNothingThatItsChaptersDeny) {
  const Page broken =
      page_with({broken_promise("first"), broken_promise("second"), {.text = "fine"}});
  const std::string html = page_html(broken);
  EXPECT_EQ(html.find("never misses"), std::string::npos);
  const std::string summary = html.substr(0, html.find("<nav"));
  for (const char* part : {"BROKEN: first", "BROKEN: second", "fine"})
    EXPECT_NE(summary.find(part), std::string::npos) << part;
  const std::string text = page_markdown(broken, "my results");
  EXPECT_LT(text.find("BROKEN: second"), text.find("All of this page"));
  EXPECT_NE(text.find("`farcull report 'my results'`"), std::string::npos);
  // The twin.
  const Page good = page_with({{.text = "fine"}});
  EXPECT_NE(page_html(good).find("never misses"), std::string::npos);
  EXPECT_EQ(page_html(good).find("Broken."), std::string::npos);
  EXPECT_EQ(page_markdown(good, "r").find("Broken."), std::string::npos);
}

TEST(ReportPictures, SayWhatTheyShowThemselves) {
  Picture picture;
  picture.name = "p";
  picture.caption = "Two panels";
  picture.panels = {{"CULLIDE", 12, 40}, {"FAR", 0, 40}};
  std::vector<PanelResult> drawn(2);
  drawn[0].missed = 12;
  drawn[0].colliding = drawn[1].colliding = 40;
  Picture same = picture;
  EXPECT_TRUE(add_counts(same, drawn).empty());
  EXPECT_EQ(same.caption,
            "Two panels. Here CULLIDE misses 12 of 40 colliding pairs and FAR misses 0 of 40 "
            "colliding pairs.");
  // The twin: another device, other counts, a promise that was not kept.
  drawn[0].missed = 13;
  drawn[1].missed = 1;
  drawn[1].broken = true;
  Picture other = picture;
  const std::vector<Finding> broken = add_counts(other, drawn);
  ASSERT_EQ(broken.size(), 1u);
  EXPECT_EQ(printed(broken[0]),
            "BROKEN: in the picture p, FAR misses 1 of 40 colliding pairs, and promises to miss "
            "none.");
  EXPECT_NE(other.caption.find("CULLIDE misses 13 of 40"), std::string::npos);
  EXPECT_NE(other.caption.find("say otherwise: 12 of 40 by CULLIDE and 0 of 40 by FAR missed."),
            std::string::npos);
  drawn.pop_back();
  EXPECT_THROW(add_counts(other, drawn), std::logic_error);
}

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

TEST(ReportLatex, HasEveryFindingFigureAndTable) {
  Page page = page_with({{.text = "50 % of a_b & more"}});
  page.chapters[0].chapter.figures = {two_panels()};
  page.chapters[0].chapter.tables = {{.name = "t", .caption = "c", .columns = {}}};
  const std::string text = page_latex(page);
  for (const char* part :
       {"\\item 50 \\% of a\\_b \\& more.", "{figures/f.pdf}", "\\input{tables/t.tex}"})
    EXPECT_NE(text.find(part), std::string::npos) << part;
  // The twin: a table that is linked alone is not in the text.
  page.chapters[0].chapter.tables[0].in_text = false;
  EXPECT_EQ(page_latex(page).find("\\input"), std::string::npos);
}

class Folder {
 public:
  Folder() {
    path_ = (std::filesystem::temp_directory_path() / "farcull-report-XXXXXX").string();
    if (::mkdtemp(path_.data()) == nullptr) std::abort();
  }
  ~Folder() { std::filesystem::remove_all(path_); }
  Folder(const Folder&) = delete;
  Folder& operator=(const Folder&) = delete;
  const std::string& path() const { return path_; }

 private:
  std::string path_;
};

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
  const Folder folder;
  draw_figure(trap(), folder.path());
  for (const char* kind : {".svg", ".pdf", ".gp", ".dat"}) {
    EXPECT_GT(std::filesystem::file_size(folder.path() + "/trap" + kind), 0u) << kind;
  }
}

TEST(ReportFigures, AWarningOfThePlotterIsAnError) {
  if (!has_gnuplot()) GTEST_SKIP() << "gnuplot is not installed";
  const Folder folder;
  // Nothing but a warning comes of it: all points of the data are the same.
  std::ofstream(folder.path() + "/warns.gp")
      << "set terminal svg\nset output 'x.svg'\n$d << end\n1 1\n1 1\nend\nplot $d\n";
  EXPECT_NE(error_of([&] { run_gnuplot(folder.path(), "warns.gp", "svg"); }).reason.find("warned"),
            std::string::npos);
  std::ofstream(folder.path() + "/fails.gp") << "no command of this name\n";
  EXPECT_EQ(error_of([&] { run_gnuplot(folder.path(), "fails.gp", "svg"); }).reason.find("failed"),
            0u);
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
