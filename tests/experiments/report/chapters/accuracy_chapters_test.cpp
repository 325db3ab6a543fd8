// The chapters of accuracy, error-time and offsets on rows that were made up.
#include <gtest/gtest.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "experiments/report/chapters/chapter.h"
#include "experiments/report/chapters/numbers.h"
#include "experiments/studies/point.h"

namespace farcull {
namespace {

struct Made {
  PointKey point;
  nlohmann::ordered_json counts;
  double ms = 1;
  std::string left_out = {};
};

PointKey cullide_at(int resolution) {
  return key_of(cullide_point(NamedScene{"s"}, Method::cullide, resolution));
}
PointKey far_at(const char* offset, int resolution) {
  return key_of(far_point(NamedScene{"s"}, offset, kBudgetRadius, resolution));
}
PointKey plain(const char* method, int resolution = 0) {
  return {.scene = "s", .method = method, .resolution = resolution};
}

StoredStudy stored_of(const std::string& study, const std::vector<Made>& made) {
  StoredStudy out;
  out.declaration.study = study;
  for (const Made& one : made) {
    Row row;
    row.position = out.rows.size();
    row.point = one.point;
    row.measurement.left_out = one.left_out;
    if (one.left_out.empty()) {
      row.measurement.counts = one.counts;
      row.measurement.times = {{"total", one.ms}, {"total_min", one.ms}, {"total_max", one.ms}};
    }
    out.declaration.points.push_back(one.point);
    out.rows.push_back(row);
  }
  return out;
}

nlohmann::ordered_json counts_of(std::uint64_t missed, bool promises, std::uint64_t kept = 30,
                                 std::uint64_t wrong = 0) {
  return {{"colliding", 20},       {"missed", missed},          {"missed_penetrating", missed},
          {"wrong", wrong},        {"colliding_triangles", 30}, {"missed_triangles", missed},
          {"candidates", 40},      {"kept_triangles", kept},    {"promises", promises},
          {"fragments", 10 * kept}};
}

bool says(const std::vector<Finding>& findings, const std::string& part) {
  return std::any_of(findings.begin(), findings.end(), [&](const Finding& finding) {
    return printed(finding).find(part) != std::string::npos;
  });
}
bool says(const std::vector<std::string>& sentences, const std::string& part) {
  return std::any_of(sentences.begin(), sentences.end(),
                     [&](const std::string& s) { return s.find(part) != std::string::npos; });
}

const Series* series_of(const Chapter& chapter, std::size_t figure, const std::string& name) {
  for (const Series& series : chapter.figures.at(figure).panels.at(0).series) {
    if (series.name == name) return &series;
  }
  return nullptr;
}

std::vector<Made> accuracy_rows(std::uint64_t far_misses) {
  return {{cullide_at(64), counts_of(20, false)},
          {far_at("obb", 64), counts_of(far_misses, true)},
          {cullide_at(4096), counts_of(3, false)},
          {far_at("obb", 4096), counts_of(0, true)}};
}

TEST(AccuracyChapter, ShowsCullideFallingAndFarAtZero) {
  const Chapter chapter = accuracy_chapter(stored_of("accuracy", accuracy_rows(0)));
  EXPECT_FALSE(says(chapter.findings, "BROKEN"));
  EXPECT_TRUE(
      says(chapter.findings,
           "FAR (OBB) missed 0 of 40 (95 % bound: at most 0.072) colliding pairs in 2 runs"));
  EXPECT_TRUE(says(chapter.findings, "20 of 20 colliding pairs are missed at 64 px and 3 at 4096"));
  ASSERT_FALSE(chapter.figures.empty());
  EXPECT_TRUE(chapter.figures[0].panels[0].y.shows_zero);
  ASSERT_NE(series_of(chapter, 0, "CULLIDE"), nullptr);
  EXPECT_EQ(series_of(chapter, 0, "CULLIDE")->y, (std::vector<double>{20, 3}));
  EXPECT_EQ(series_of(chapter, 0, "FAR (OBB)")->y, (std::vector<double>{0, 0}));
}

// The twin: a miss of what promises is the first thing that is said.
TEST(AccuracyChapter, ShoutsAMissOfWhatPromises) {
  const Chapter chapter = accuracy_chapter(stored_of("accuracy", accuracy_rows(1)));
  ASSERT_FALSE(chapter.findings.empty());
  EXPECT_TRUE(
      printed(chapter.findings[0]).starts_with("BROKEN: s, far, obb, 64 px misses 1 of 20"));
  EXPECT_FALSE(says(chapter.findings, "missed 0 of"));
  EXPECT_EQ(series_of(chapter, 0, "FAR (OBB)")->y, (std::vector<double>{1, 0}));
}

TEST(AccuracyChapter, SaysWherePixelsDoNotHelp) {
  std::vector<Made> rows = accuracy_rows(0);
  rows[2].counts = counts_of(20, false);
  EXPECT_TRUE(says(accuracy_chapter(stored_of("accuracy", rows)).findings, "did not help"));
  rows[0].counts = counts_of(2, false);
  EXPECT_TRUE(says(accuracy_chapter(stored_of("accuracy", rows)).findings, "made it worse"));
}

// Of the forms that cull triangles the one with the fewest misses is in the headline, beside the
// published one; objects alone are no rival, since they leave nearly everything.
TEST(AccuracyChapter, ShowsTheStrongestCullide) {
  const auto in = [](const CullideForm& form) {
    return key_of(in_form(cullide_point(NamedScene{"s"}, Method::cullide, 64), form));
  };
  const CullideForm strict = {.rounds = 1, .clear = ClearRule::all, .conservative = true};
  std::vector<Made> rows = {{cullide_at(64), counts_of(20, false)},
                            {in(kPublishedForm), counts_of(9, false)},
                            {in(strict), counts_of(2, false)},
                            {in({.objects_alone = true}), counts_of(0, false)},
                            {far_at("obb", 64), counts_of(0, true)}};
  Chapter chapter = accuracy_chapter(stored_of("accuracy", rows));
  const std::string name = "CULLIDE, one round, all views, conservative";
  EXPECT_TRUE(says(chapter.findings, "Of 3 forms of CULLIDE that cull triangles, \"" + name +
                                         "\" misses the fewest"));
  EXPECT_TRUE(says(chapter.findings, "As published (\"CULLIDE, one round\"), it misses 9 of 20"));
  EXPECT_NE(series_of(chapter, 0, name), nullptr);
  EXPECT_NE(series_of(chapter, 0, "CULLIDE, one round"), nullptr);
  EXPECT_EQ(series_of(chapter, 0, "CULLIDE"), nullptr) << "it is in the figure of all forms";
  EXPECT_NE(series_of(chapter, 1, "CULLIDE"), nullptr);
  EXPECT_NE(series_of(chapter, 1, "CULLIDE, objects alone"), nullptr);
  // The twin: it follows the rows.
  rows[0].counts = counts_of(1, false);
  chapter = accuracy_chapter(stored_of("accuracy", rows));
  EXPECT_TRUE(says(chapter.findings, "\"CULLIDE\" misses the fewest"));
  EXPECT_EQ(series_of(chapter, 0, name), nullptr);
}

TEST(AccuracyChapter, ShowsTheSpreadOfSeeds) {
  std::vector<Made> rows;
  for (const auto& [scene, missed] :
       {std::pair("s", 5), std::pair("s@seed101", 1), std::pair("s@seed102", 4)}) {
    rows.push_back({cullide_at(64), counts_of(static_cast<std::uint64_t>(missed), false)});
    rows.back().point.scene = scene;
  }
  const Chapter chapter = accuracy_chapter(stored_of("accuracy", rows));
  ASSERT_EQ(chapter.figures.at(0).panels.size(), 1u);
  EXPECT_EQ(chapter.figures[0].panels[0].title, "s (3 seeds)");
  EXPECT_EQ(series_of(chapter, 0, "CULLIDE")->y, (std::vector<double>{4}));
  EXPECT_EQ(series_of(chapter, 0, "least and most of the seeds")->y, (std::vector<double>{1, 5}));
}

TEST(AccuracyChapter, ShowsTheSizeOfTriangles) {
  std::vector<Made> rows;
  for (const double pixels : {1, 4}) {
    rows.push_back(
        {key_of(at_mean_pixels(
             in_form(cullide_point(NamedScene{"s"}, Method::cullide, 0), kPublishedForm), pixels)),
         counts_of(pixels > 1 ? 2 : 6, false)});
    rows.back().counts["resolution"] = 100;
    rows.back().counts["mean_pixels"] = pixels;
  }
  const Chapter chapter = accuracy_chapter(stored_of("accuracy", rows));
  EXPECT_TRUE(
      says(chapter.findings, "covers 1 pixel on average: CULLIDE, one round misses 6 of 20"));
  EXPECT_TRUE(
      says(chapter.findings, "covers 4 pixels on average: CULLIDE, one round misses 2 of 20"));
}

// Known values: 1 - 0.05^(1/100), and tables of Clopper and Pearson's interval for 5 of 100.
TEST(Numbers, RatesHaveTheirIntervals) {
  EXPECT_NEAR(rate_of(0, 100).high, 0.029513, 1e-6);
  EXPECT_EQ(rate_of(0, 100).low, 0);
  EXPECT_NEAR(rate_of(5, 100).low, 0.016432, 1e-6);
  EXPECT_NEAR(rate_of(5, 100).high, 0.112835, 1e-6);
  EXPECT_EQ(rate_of(7, 7).high, 1);
  EXPECT_NEAR(rate_of(0, 114'014).high, 3.0 / 114'014, 1e-7);
  EXPECT_EQ(rate_text(0, 0), "0 of 0");
  EXPECT_NE(rate_text(1, 100), rate_text(0, 100));
}

TEST(AccuracyChapter, CopesWithMissingRowsAndSaysSo) {
  std::vector<Made> rows = accuracy_rows(0);
  rows[0].left_out = "a mesh is not there";
  StoredStudy stored = stored_of("accuracy", rows);
  stored.rows.pop_back();
  const Chapter chapter = accuracy_chapter(stored);
  EXPECT_TRUE(says(chapter.limits, "Left out at 1 of 4 points: a mesh is not there."));
  EXPECT_TRUE(says(chapter.limits, "Not finished: 3 of 4 points"));
  stored.rows.clear();
  EXPECT_TRUE(accuracy_chapter(stored).figures.empty());
  EXPECT_TRUE(error_time_chapter(stored_of("error-time", {})).figures.empty());
  EXPECT_TRUE(offsets_chapter(stored_of("offsets", {})).figures.empty());
}

std::vector<Made> timed_rows() {
  return {{plain("fcl-float"), counts_of(2, false, 30, 3), 1},
          {plain("far-pairs"), counts_of(0, true), 4},
          {plain("exact"), counts_of(0, false), 9},
          {cullide_at(64), counts_of(8, false), 2}};
}

TEST(ErrorTimeChapter, HasTheFrontOfWhatNothingBeats) {
  const Chapter chapter = error_time_chapter(stored_of("error-time", timed_rows()));
  ASSERT_EQ(chapter.tables.at(0).rows.size(), 2u) << "cullide and exact are beaten";
  EXPECT_EQ(chapter.tables[0].rows[0][1], "fcl-float");
  EXPECT_EQ(chapter.tables[0].rows[1][1], "FAR pairs");
  ASSERT_NE(series_of(chapter, 0, "Pareto front"), nullptr);
  EXPECT_EQ(series_of(chapter, 0, "Pareto front")->x, (std::vector<double>{1, 4, 4, 9}));
  EXPECT_EQ(series_of(chapter, 0, "Pareto front")->y, (std::vector<double>{5, 5, 0, 0}));
  EXPECT_TRUE(says(chapter.findings, "fcl-float misses 2 of 20 colliding pairs and reports 3"));
  EXPECT_TRUE(says(chapter.findings,
                   "Fastest method without an error on s: FAR pairs, 4 ms; the next method, exact, "
                   "takes 2.25 times"));
  EXPECT_TRUE(says(chapter.findings, "Faster on s, with errors: fcl-float (5 of 20 wrong, 1 ms)."));
}

// 9 over 4 in the median. Of three runs each, more than one draw in forty has 8 over 5, and as many
// have 12 over 3, so the bootstrap's interval goes as far.
TEST(ErrorTimeChapter, GivesRatiosWithTheirIntervals) {
  StoredStudy stored = stored_of("error-time", timed_rows());
  const auto runs = [&](std::size_t row, const std::vector<double>& ms) {
    stored.rows.at(row).measurement.times["totals"] = ms;
  };
  runs(1, {4, 3, 5});
  runs(2, {12, 8, 9});
  EXPECT_TRUE(says(error_time_chapter(stored).findings, "takes 2.25 (1.60 to 4) times as long"));
}

// The twin: the front follows the rows, whoever they favour.
TEST(ErrorTimeChapter, GivesTheFrontToWhoeverIsAhead) {
  std::vector<Made> rows = timed_rows();
  rows[2].ms = 0.5;
  const Chapter chapter = error_time_chapter(stored_of("error-time", rows));
  ASSERT_EQ(chapter.tables.at(0).rows.size(), 1u);
  EXPECT_EQ(chapter.tables[0].rows[0][1], "exact");
  EXPECT_TRUE(
      says(chapter.findings, "on s: exact, 0.500 ms; the next method, FAR pairs, takes 8 times"));
  EXPECT_FALSE(says(chapter.findings, "Faster on s"));
}

// FAR takes 4 ms: the CULLIDE of 3 ms counts, that of 5 ms does not, though it misses less.
TEST(ErrorTimeChapter, ComparesCullideInTheTimeOfFar) {
  const auto strict = [](int resolution) {
    return key_of(
        in_form(cullide_point(NamedScene{"s"}, Method::cullide, resolution), kPublishedForm));
  };
  std::vector<Made> rows = {{far_at("obb", 64), counts_of(0, true), 4},
                            {cullide_at(64), counts_of(9, false), 2},
                            {strict(128), counts_of(7, false), 3},
                            {strict(256), counts_of(1, false), 5}};
  Chapter chapter = error_time_chapter(stored_of("error-time", rows));
  EXPECT_TRUE(says(chapter.findings, "misses pairs in 1 of 1 cases"));
  EXPECT_TRUE(says(chapter.findings,
                   "s: FAR (OBB) is fastest at 64 px (4 ms, 0 of 20 missed); within that time "
                   "CULLIDE, one round at 128 px misses the fewest, 7 of 20 (3 ms)."));
  // The twins: a faster one counts, and where none is as fast that is said.
  rows[3].ms = 4;
  EXPECT_TRUE(says(error_time_chapter(stored_of("error-time", rows)).findings,
                   "CULLIDE, one round at 256 px misses the fewest, 1 of 20"));
  rows[0].ms = 1;
  EXPECT_TRUE(says(error_time_chapter(stored_of("error-time", rows)).findings,
                   "misses pairs in 0 of 1 cases of scene and resolution of FAR, and no CULLIDE is "
                   "as fast in 1"));
}

// Scenes that are drawn with several seeds are one: errors are summed, times are medians.
TEST(ErrorTimeChapter, JoinsSeeds) {
  std::vector<Made> rows;
  for (const auto& [scene, ms] :
       {std::pair("s", 1.0), std::pair("s@seed101", 9.0), std::pair("s@seed102", 2.0)}) {
    rows.push_back({plain("far-pairs"), counts_of(0, true), ms});
    rows.back().point.scene = scene;
  }
  const Chapter chapter = error_time_chapter(stored_of("error-time", rows));
  EXPECT_TRUE(says(chapter.findings, "on s (3 seeds): FAR pairs, 2 ms."));
  EXPECT_EQ(chapter.tables.at(0).rows.at(0).back(), "60");
}

TEST(ErrorTimeChapter, NamesLibrariesThatAreNotThere) {
  std::vector<Made> rows = timed_rows();
  rows[0].left_out = "built without FCL (Debian: libfcl-dev)";
  const Chapter chapter = error_time_chapter(stored_of("error-time", rows));
  EXPECT_TRUE(says(chapter.limits, "built without FCL"));
  EXPECT_EQ(series_of(chapter, 0, "fcl-float"), nullptr);
  rows[1].counts = counts_of(1, true);
  EXPECT_TRUE(
      says(error_time_chapter(stored_of("error-time", rows)).findings, "BROKEN: s, far-pairs"));
}

TEST(OffsetsChapter, ComparesAndShoutsWhereTheSmallerSolidKeepsMore) {
  std::vector<Made> rows = {{far_at("obb", 64), counts_of(0, true, 40), 2},
                            {far_at("exact", 64), counts_of(0, true, 30), 6},
                            {plain("far-pairs", 64), counts_of(0, true, 20), 1}};
  const Chapter good = offsets_chapter(stored_of("offsets", rows));
  EXPECT_FALSE(says(good.findings, "BROKEN"));
  EXPECT_TRUE(says(good.findings, "fewer triangles than boxes at 1 of 1 points"));
  EXPECT_TRUE(says(good.findings, "FAR (exact) against FAR (OBB)"));
  EXPECT_EQ(good.figures.size(), 4u);
  rows[1].counts = counts_of(0, true, 41);
  EXPECT_TRUE(says(offsets_chapter(stored_of("offsets", rows)).findings,
                   "BROKEN: s, far, exact, 64 px keeps 41 triangles where boxes keep 40"));
}

}  // namespace
}  // namespace farcull
