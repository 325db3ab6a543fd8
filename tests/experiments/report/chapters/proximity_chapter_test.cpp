// The chapter of proximity on rows that were made up.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <nlohmann/json.hpp>

#include "experiments/report/chapters/chapters.h"

namespace farcull {
namespace {

using Json = nlohmann::ordered_json;

bool says(const Chapter& chapter, const std::string& part) {
  return std::any_of(chapter.findings.begin(), chapter.findings.end(), [&](const Finding& finding) {
    return printed(finding).find(part) != std::string::npos;
  });
}

struct MadeUp {
  MadeUp() { stored.declaration.study = "proximity"; }
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

PointKey at(const std::string& scene, const std::string& method, int cells = 0, long frame = -1) {
  PointKey out;
  out.scene = scene;
  out.method = method;
  out.resolution = cells;
  out.frame = frame;
  return out;
}

// Of 50 objects; `each` triangles in the set of an object.
Json sets(std::uint64_t missed, std::uint64_t each, bool promises, std::uint64_t missed_pairs = 0) {
  return {{"with_nearest", 50},  {"missed", missed},
          {"nearest_pairs", 60}, {"missed_pairs", missed_pairs},
          {"set_objects", 100},  {"set_triangles", 50 * each},
          {"objects", 50},       {"promises", promises}};
}

Json asked(std::uint64_t wrong, double error, bool promises) {
  return {{"asked", 40},   {"wrong", wrong},       {"largest_relative", error},
          {"objects", 50}, {"promises", promises}, {"library", "made-up 1.0"}};
}

MadeUp rows(std::uint64_t missed, std::uint64_t missed_pairs, std::uint64_t wrong) {
  MadeUp out;
  for (const char* scene : {"clusters:64@seed1", "clusters:64@seed2", "field"}) {
    const bool clusters = std::string(scene) != "field";
    out.add(at(scene, "boxes"), sets(0, 40, true)).add(at(scene, "trees"), sets(0, 4, true));
    for (const int cells : {64, 128}) {
      out.add(at(scene, "voronoi", cells), sets(clusters ? 640 / cells : 0, 30, false))
          .add(at(scene, "voronoi-reliable", cells), sets(missed, 10, true, missed_pairs));
    }
  }
  for (long frame = 0; frame < 2; ++frame) {
    out.add(at("crowd:30", "boxes", 0, frame), sets(0, 20, true))
        .add(at("crowd:30", "trees", 0, frame), sets(0, frame == 0 ? 2 : 4, true));
  }
  for (const int objects : {10, 100, 1000}) {
    Json counts = sets(0, 4, true);
    counts["objects"] = objects;
    out.add(at("crowd:" + std::to_string(objects), "trees"), counts, objects);
  }
  out.add(at("field", "farcull nearest"), asked(wrong, 0, true))
      .add(at("field", "peer nearest"), asked(3, 0.25, false), 5);
  return out;
}

const DataTable& table_of(const Chapter& chapter, const std::string& name) {
  const auto found = std::find_if(chapter.tables.begin(), chapter.tables.end(),
                                  [&](const DataTable& table) { return table.name == name; });
  if (found == chapter.tables.end()) throw std::logic_error("no table " + name);
  return *found;
}

const Figure* figure_of(const Chapter& chapter, const std::string& name) {
  const auto found = std::find_if(chapter.figures.begin(), chapter.figures.end(),
                                  [&](const Figure& figure) { return figure.name == name; });
  return found == chapter.figures.end() ? nullptr : &*found;
}

using Cells = std::vector<std::string>;

TEST(ProximityChapter, SaysWhatIsLostAndByWhom) {
  const Chapter chapter = chapter_of(rows(0, 0, 0).stored);
  EXPECT_FALSE(says(chapter, "BROKEN"));
  // Nine rows of boxes and of trees each but for frames and counts, six of the reliable diagram.
  EXPECT_TRUE(
      says(chapter, "Voronoi (reliable), boxes of objects and trees of boxes lost 0 of 950 "));
  EXPECT_TRUE(says(chapter, "Of the distances of farcull 0 of 40 "));
  EXPECT_TRUE(says(chapter,
                   "Voronoi (published), lost of all objects: 20 of 150 at 64 cells and 10 "
                   "of 150 at 128 cells."));
  EXPECT_TRUE(says(chapter,
                   "peer: 3 of 40 distances are not the nearest double; the largest "
                   "relative error is 0.25 (field)."));
  // Seeds of a scene are one panel, with the share of all their objects; of `field` nothing is
  // lost.
  const Figure* const lost = figure_of(chapter, "proximity-lost");
  ASSERT_NE(lost, nullptr);
  ASSERT_EQ(lost->panels.size(), 1u);
  EXPECT_EQ(lost->panels[0].title, "clusters:64");
  EXPECT_EQ(lost->panels[0].series.at(0).y, (std::vector<double>{20, 10}));
  EXPECT_LT(lost->panels[0].series.at(0).y_low.at(0), 20);
  EXPECT_NE(lost->caption.find("n: clusters:64 (100 objects, 2 seeds)"), std::string::npos)
      << lost->caption;
  EXPECT_EQ(table_of(chapter, "proximity-lost").rows.at(0),
            (Cells{"clusters:64", "Voronoi (published)", "100", "20", "10"}));
  EXPECT_EQ(table_of(chapter, "proximity-lost").rows.size(), 4u);
}

TEST(ProximityChapter, ComparesSizesWithThoseOfBoxes) {
  const Chapter chapter = chapter_of(rows(0, 0, 0).stored);
  const DataTable& table = table_of(chapter, "proximity-efficiency");
  EXPECT_EQ(table.rows.at(1), (Cells{"field", "-", "40", "10", "4", "1.33"}));
  // The median over two frames: 10 and 5 times fewer.
  EXPECT_EQ(table.rows.at(2).at(0), "crowd:30");
  EXPECT_EQ(table.rows.at(2).at(3), "7.50 (5 to 10)");
  EXPECT_EQ(table.rows.at(2).at(4), "-") << "no diagram was asked for there";
  const Figure* const sizes = figure_of(chapter, "proximity-triangles");
  ASSERT_NE(sizes, nullptr);
  ASSERT_EQ(sizes->panels.size(), 2u);
  EXPECT_EQ(sizes->panels[1].series.at(0).y, (std::vector<double>{30, 30}));
  EXPECT_EQ(sizes->panels[1].series.at(2).y, (std::vector<double>{40, 40}));
}

TEST(ProximityChapter, FitsTimesAndListsDistances) {
  const Chapter chapter = chapter_of(rows(0, 0, 0).stored);
  EXPECT_TRUE(says(chapter, "trees of boxes 1.00 (no interval of 3 points)"));
  EXPECT_EQ(table_of(chapter, "proximity-distances").rows.at(1),
            (Cells{"field", "peer", "40", "3", "-", "-", "-", "0.25", "5", "made-up 1.0"}));
  const Figure* const errors = figure_of(chapter, "proximity-error");
  ASSERT_NE(errors, nullptr);
  EXPECT_EQ(errors->panels.at(0).series.at(1).y, std::vector<double>{0.25});
}

// The twin: each promise that is not kept stands first, and nothing is said to be kept.
TEST(ProximityChapter, BeginsWithThePromiseThatWasNotKept) {
  const std::vector<std::array<std::uint64_t, 3>> losses = {{2, 0, 0}, {0, 1, 0}, {0, 0, 3}};
  for (const auto& [missed, pairs, wrong] : losses) {
    const Chapter chapter = chapter_of(rows(missed, pairs, wrong).stored);
    ASSERT_FALSE(chapter.findings.empty());
    EXPECT_TRUE(is_broken(chapter.findings[0])) << missed << pairs << wrong;
    EXPECT_FALSE(says(chapter, " lost 0 of ")) << missed << pairs << wrong;
    EXPECT_FALSE(says(chapter, "farcull 0 of ")) << missed << pairs << wrong;
  }
  EXPECT_TRUE(says(chapter_of(rows(2, 0, 0).stored),
                   "BROKEN: clusters:64@seed1, voronoi-reliable, 64 cells: 2 of 50 objects lose"));
  EXPECT_TRUE(
      says(chapter_of(rows(0, 0, 3).stored), "BROKEN: field, farcull nearest: 3 of 40 distances"));
}

TEST(ProximityChapter, SaysWhatIsNotKnownAndWhatWasLeftOut) {
  MadeUp some = rows(0, 0, 0);
  some.stored.rows[0].measurement.counts->erase("missed");
  some.stored.rows[3].measurement.counts = Json::object();
  some.stored.rows[3].measurement.left_out = "64 cells leave too many pairs";
  const Chapter chapter = chapter_of(some.stored);
  EXPECT_TRUE(says(chapter, "One row of methods that promise does not say what they lost."));
  EXPECT_TRUE(std::any_of(chapter.limits.begin(), chapter.limits.end(), [](const auto& limit) {
    return limit.find("64 cells leave too many pairs") != std::string::npos;
  }));
  // Of no rows there is a chapter without figures.
  MadeUp none;
  EXPECT_TRUE(chapter_of(none.stored).figures.empty());
}

// Embree is asked another question, which the page says where it has its answers, and only there.
TEST(ProximityChapter, SaysWhatDistancesFromVerticesAre) {
  const auto says_so = [](const Chapter& chapter) {
    return std::any_of(chapter.limits.begin(), chapter.limits.end(), [](const std::string& limit) {
      return limit.starts_with("Embree has no query");
    });
  };
  MadeUp with = rows(0, 0, 0);
  with.add(at("field", "embree-points nearest"), asked(3, 0.25, false), 5);
  EXPECT_TRUE(says_so(chapter_of(with.stored)));
  EXPECT_FALSE(says_so(chapter_of(rows(0, 0, 0).stored)));
}

}  // namespace
}  // namespace farcull
