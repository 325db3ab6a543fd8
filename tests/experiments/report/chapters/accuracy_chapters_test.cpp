// The chapters of accuracy, error-time and offsets on rows that were made up.
#include <gtest/gtest.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "experiments/report/chapters/chapter.h"
#include "experiments/studies/points.h"

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
  EXPECT_TRUE(says(chapter.findings, "FAR (OBB) missed 0 of 40 colliding pairs (2 runs)"));
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
                   "that of FAR pairs; the next method, exact, takes 2.25 (2.25 to 2.25) times"));
}

// 9 over 4 in the median; at least 8 over 5, at most 12 over 3.
TEST(ErrorTimeChapter, GivesRatiosWithWhatSingleRunsAllow) {
  StoredStudy stored = stored_of("error-time", timed_rows());
  const auto spread = [&](std::size_t row, double least, double most) {
    stored.rows.at(row).measurement.times["total_min"] = least;
    stored.rows.at(row).measurement.times["total_max"] = most;
  };
  spread(1, 3, 5);
  spread(2, 8, 12);
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
      says(chapter.findings, "that of exact; the next method, FAR pairs, takes 8 (8 to 8)"));
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
