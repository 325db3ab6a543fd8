// The chapters of scenes, culling and cloth, and the comparison of devices, on rows that were made
// up.
#include <gtest/gtest.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "experiments/report/chapters/chapters.h"
#include "experiments/report/chapters/devices.h"

namespace farcull {
namespace {

using Json = nlohmann::ordered_json;

bool says(const Chapter& chapter, const std::string& part) {
  return std::any_of(chapter.findings.begin(), chapter.findings.end(), [&](const Finding& finding) {
    return printed(finding).find(part) != std::string::npos;
  });
}
bool is_broken(const Chapter& chapter) { return says(chapter, "BROKEN"); }

class MadeUp {
 public:
  explicit MadeUp(const std::string& study) { stored.declaration.study = study; }
  MadeUp& add(const PointKey& point, const Json& counts, double ms = 2) {
    Row row;
    row.position = stored.rows.size();
    row.point = point;
    row.measurement.counts = counts;
    row.measurement.times = {{"total", ms}};
    stored.declaration.points.push_back(point);
    stored.rows.push_back(row);
    return *this;
  }
  StoredStudy stored;
};

PointKey point_of(const std::string& scene, const std::string& method, int resolution = 0,
                  const std::string& views = "", long frame = -1) {
  PointKey out;
  out.scene = scene;
  out.method = method;
  out.offset = method == "far" ? "obb" : "";
  if (method == "far") out.radius = kBudgetRadius;
  out.resolution = resolution;
  out.views = views;
  out.frame = frame;
  return out;
}

// Ten pairs collide, two of them neighbours; of the candidates so many are neighbours.
Json kept(std::uint64_t candidates, std::uint64_t neighbours = 0) {
  return {{"colliding", neighbours > 0 ? 10 : 8},
          {"missed", 0},
          {"candidates", candidates},
          {"neighbour_candidates", neighbours},
          {"neighbours", neighbours > 0 ? 2 : 0},
          {"promises", neighbours > 0}};
}

MadeUp culling_rows(std::uint64_t chosen) {
  MadeUp rows("culling");
  for (const char* scene : {"easy", "hard"}) {
    const bool hard = std::string(scene) == "hard";
    rows.add(point_of(scene, "cgal-boxes"), kept(hard ? 8000 : 80))
        .add(point_of(scene, "fcl-obb"), kept(hard ? 80 : 16))
        .add(point_of(scene, "far-pairs"), kept((hard ? chosen : 79) + 100, 100))
        .add(point_of(scene, "far-pairs", 64, "z"), kept(160, 100))
        .add(point_of(scene, "far-pairs", 256, "z"), kept(hard ? 132 : 164, 100))
        .add(point_of(scene, "far-pairs", 64, "x,y,z"), kept(140, 100))
        .add(point_of(scene, "far-pairs", 256, "x,y,z"), kept(hard ? 116 : 124, 100));
  }
  return rows;
}

TEST(CullingChapter, SaysWhereItIsAJoinOfBoxesAndWhatViewsAdd) {
  const Chapter chapter = chapter_of(culling_rows(800).stored);
  EXPECT_FALSE(is_broken(chapter));
  EXPECT_TRUE(says(chapter, "on easy (79 of 80): there it is a fast join of boxes"));
  EXPECT_TRUE(says(chapter, "keeps fewer on hard (800 of 8,000)"));
  EXPECT_TRUE(
      says(chapter,
           "Three views leave 2 candidates for each pair that collides on hard (at 256 px), "
           "where boxes leave 1,000, and 3 candidates for each pair that collides on easy"));
  EXPECT_TRUE(says(chapter, "than FCL's oriented boxes on 1 of 2 scenes"));
  EXPECT_FALSE(says(chapter, "More pixels"));
  ASSERT_EQ(chapter.figures.size(), 1u);
  ASSERT_EQ(chapter.figures[0].panels.size(), 2u);
  const Panel& hard = chapter.figures[0].panels[1];
  ASSERT_EQ(hard.series.size(), 5u);
  EXPECT_EQ(hard.series[0].name, "boxes");
  EXPECT_EQ(hard.series[0].y, (std::vector<double>{1000, 1000}));
  EXPECT_EQ(hard.series[3].x, (std::vector<double>{64, 256}));
  EXPECT_EQ(hard.series[3].y, (std::vector<double>{7.5, 4}));
  ASSERT_EQ(chapter.tables.size(), 2u);
  EXPECT_EQ(chapter.tables[0].rows[1],
            (std::vector<std::string>{"hard", "8", "8,000", "1,000", "10", "100", "4", "256", "2",
                                      "256"}));
  EXPECT_EQ(chapter.tables[0].rows[0][7], "64");  // of 1 view on easy, where 256 px leave more
}

TEST(CullingChapter, SaysWhereMorePixelsLeaveMore) {
  MadeUp rows = culling_rows(800);
  rows.add(point_of("easy", "far-pairs", 512, "x,y,z"), kept(190, 100));
  EXPECT_TRUE(
      says(chapter_of(rows.stored), "on 1 of 2 scenes three views leave more at the largest"));
}

// The twin: with nearly all pairs of boxes kept, it is called a join.
TEST(CullingChapter, CallsItAJoinWhereItKeepsNearlyAllBoxes) {
  const Chapter chapter = chapter_of(culling_rows(7990).stored);
  EXPECT_TRUE(says(chapter, "on easy (79 of 80) and hard (7,990 of 8,000): there it is"));
  EXPECT_FALSE(says(chapter, "keeps fewer"));
}

TEST(ScenesChapter, NamesTheSeedThatAScenesNameHas) {
  MadeUp rows("scenes");
  const Json counts = {{"triangles", 100},    {"objects", 2},       {"self_objects", 0},
                       {"colliding", 3},      {"neighbours", 0},    {"scene_hash", "ab"},
                       {"pixels_tenth", 1.0}, {"pixels_half", 4.0}, {"pixels_ninety", 9.0}};
  // The studies' own suffixes are no names of scenes.
  for (const char* scene : {"needles:60@seed101", "needles:60", "needles:60@seed103@far",
                            "crowd:60@offset-1e0", "crowd:60@seed7@scale-1e3"})
    rows.add(point_of(scene, "exact"), counts);
  const Chapter chapter = chapter_of(rows.stored);
  std::vector<std::string> sources;
  for (const auto& row : chapter.tables.at(0).rows) sources.push_back(row.at(1));
  EXPECT_EQ(sources,
            (std::vector<std::string>{"drawn, seed 101", "drawn, seed 2", "drawn, seed 103",
                                      "drawn, seed 4", "drawn, seed 7"}));
}

TEST(ScenesChapter, TellsTheSizeOfTrianglesAtEachResolution) {
  MadeUp rows("scenes");
  rows.add(point_of("two-spheres", "exact"), {{"triangles", 10240},
                                              {"objects", 2},
                                              {"self_objects", 0},
                                              {"colliding", 300},
                                              {"neighbours", 0},
                                              {"scene_hash", "ab"},
                                              {"pixels_tenth", 1},
                                              {"pixels_half", 4.0},
                                              {"pixels_ninety", 9.0}});
  rows.add(point_of("cloth:450:1e4", "exact", 0, "", 40), {{"triangles", 610},
                                                           {"objects", 2},
                                                           {"self_objects", 1},
                                                           {"colliding", 7},
                                                           {"neighbours", 3},
                                                           {"scene_hash", "cd"},
                                                           {"pixels_tenth", 0.1},
                                                           {"pixels_half", 0.5},
                                                           {"pixels_ninety", 2.0}});
  const Chapter chapter = chapter_of(rows.stored);
  EXPECT_TRUE(says(chapter,
                   "2 scenes: 0 of scanned or modelled meshes, 1 of simulated cloth, 0 "
                   "drawn at random and 1 constructed"));
  EXPECT_TRUE(says(chapter, "610 to 10,240 triangles. In 1 of them objects"));
  EXPECT_TRUE(says(chapter, "At 512 px the median triangle covers less than a pixel in 1 of 2"));
  ASSERT_EQ(chapter.tables.size(), 2u);
  // 4 pixels at 512 px are 4/64 at 64 px and 256 at 4096 px.
  EXPECT_EQ(chapter.tables[0].rows[0],
            (std::vector<std::string>{"two-spheres", "constructed", "no", "-", "2", "10,240", "300",
                                      "0.062", "0.25", "1", "4", "16", "64", "256"}));
  EXPECT_EQ(chapter.tables[0].rows[1][1], "simulated");
  EXPECT_EQ(chapter.tables[0].rows[1][2], "1 of 2");
  EXPECT_EQ(chapter.tables[0].rows[1][3], "40");
}

Json frame_of(double total, bool converged = true, std::uint64_t colliding = 5) {
  return {{"colliding", colliding}, {"missed", 0},           {"candidates", 9}, {"accounted", 100},
          {"promises", true},       {"total", total},        {"slack", 0.125},  {"residual", 1e-6},
          {"iterations", 3},        {"converged", converged}};
}

MadeUp cloth_rows(const Json& last) {
  MadeUp rows("cloth");
  for (const char* scene : {"cloth:200:1e2", "cloth:200:1e8"}) {
    rows.add(point_of(scene, "far-pairs", 0, "", 0), frame_of(1))
        .add(point_of(scene, "far", 512, "", 0), frame_of(1))
        .add(point_of(scene, "far-pairs", 0, "", 1), frame_of(0.5));
  }
  rows.add(point_of("cloth:200:1e8", "far-pairs", 0, "", 2), last);
  return rows;
}

TEST(ClothChapter, SaysThatTheEnergyIsBoundedAndWhatIsNotRun) {
  MadeUp rows = cloth_rows(frame_of(0.625));
  rows.stored.declaration.points.push_back(point_of("cloth:200:1e2", "far-pairs", 0, "", 2));
  const Chapter chapter = chapter_of(rows.stored);
  EXPECT_FALSE(is_broken(chapter));
  EXPECT_TRUE(says(chapter, "At 1e2 N/m the total energy never grew by more"));
  EXPECT_TRUE(says(chapter, "At 1e8 N/m the total energy never grew by more"));
  EXPECT_TRUE(says(chapter, "left unbalanced (2 steps)"));
  EXPECT_TRUE(says(chapter, "At 1e2 N/m 2 of 3 frames have been run."));
  EXPECT_FALSE(says(chapter, "At 1e8 N/m 3 of 3"));
  EXPECT_TRUE(says(chapter, "the same number of colliding pairs in each of the 2 frames"));
  ASSERT_EQ(chapter.tables.size(), 1u);
  EXPECT_EQ(chapter.tables[0].rows[1][0], "1e8");
  EXPECT_EQ(chapter.tables[0].rows[1][1], "3");
}

// Each fault of the simulation or of a method is seen.
TEST(ClothChapter, ShoutsWhatIsNotAsItHasToBe) {
  // 2^-10 J more than the slack.
  EXPECT_TRUE(says(chapter_of(cloth_rows(frame_of(0.6259765625)).stored),
                   "BROKEN: At 1e8 N/m the total energy grew by more than the unbalanced forces "
                   "can do in 1 of 2 steps, by up to 0.000977 J"));
  Json infinite = frame_of(0.5);
  infinite["total"] = nullptr;  // as JSON holds what is not finite
  EXPECT_TRUE(is_broken(chapter_of(cloth_rows(infinite).stored)));
  EXPECT_TRUE(says(chapter_of(cloth_rows(frame_of(0.5, false)).stored),
                   "BROKEN: At 1e8 N/m 1 of 3 steps did not converge"));
  Json missing = frame_of(0.5);
  missing["missed"] = 1;
  EXPECT_TRUE(is_broken(chapter_of(cloth_rows(missing).stored)));
  MadeUp differing = cloth_rows(frame_of(0.5));
  differing.stored.rows[1].measurement.counts["colliding"] = 4;
  EXPECT_TRUE(says(chapter_of(differing.stored), "BROKEN: FAR and FAR pairs found different"));
}

TEST(Devices, AreComparedPointByPoint) {
  const PointKey one = point_of("a", "far", 64), two = point_of("b", "far", 64),
                 alone = point_of("c", "far", 64);
  const auto counts = [](std::uint64_t candidates, std::uint64_t missed, bool promises = true) {
    return Json{
        {"colliding", 9}, {"missed", missed}, {"candidates", candidates}, {"promises", promises}};
  };
  const MadeUp first =
      MadeUp("accuracy").add(one, counts(20, 0)).add(two, counts(30, 0)).add(alone, counts(7, 0));
  const MadeUp other = MadeUp("accuracy").add(one, counts(20, 0), 6).add(two, counts(33, 0), 8);
  Chapter chapter;
  chapter.study = "accuracy";
  add_devices("native", first.stored, {}, chapter);
  EXPECT_TRUE(chapter.findings.empty() && chapter.tables.empty());
  add_devices("native", first.stored, {{"llvmpipe", other.stored}}, chapter);
  EXPECT_TRUE(says(chapter, "On llvmpipe counts differ from those on native at 1 of 2 points."));
  ASSERT_EQ(chapter.tables.size(), 1u);
  EXPECT_EQ(chapter.tables[0].name, "accuracy-devices");
  EXPECT_EQ(chapter.tables[0].rows,
            (std::vector<std::vector<std::string>>{
                {"llvmpipe", "FAR (OBB)", "2", "1", "0", "0", "50", "53", "3.50"}}));
  // A promise that another device does not keep is as bad as one of the first.
  const MadeUp liar = MadeUp("accuracy").add(one, counts(20, 1));
  add_devices("native", first.stored, {{"liar", liar.stored}}, chapter);
  EXPECT_TRUE(says(chapter, "BROKEN: On liar, FAR (OBB) did not keep its promise at a, far"));
}

}  // namespace
}  // namespace farcull
