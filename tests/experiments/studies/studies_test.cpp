// What every study promises of its grid.
#include "experiments/studies/study.h"

#include "tests/lab/test.h"

namespace farcull {
namespace {

// Empty, or what is wrong with a grid.
std::string fault_of(const std::vector<PointKey>& points, bool in_turns = false) {
  if (points.empty()) return "no points";
  std::set<PointKey> seen;
  std::set<std::string> scenes;
  std::string scene;
  for (const PointKey& point : points) {
    if (!seen.insert(point).second) return "twice: " + describe(point);
    if (point.method.empty()) return "no method: " + describe(point);
    if (!in_turns && point.scene != scene && !scenes.insert(point.scene).second)
      return "not together: " + point.scene;
    scene = point.scene;
  }
  return "";
}

class EveryStudy : public testing::TestWithParam<std::string> {
 protected:
  const Study& study() const { return study_named(GetParam()); }
};

TEST_P(EveryStudy, HasAGridOfDifferentPointsWithScenesTogether) {
  for (const bool quick : {false, true}) {
    EXPECT_EQ(fault_of(keys_of(study().grid({.quick = quick, .seed = 1})), study().campaign), "")
        << (quick ? "quick" : "full");
  }
}

TEST_P(EveryStudy, HasTheSameGridTwice) {
  for (const bool quick : {false, true}) {
    for (const std::uint64_t seed : {1, 7}) {
      const GridChoice choice{.quick = quick, .seed = seed};
      EXPECT_EQ(keys_of(study().grid(choice)), keys_of(study().grid(choice)));
    }
  }
}

TEST_P(EveryStudy, HasFewerPointsWhereQuick) {
  EXPECT_LT(study().grid({.quick = true}).size(), study().grid({.quick = false}).size());
}

// Every figure and table needs the same kinds of points.
TEST_P(EveryStudy, HasEveryMethodWhereQuickToo) {
  const auto methods = [&](bool quick) {
    std::set<std::tuple<std::string, std::string, std::string>> out;
    for (const PointKey& point : keys_of(study().grid({.quick = quick})))
      if (!point.method.starts_with("s-cullide"))
        out.insert({point.method, point.offset, column_text(point.depth_mode)});
    return out;
  };
  EXPECT_EQ(methods(true), methods(false));
}

TEST_P(EveryStudy, SaysWhatItAsks) {
  EXPECT_EQ(study().name, GetParam());
  EXPECT_FALSE(study().title.empty());
  EXPECT_TRUE(study().question.ends_with("?"));
}

std::vector<std::string> names() {
  std::vector<std::string> out;
  for (const Study& study : studies()) out.push_back(study.name);
  return out;
}

INSTANTIATE_TEST_SUITE_P(Studies, EveryStudy, testing::ValuesIn(names()), [](const auto& info) {
  std::string name = info.param;
  std::replace(name.begin(), name.end(), '-', '_');
  return name;
});

TEST(Studies, HaveNamesOfTheirOwn) {
  const std::vector<std::string> all = names();
  EXPECT_EQ(std::set<std::string>(all.begin(), all.end()).size(), all.size());
}

// The twin of the tests of grids: each fault is seen.
TEST(Studies, AreRefusedWithAFaultyGrid) {
  std::vector<PointKey> good = keys_of(study_named("accuracy").grid({.quick = true}));
  ASSERT_EQ(fault_of(good), "");
  ASSERT_NE(good.front().scene, good.back().scene);
  std::vector<PointKey> twice = good;
  twice.insert(twice.begin(), good.front());
  EXPECT_EQ(fault_of(twice), "twice: " + describe(good.front()));
  std::vector<PointKey> apart = good;
  std::swap(apart.front(), apart.back());
  EXPECT_TRUE(fault_of(apart).starts_with("not together: "));
  EXPECT_EQ(fault_of({}), "no points");
  EXPECT_TRUE(fault_of({PointKey{}}).starts_with("no method"));
}

// What the figure of the study is about must be among its points.
TEST(Accuracy, ComparesEveryMethodFrom64To4096) {
  for (const bool quick : {false, true}) {
    std::map<std::string, std::set<int>> resolutions;
    for (const PointKey& point : keys_of(study_named("accuracy").grid({.quick = quick})))
      if (point.radius != kPublishedRadius)
        resolutions[point.method + " " + point.offset].insert(point.resolution);
    std::set<int> powers = {64, 128, 256, 512, 1024, 2048, 4096};
    for (const char* name : {"cullide ", "quick-cullide ", "far obb", "far exact"})
      EXPECT_EQ(resolutions[name], powers) << name;
    EXPECT_GE(resolutions["s-cullide "].size(), quick ? 5u : powers.size());
    powers.insert(0);
    EXPECT_EQ(resolutions["far-pairs "], powers);
  }
}

TEST(ErrorTime, HasEveryLibraryOnEveryScene) {
  for (const bool quick : {false, true}) {
    std::map<std::string, std::set<std::string>> methods;
    for (const PointKey& point : keys_of(study_named("error-time").grid({.quick = quick})))
      methods[point.scene].insert(point.method);
    for (const auto& [scene, of] : methods)
      for (const char* peer :
           {"cgal-boxes", "cgal-aabb", "embree-low", "fcl-double", "fcl-float", "ode-trimesh"})
        EXPECT_TRUE(of.contains(peer)) << peer << " on " << scene;
  }
}

}  // namespace
}  // namespace farcull
