// The chapters of radius, precision and stability on rows that were made up.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <nlohmann/json.hpp>
#include <string>

#include "experiments/report/chapters/chapter.h"
#include "experiments/report/chapters/rows.h"
#include "experiments/studies/point.h"

namespace farcull {
namespace {

using Json = nlohmann::ordered_json;

bool says(const std::vector<Finding>& findings, const std::string& part) {
  return std::any_of(findings.begin(), findings.end(), [&](const Finding& finding) {
    return printed(finding).find(part) != std::string::npos;
  });
}
bool says(const std::vector<std::string>& sentences, const std::string& part) {
  return std::any_of(sentences.begin(), sentences.end(),
                     [&](const std::string& s) { return s.find(part) != std::string::npos; });
}

struct Rows {
  StoredStudy stored;
  explicit Rows(const std::string& study) { stored.declaration.study = study; }
  Rows& add(const PointKey& point, const Json& counts, const std::string& left_out = "") {
    Row row;
    row.position = stored.rows.size();
    row.point = point;
    row.measurement.counts = counts;
    row.measurement.left_out = left_out;
    row.measurement.times = {{"total", 2.0}};
    stored.declaration.points.push_back(point);
    stored.rows.push_back(row);
    return *this;
  }
};

PointKey lemma_point(const std::string& generator, const std::string& radius,
                     const std::string& mode = "fragment", const std::string& method = "lemma") {
  return {.scene = LemmaScene{generator, 100}.name(),
          .method = method,
          .offset = "obb",
          .radius = column_of<RadiusRule>(radius),
          .depth_format = {},
          .depth_mode = column_of<DepthMode>(mode),
          .resolution = 0,
          .views = {},
          .frame = -1,
          .seed = 1};
}

Json lemma_counts(std::uint64_t no_sample, std::uint64_t not_bounding, double radius_px,
                  double largest_px = 0) {
  return {{"points", 100},
          {"violations", no_sample + not_bounding},
          {"no_sample", no_sample},
          {"not_bounding", not_bounding},
          {"rounded", 0},
          {"largest_px", largest_px},
          {"largest_steps", largest_px * 1000},
          {"step_px", 0.001},
          {"radius_px", radius_px},
          {"budget_px", 0.71}};
}

PointKey far_point(const std::string& radius) {
  return {.scene = "degenerate",
          .method = "far",
          .offset = "obb",
          .radius = column_of<RadiusRule>(radius),
          .depth_format = {},
          .depth_mode = DepthMode::fragment,
          .resolution = 64,
          .views = {},
          .frame = -1,
          .seed = 0};
}

Json run_counts(std::uint64_t missed, bool promises, double radius_px = 0.71) {
  return {{"colliding", 20},           {"missed", missed},
          {"colliding_triangles", 10}, {"missed_triangles", missed},
          {"candidates", 40},          {"kept_triangles", 30},
          {"triangles", 100},          {"promises", promises},
          {"radius_px", radius_px},    {"pixel_size", 0.5}};
}

Rows radius_rows(std::uint64_t at_budget) {
  Rows rows("radius");
  rows.add(lemma_point("needles", "0.5"), lemma_counts(60, 0, 0.355))
      .add(lemma_point("needles", "budget"), lemma_counts(at_budget, 0, 0.71))
      .add(lemma_point("needles", "1.1"), lemma_counts(0, 0, 0.781))
      .add(lemma_point("needles", "published"), lemma_counts(25, 3, 0.7071, 7.5))
      .add(lemma_point("needles", "budget", "fixed"), lemma_counts(0, 4, 0.71, 2))
      .add(far_point("0.5"), run_counts(7, false, 0.355))
      .add(far_point("budget"), run_counts(0, true))
      .add(far_point("published"), run_counts(3, false, 0.7071));
  return rows;
}

TEST(RadiusChapter, SaysWhereThePublishedRadiusFailsAndThatTheBudgetDoesNot) {
  const Chapter chapter = radius_chapter(radius_rows(0).stored);
  EXPECT_FALSE(says(chapter.findings, "BROKEN"));
  EXPECT_TRUE(says(chapter.findings, "At the budget radius and beyond, fragment depth: 0 of 200"));
  EXPECT_TRUE(says(chapter.findings,
                   "The published radius, 0.9959 of the budget, fails, fragment "
                   "depth: 28 of 100 points, 25 of them without a sample, others "
                   "up to 7.50 px outside their bounds; on needles (28 of 100)."));
  EXPECT_TRUE(says(chapter.findings,
                   "degenerate, fragment depth: pairs are missed up to the factor "
                   "0.5; the published radius misses 3 of 20."));
  ASSERT_EQ(chapter.figures.size(), 2u);
  const auto& panels = chapter.figures[0].panels;
  const auto panel = std::find_if(panels.begin(), panels.end(),
                                  [](const Panel& p) { return p.title == "fragment depth"; });
  ASSERT_NE(panel, panels.end());
  ASSERT_EQ(panel->marks.size(), 1u);
  EXPECT_EQ(panel->marks[0].at, 1);
  EXPECT_TRUE(panel->y.shows_zero);
  EXPECT_EQ(panel->series[0].name, "needles");
  EXPECT_EQ(panel->series[0].x, (std::vector<double>{0.5, 1, 1.1}));
  EXPECT_EQ(panel->series[0].y, (std::vector<double>{60, 0, 0}));
  const Series& published = panel->series.back();
  EXPECT_EQ(published.name, "published radius, each generator");
  EXPECT_EQ(published.y, (std::vector<double>{28}));
  EXPECT_NEAR(published.x.at(0), 0.7071 / 0.71, 1e-12);
}

PointKey placed_point(const std::string& method, const std::string& radius, const char* scene) {
  PointKey out = far_point(radius);
  out.scene = scene;
  out.method = method;
  out.resolution = 1024;
  return out;
}

Json placed_counts(std::uint64_t missed, bool promises = false) {
  return {{"placements", 1000},
          {"colliding_placements", 900},
          {"missed_placements", missed},
          {"colliding", 4000},
          {"missed", missed},
          {"largest_miss_px", missed > 0 ? 0.25 : 0.0},
          {"promises", promises}};
}

// The first thing that is said: on scenes nothing, at random so often, on constructed ones for
// sure.
TEST(RadiusChapter, BeginsWithHowOftenThePublishedRadiusMisses) {
  PointKey corners = far_point("published");
  corners.scene = "pixel-corners";
  const auto chapter_of = [&](std::uint64_t on_scenes, std::uint64_t placed) {
    Rows rows("radius");
    rows.add(far_point("published"), {{"colliding", 20}, {"missed", on_scenes}})
        .add(corners, {{"colliding", 100}, {"missed", 90}})
        .add(placed_point("far-snapped-8", "published", "dragon-bunny@crossing:1:1000"),
             placed_counts(placed))
        .add(placed_point("far", "published", "dragon-bunny@crossing:1:1000"), placed_counts(0))
        .add(placed_point("far-snapped-8", "budget", "dragon-bunny@crossing:1:1000"),
             placed_counts(0, true));
    return radius_chapter(rows.stored);
  };
  const Chapter chapter = chapter_of(0, 2);
  ASSERT_GE(chapter.findings.size(), 3u);
  EXPECT_EQ(printed(chapter.findings[0]),
            "On scenes that were not constructed against it, the published radius missed 0 of 20 "
            "(95 % bound: at most 0.14) colliding pairs in 1 run with fragment depth; its failure "
            "end to end rests on the constructed pixel-corners, where it missed 90 of 100.");
  EXPECT_TRUE(says(chapter.findings,
                   "corners not snapped, the published radius missed something in "
                   "0 of 900 (95 % bound: at most 0.0033) placements."));
  EXPECT_TRUE(says(chapter.findings,
                   "8 subpixel bits, the published radius missed something in "
                   "2 of 900 (0.0022, 95 % interval 0.00027 to 0.0080) placements; "
                   "the longest intersection that it missed is 0.250 px long."));
  const auto figure = std::find_if(chapter.figures.begin(), chapter.figures.end(),
                                   [](const Figure& f) { return f.name == "radius-placements"; });
  ASSERT_NE(figure, chapter.figures.end());
  EXPECT_EQ(figure->panels.at(0).series.at(0).x, (std::vector<double>{0, 8}));
  EXPECT_FALSE(says(chapter.findings, "BROKEN"));
  // The twin: a miss on a scene takes the sentence about constructed ones away.
  EXPECT_FALSE(says(chapter_of(3, 2).findings, "rests on the constructed"));
}

TEST(RadiusChapter, ShoutsAMissedPlacementAtTheBudget) {
  Rows rows("radius");
  rows.add(placed_point("far-snapped-8", "budget", "dragon-bunny@crossing:1:1000"),
           placed_counts(1, true));
  EXPECT_TRUE(says(radius_chapter(rows.stored).findings, "BROKEN: dragon-bunny@crossing"));
}

TEST(RadiusChapter, SaysWhereThePublishedRadiusHolds) {
  Rows rows("radius");
  rows.add(lemma_point("needles", "published"), lemma_counts(0, 0, 0.7071));
  EXPECT_TRUE(says(radius_chapter(rows.stored).findings, "violates none of 100 points"));
}

// The twin: a violation at the budget is said first, and no sentence says that there is none.
TEST(RadiusChapter, ShoutsAViolationAtTheBudget) {
  const Chapter chapter = radius_chapter(radius_rows(2).stored);
  ASSERT_FALSE(chapter.findings.empty());
  EXPECT_TRUE(
      printed(chapter.findings[0])
          .starts_with(
              "BROKEN: at 1 of the budget radius, fragment depth, 2 of 100 points of the generator "
              "\"needles\" are violated"));
  EXPECT_FALSE(says(chapter.findings, "At the budget radius and beyond, fragment depth"));
}

TEST(RadiusChapter, ShoutsOnTheWorstCanvasToo) {
  Rows rows("radius");
  rows.add(lemma_point("needles", "1.1", "fragment", "lemma-worst"), lemma_counts(0, 1, 0.8, 1));
  EXPECT_TRUE(says(radius_chapter(rows.stored).findings,
                   "BROKEN: at 1.1 of the budget radius, worst canvas"));
}

// Fixed-function depth promises nothing, so its violations are a result.
TEST(RadiusChapter, DoesNotShoutOfFixedFunctionDepth) {
  const Chapter chapter = radius_chapter(radius_rows(0).stored);
  EXPECT_TRUE(says(chapter.findings,
                   "fixed-function depth: 4 of 100 points are violated (it "
                   "promises nothing)"));
}

PointKey precision_point(const std::string& radius, const std::string& mode,
                         const std::string& format) {
  PointKey out = lemma_point("almost flat", radius, mode);
  out.depth_format = column_of<DepthFormat>(format);
  out.resolution = 508;
  return out;
}

Rows precision_rows(std::uint64_t at_budget) {
  Rows rows("precision");
  Json rounded = lemma_counts(0, at_budget, 0.71, at_budget > 0 ? 0.5 : 0.0004);
  rounded["rounded"] = 5;
  rows.add(precision_point("budget", "fragment", "float32"), rounded)
      .add(precision_point("published", "fixed", "float32"), lemma_counts(10, 20, 0.7071, 7.25))
      .add(precision_point("budget", "fixed", "fixed24"), lemma_counts(0, 0, 0.71));
  return rows;
}

TEST(PrecisionChapter, TellsRoundingFromViolations) {
  const Chapter chapter = precision_chapter(precision_rows(0).stored);
  EXPECT_FALSE(says(chapter.findings, "BROKEN"));
  EXPECT_TRUE(says(chapter.findings,
                   "fragment, budget radius, 32-bit float: all 100 points have "
                   "samples that bound them, 5 of them after rounding of up to "
                   "0.400 steps."));
  EXPECT_TRUE(says(chapter.findings,
                   "fixed-function, published radius, 32-bit float: 10 of 100 "
                   "points have no sample, 20 are not bounded, the worst by "
                   "7,250 steps, 7.25 px (almost flat)."));
  ASSERT_EQ(chapter.figures.size(), 1u);
  EXPECT_EQ(chapter.figures[0].panels.size(), 2u);  // 32-bit float and 24 bits
}

TEST(PrecisionChapter, ShoutsAViolationOfFragmentDepth) {
  const Chapter chapter = precision_chapter(precision_rows(3).stored);
  ASSERT_FALSE(chapter.findings.empty());
  EXPECT_TRUE(printed(chapter.findings[0])
                  .starts_with("BROKEN: fragment depth at the budget radius, 32-bit"));
  EXPECT_TRUE(says(chapter.findings, "3 of 100 points of the generator \"almost flat\""));
  EXPECT_FALSE(says(chapter.findings, "all 100 points have samples that bound them, 5"));
}

PointKey stability_point(const std::string& scene, const std::string& method, long frame = -1) {
  return {.scene = scene,
          .method = method,
          .offset = method == "far" ? "obb" : "",
          .radius = column_of<RadiusRule>(method == "far" ? "budget" : ""),
          .depth_format = {},
          .depth_mode = {},
          .resolution = 0,
          .views = {},
          .frame = frame,
          .seed = 0};
}

Rows stability_rows(std::uint64_t far_misses) {
  Rows rows("stability");
  for (const char* scene : {"slivers:200:1e2", "slivers:200:1e12"}) {
    const bool last = std::string(scene).ends_with("1e12");
    rows.add(stability_point(scene, "cullide"), run_counts(last ? 20 : 5, false))
        .add(stability_point(scene, "fcl-float"), {{"colliding", 20},
                                                   {"missed", last ? 4 : 0},
                                                   {"wrong", last ? 6 : 0},
                                                   {"candidates", 20},
                                                   {"promises", false}})
        .add(stability_point(scene, "far"), run_counts(last ? far_misses : 0, true))
        .add(stability_point(scene, "exact"), run_counts(0, false));
  }
  Json risk = run_counts(0, true);
  risk["at_risk"] = 7;
  rows.add(stability_point("gap:216:-1e3", "far"), risk)
      .add(stability_point("gap:216:1e3", "far"), run_counts(0, true))
      .add(stability_point("crowd:60@offset-1e9", "far"), run_counts(0, true))
      .add(stability_point("cloth:450:1e8", "far-pairs", 40), run_counts(0, true))
      .add(stability_point("cloth:450:1e8@apart", "far", 40), run_counts(0, true));
  return rows;
}

TEST(StabilityChapter, SaysWhoMissesAndWhatIsKept) {
  const Chapter chapter = stability_chapter(stability_rows(0).stored);
  EXPECT_FALSE(says(chapter.findings, "BROKEN"));
  EXPECT_TRUE(says(chapter.findings,
                   "missed 0 of 140 (95 % bound: at most 0.021) colliding pairs in 7 runs"));
  EXPECT_TRUE(
      says(chapter.findings, "CULLIDE missed pairs, at worst: slivers (aspect 1e12: 20 of 20)."));
  EXPECT_TRUE(
      says(chapter.findings, "fcl-float missed pairs, at worst: slivers (aspect 1e12: 4 of 20)."));
  EXPECT_TRUE(says(chapter.findings,
                   "fcl-float reported pairs that do not collide, at worst: slivers "
                   "(aspect 1e12: 6)."));
  EXPECT_TRUE(says(chapter.findings, "FAR (OBB) keeps for each triangle that collides: slivers 3"));
  ASSERT_EQ(chapter.figures.size(), 2u);
  std::vector<std::string> titles;
  for (const Panel& panel : chapter.figures[0].panels) titles.push_back(panel.title);
  EXPECT_EQ(titles,
            (std::vector<std::string>{"slivers", "overlaps", "gaps", "far from the origin",
                                      "cloth against itself and a sphere", "cloth on a sphere"}));
  const Panel& slivers = chapter.figures[0].panels[0];
  EXPECT_EQ(slivers.series[0].name, "CULLIDE");
  EXPECT_EQ(slivers.series[0].x, (std::vector<double>{1e2, 1e12}));
  EXPECT_EQ(slivers.series[0].y, (std::vector<double>{25, 100}));
  std::map<std::string, std::string> at_risk;  // of FAR, by family
  for (const auto& row : chapter.tables.at(0).rows) {
    if (row.at(1).starts_with("FAR (OBB)")) at_risk[row.at(0).substr(0, 8)] = row.at(5);
  }
  EXPECT_EQ(at_risk["overlaps"], "7");
  EXPECT_EQ(at_risk["gaps, ga"], "-") << "not asked there";
}

TEST(StabilityChapter, ShoutsAMissOfWhatPromises) {
  const Chapter chapter = stability_chapter(stability_rows(1).stored);
  ASSERT_FALSE(chapter.findings.empty());
  EXPECT_TRUE(printed(chapter.findings[0]).starts_with("BROKEN: slivers:200:1e12, far, obb"));
  EXPECT_FALSE(says(chapter.findings, " missed 0 of "));
}

using ChapterOf = Chapter (*)(const StoredStudy&);

struct Promising {
  const char* study;
  ChapterOf of;
  PointKey point;
};

std::vector<Promising> promising() {
  const auto on = [](const char* scene, long frame = -1) {
    PointKey out = stability_point(scene, "far", frame);
    out.resolution = 64;
    return out;
  };
  PointKey stored = precision_point("budget", "fragment", "float32");
  return {{"accuracy", accuracy_chapter, on("s")},
          {"error-time", error_time_chapter, on("s")},
          {"radius", radius_chapter, far_point("budget")},
          {"radius", radius_chapter, lemma_point("needles", "budget")},
          {"radius", radius_chapter, lemma_point("needles", "1.1", "fragment", "lemma-worst")},
          {"offsets", offsets_chapter, on("s")},
          {"precision", precision_chapter, stored},
          {"stability", stability_chapter, on("slivers:200:1e2")},
          {"efficiency", efficiency_chapter, on("cloth:450", 3)},
          {"scaling", scaling_chapter, on("crowd:100")}};
}

// One row of what promises; `failed` of its pairs or points.
Chapter with_one_row(const Promising& p, std::uint64_t failed) {
  const bool lemma = p.point.method.starts_with("lemma");
  Json counts = lemma ? lemma_counts(failed, 0, 0.71) : run_counts(failed, true);
  counts["promises"] = true;
  Rows rows(p.study);
  if (!lemma) rows.add(stability_point("s", "exact", p.point.frame), run_counts(0, false));
  if (std::string(p.study) == "stability") {
    rows.stored.rows.clear();
    rows.stored.declaration.points.clear();
  }
  rows.add(p.point, counts);
  return p.of(rows.stored);
}

TEST(EveryChapter, BeginsWithThePromiseThatWasNotKept) {
  for (const Promising& p : promising()) {
    const Chapter chapter = with_one_row(p, 1);
    ASSERT_FALSE(chapter.findings.empty()) << p.study;
    EXPECT_TRUE(printed(chapter.findings[0]).starts_with("BROKEN:"))
        << p.study << printed(chapter.findings[0]);
    EXPECT_EQ(std::count_if(chapter.findings.begin(), chapter.findings.end(), is_broken), 1)
        << p.study << ": a row is said once";
    EXPECT_FALSE(says(chapter.findings, " missed 0 of ")) << p.study;
    EXPECT_FALSE(says(chapter.findings, "violated at 0 of ")) << p.study;
  }
}

// The twin: without a miss nobody shouts, and what was kept is said in its own unit.
TEST(EveryChapter, DoesNotShoutWherePromisesAreKept) {
  for (const Promising& p : promising()) {
    const Chapter chapter = with_one_row(p, 0);
    EXPECT_FALSE(says(chapter.findings, "BROKEN")) << p.study;
    const bool lemma = p.point.method.starts_with("lemma");
    EXPECT_TRUE(says(chapter.findings,
                     lemma ? "at 0 of 100 (95 % bound: at most 0.030) points in 1 run."
                           : "missed 0 of 20 (95 % bound: at most 0.14) colliding pairs in 1 run."))
        << p.study;
    EXPECT_FALSE(says(chapter.findings, "of 0 colliding pairs")) << p.study;
    EXPECT_FALSE(says(chapter.findings, "do not say") || says(chapter.findings, "does not say"));
  }
}

TEST(EveryChapter, SaysOfWhichRowsNobodyKnowsWhatTheyMissed) {
  for (const Promising& p : promising()) {
    Json counts = p.point.method == "far" ? run_counts(0, true) : lemma_counts(0, 0, 0.71);
    counts["promises"] = true;
    counts.erase("missed");
    counts.erase("violations");
    Rows rows(p.study);
    rows.add(p.point, counts);
    const Chapter chapter = p.of(rows.stored);
    EXPECT_TRUE(says(chapter.findings, "One row of methods that promise does not say")) << p.study;
    EXPECT_FALSE(says(chapter.findings, " missed 0 of ")) << p.study;
    EXPECT_FALSE(says(chapter.findings, "violated at 0 of ")) << p.study;
  }
}

TEST(EfficiencyChapter, SumsFramesThatAllOfThemHave) {
  const auto rows_of = [](bool partial) {
    Rows rows("efficiency");
    for (const long frame : {0, 1}) {
      for (const char* method : {"i-collide", "far", "cullide", "quick-cullide"}) {
        if (partial && frame == 1 && std::string(method) == "quick-cullide") continue;
        Json counts = run_counts(std::string(method) == "cullide" ? 3 : 0, false);
        counts["queries"] = std::string(method) == "cullide" ? 10 : 5;
        counts["draws"] = 100;
        rows.add(stability_point("s", method, frame), counts);
        rows.stored.rows.back().measurement.times["total"] = frame == 0 ? 2.0 : 4.0;
      }
    }
    return rows;
  };
  const auto table_of = [](const Chapter& chapter, const char* name) {
    return std::find_if(chapter.tables.begin(), chapter.tables.end(),
                        [&](const DataTable& table) { return table.name == name; })
        ->rows.at(0);
  };
  const Chapter half = efficiency_chapter(rows_of(true).stored);
  EXPECT_EQ(table_of(half, "efficiency-quick"),
            (std::vector<std::string>{"s", "1", "0.500", "1", "20", "3", "0", "0"}));
  EXPECT_EQ(table_of(half, "efficiency-times").at(3), "2") << "FAR, as fast as in frame 0";
  // The twin: with all rows both frames count.
  const Chapter whole = efficiency_chapter(rows_of(false).stored);
  EXPECT_EQ(table_of(whole, "efficiency-quick"),
            (std::vector<std::string>{"s", "2", "0.500", "1", "40", "6", "0", "0"}));
  EXPECT_EQ(table_of(whole, "efficiency-times").at(3), "3 (2 to 4)") << "drawn from both frames";
}

TEST(ScalingChapter, SaysWhatIsMissed) {
  Rows rows("scaling");
  for (const int side : {128, 512}) {
    PointKey cullide = stability_point("crowd:100", "cullide");
    cullide.resolution = side;
    rows.add(cullide, run_counts(side == 128 ? 4 : 1, false));
    rows.stored.rows.back().measurement.counts["objects"] = 100;
  }
  const Chapter chapter = scaling_chapter(rows.stored);
  EXPECT_TRUE(says(chapter.findings, "CULLIDE missed 5 of 40 colliding pairs over all sizes."));
  EXPECT_EQ(chapter.tables.back().rows.at(0),
            (std::vector<std::string>{"CULLIDE", "2", "40", "5", "0.125"}));
  ASSERT_FALSE(chapter.figures.empty());
  EXPECT_NE(chapter.figures[0].caption.find("at 128 and 512 px"), std::string::npos);
}

TEST(ScalingChapter, FitsAnIntervalToSixPointsAndNoneToFewer) {
  const auto chapter_of_points = [](int points) {
    Rows rows("scaling");
    for (int i = 0; i < points; ++i) {
      const int objects = 10 << i;
      rows.add(stability_point("crowd:" + std::to_string(objects), "exact"), run_counts(0, false));
      Row& row = rows.stored.rows.back();
      row.measurement.counts["objects"] = objects;
      // As n^2, with a spread over nine runs.
      Json runs = Json::array();
      for (int run = 0; run < 9; ++run)
        runs.push_back(1e-3 * objects * objects * (0.96 + 0.01 * run));
      row.measurement.times["totals"] = runs;
    }
    return scaling_chapter(rows.stored);
  };
  const Chapter six = chapter_of_points(6);
  EXPECT_TRUE(says(six.findings, "exact 2.00 (2.00 to 2.00)"));
  const Series& series = six.figures.at(0).panels.at(0).series.at(0);
  ASSERT_EQ(series.y.size(), 6u);
  for (std::size_t i = 0; i < 6; ++i) {
    // Of nine runs the second least and the second largest.
    EXPECT_NEAR(series.y_low[i] / series.y[i], 0.97, 1e-12);
    EXPECT_NEAR(series.y_high[i] / series.y[i], 1.03, 1e-12);
  }
  EXPECT_EQ(six.figures[0].caption.find("n = 6 points, each the median of 9 runs"), 0u);
  // The twin.
  EXPECT_TRUE(says(chapter_of_points(5).findings, "exact 2.00 (no interval of 5 points)"));
}

TEST(PrecisionChapter, DrawsNoZeroWhereThereIsNoSample) {
  Rows rows("precision");
  rows.add(precision_point("published", "fixed", "float32"), lemma_counts(10, 0, 0.7071));
  const Chapter chapter = precision_chapter(rows.stored);
  EXPECT_TRUE(std::isnan(chapter.figures.at(0).panels.at(0).series.at(0).y.at(0)));
  EXPECT_NE(chapter.figures[0].caption.find(
                "fixed-function, published radius, 32-bit float 10 of 100 (depth 256 px)"),
            std::string::npos)
      << chapter.figures[0].caption;
  // Twins: with a sample there is a zero; what is no number is named.
  Rows good("precision");
  good.add(precision_point("published", "fixed", "float32"), lemma_counts(0, 0, 0.7071));
  const Chapter zero = precision_chapter(good.stored);
  EXPECT_EQ(zero.figures.at(0).panels.at(0).series.at(0).y.at(0), 0);
  EXPECT_EQ(zero.figures[0].caption.find("no distance"), std::string::npos);
  Rows endless("precision");
  Json counts = lemma_counts(0, 1, 0.7071);
  counts["largest_steps"] = nullptr;
  endless.add(precision_point("published", "fixed", "float32"), counts);
  EXPECT_NE(precision_chapter(endless.stored)
                .figures.at(0)
                .caption.find("Farther outside than a number says"),
            std::string::npos);
}

TEST(ExtremeChapters, CopeWithMissingRowsAndSaySo) {
  for (const auto& [study, of] : {std::pair<const char*, ChapterOf>{"radius", radius_chapter},
                                  {"precision", precision_chapter},
                                  {"stability", stability_chapter}}) {
    Rows rows(study);
    rows.stored.declaration.points.resize(3);
    const Chapter empty = of(rows.stored);
    EXPECT_TRUE(empty.figures.empty()) << study;
    EXPECT_TRUE(says(empty.limits, "Not finished: 0 of 3 points are measured."));
    Rows left(study);
    left.add(lemma_point("needles", "budget"), Json::object(), "the device is too small");
    EXPECT_TRUE(
        says(of(left.stored).limits, "Left out at 1 of 1 points: the device is too small."));
  }
}

}  // namespace
}  // namespace farcull
