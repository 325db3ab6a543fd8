// What figures, tables and the page are made of. The whole report in a browser: report_test.sh.
#include "experiments/report/report.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <limits>
#include <set>

#include "core/base/base64.h"
#include "experiments/report/chapters/numbers.h"
#include "experiments/report/chapters/rows.h"
#include "experiments/report/figure_layout.h"
#include "experiments/report/figures.h"
#include "experiments/report/gnuplot.h"
#include "experiments/report/html.h"
#include "experiments/report/latex.h"
#include "experiments/report/markdown.h"
#include "experiments/report/pictures.h"
#include "experiments/report/style.h"
#include "experiments/report/tables.h"
#include "experiments/system/shell_word.h"
#include "tests/lab/test.h"

namespace farcull {
namespace {

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

TEST(ReportPictures, LeadToTheirPageWhereThereIsOne) {
  Page page = page_with({{.text = "fine"}});
  DrawnPicture drawn{.picture = {}, .png = "PNG", .page = true, .left_out = {}};
  drawn.picture.name = "accuracy-compare";
  drawn.picture.arguments.scene = {"two-tori"};
  drawn.picture.arguments.panels = {RunOptions{}};
  page.chapters[0].pictures = {drawn};
  EXPECT_NE(page_html(page).find("href=\"pages/accuracy-compare.html\""), std::string::npos);
  page.chapters[0].pictures[0].page = false;
  EXPECT_EQ(page_html(page).find("pages/"), std::string::npos);
}

TEST(ReportLatex, HasEveryFindingFigureAndTable) {
  Page page = page_with({{.text = "50 % of a_b & more"}});
  page.chapters[0].chapter.figures = {{.name = "f", .title = "t", .caption = "c", .panels = {}}};
  page.chapters[0].chapter.tables = {{.name = "t", .caption = "c", .columns = {}}};
  const std::string text = page_latex(page);
  for (const char* part :
       {"\\item 50 \\% of a\\_b \\& more.", "{figures/f.pdf}", "\\input{tables/t.tex}"})
    EXPECT_NE(text.find(part), std::string::npos) << part;
  // The twin: a table that is linked alone is not in the text.
  page.chapters[0].chapter.tables[0].in_text = false;
  EXPECT_EQ(page_latex(page).find("\\input"), std::string::npos);
}

}  // namespace
}  // namespace farcull
