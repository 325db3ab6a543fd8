// That the file of native counts holds what is measured, and that the comparison sees whatever
// differs. All points of the file: tests/experiments/studies/native_counts_main.cpp.
#include "tests/experiments/studies/native_counts.h"
#include "experiments/studies/point.h"
#include "tests/lab/test.h"

namespace farcull {
namespace {

using namespace native_counts;

const std::string kFile = FARCULL_TEST_DIR "/experiments/studies/native_counts.txt";

// The point of that key in the quick grid of accuracy.
Point accuracy_point(const PointKey& key) {
  for (const StudyGridPoint& of : quick_points(study_named("accuracy")))
    if (key_of(of.point) == key) return of.point;
  throw std::logic_error("no point " + describe(key));
}

// What the file says of a measured point under the key of another.
std::string said(const Table& table, const Point& point, const PointKey& key, Lab& lab) {
  return difference(table, measured(study_named("accuracy"), point, key, lab));
}

RunPoint small_far(const std::string& offset) {
  return far_point(NamedScene{"needles:60"}, offset, kBudgetRadius, 64);
}

TEST(NativeCounts, AreThoseOfTheFile) {
  const Table table = read(kFile);
  Lab lab("native");
  for (const char* offset : {"obb", "exact"}) {
    const PointKey key = key_of(Point(small_far(offset)));
    EXPECT_EQ(said(table, accuracy_point(key), key, lab), "");
  }
  const PointKey cullide =
      key_of(Point(cullide_point(NamedScene{"needles:60"}, Method::cullide, 64)));
  EXPECT_EQ(said(table, accuracy_point(cullide), cullide, lab), "");
}

// The twins: each change of what is drawn changes a count, beyond that of the radius itself.
TEST(NativeCounts, TellAnotherRadiusDepthResolutionAndOffset) {
  const Table table = read(kFile);
  Lab lab("native");
  // Large enough that the exact offset goes on where the boxes end.
  const RunPoint good = far_point(NamedScene{"two-tori"}, "obb", kBudgetRadius, 64);
  const PointKey key = key_of(Point(good));
  ASSERT_EQ(said(table, good, key, lab), "");
  const Line line = measured(study_named("accuracy"), good, key, lab);
  // Without the last two counts, radius_px and pixel_size.
  const auto without_radius = [](const Line& of) {
    std::string text = of.counts;
    for (int i = 0; i < 2; ++i) text.resize(text.rfind(';'));
    return text;
  };
  std::vector<RunPoint> others(4, good);
  others[0].radius = parse_radius("0.5");
  others[1].depth_mode = DepthMode::fixed;
  others[2].resolution = 65;
  others[3].offset = "exact";
  for (const RunPoint& other : others) {
    EXPECT_NE(said(table, other, key, lab), "") << describe(key_of(Point(other)));
    EXPECT_NE(without_radius(measured(study_named("accuracy"), other, key, lab)),
              without_radius(line))
        << describe(key_of(Point(other)));
  }
  // Another scene has another hash as well.
  RunPoint elsewhere = good;
  elsewhere.scene = NamedScene{"two-spheres"};
  EXPECT_TRUE(has_text(said(table, elsewhere, key, lab), "[scenes]"));
}

TEST(NativeCounts, TellEveryChangedDigitAndWhichPointHasIt) {
  Table table = read(kFile);
  Lab lab("native");
  const RunPoint point = small_far("obb");
  const PointKey key = key_of(Point(point));
  const Line line = measured(study_named("accuracy"), point, key, lab);
  ASSERT_EQ(difference(table, line), "");
  std::string& counts = table.at(line.section).at(line.key);
  const std::string as_it_is = counts;
  int changed = 0;
  for (std::size_t i = 0; i < as_it_is.size(); ++i) {
    if (std::isdigit(static_cast<unsigned char>(as_it_is[i])) == 0) continue;
    counts = as_it_is;
    counts[i] = counts[i] == '9' ? '8' : static_cast<char>(counts[i] + 1);
    const std::string text = difference(table, line);
    EXPECT_TRUE(has_text(text, line.key));
    EXPECT_TRUE(has_text(text, counts)) << "both values are said";
    ++changed;
  }
  EXPECT_GT(changed, 30);
  counts = as_it_is;
  table.at(kScenes).at(line.scene)[0] ^= 1;
  EXPECT_NE(difference(table, line), "");
  table.at(line.section).erase(line.key);
  EXPECT_TRUE(has_text(difference(table, line), "no such line"));
  table.erase(line.section);
  EXPECT_TRUE(has_text(difference(table, line), "no such section"));
}

// The file as it is committed: whole, sorted, and small enough to read a difference in it.
TEST(NativeCounts, TheFileHasEveryPointOnceAndIsWhatItWouldBeWrittenAs) {
  const std::string text = read_text(kFile);
  EXPECT_LT(text.size(), 300'000u);
  const Table table = parse(text, kFile);
  EXPECT_EQ(to_text(table, text.substr(0, text.find("\n[") + 1)), text);
  std::size_t points = 0, lines = 0;
  for (const auto& [section, of] : table) lines += section == kScenes ? 0 : of.size();
  for (const Study& study : studies()) {
    for (const StudyGridPoint& of : quick_points(study)) {
      ++points;
      std::string key;
      for (const std::string& axis : axis_values(key_of(of.point))) key += axis + ";";
      key.pop_back();
      EXPECT_TRUE(std::ranges::any_of(table,
                                      [&](const auto& section) {
                                        return study_of(section.first) == "[" + study.name + "]" &&
                                               section.second.contains(key);
                                      }))
          << study.name << ": " << key;
    }
  }
  EXPECT_EQ(points, lines);
  EXPECT_GT(points, 1000u);
}

TEST(NativeCounts, RefusesATextThatIsNoSuchFile) {
  EXPECT_THROW(read("/nonexistent"), Error);
  EXPECT_THROW(parse("a;b;c;d;e;f;1;h;i;j;1;2\n", "t"), Error) << "no section";
  EXPECT_THROW(parse("[s] x\na;b;c;1\n", "t"), Error) << "no key";
  const std::string line = "a;b;c;d;e;f;1;h;i;j;1\n";
  EXPECT_EQ(parse("# c\n[s] x\n" + line, "t").at("[s] x").at("a;b;c;d;e;f;1;h;i;j"), "1");
  EXPECT_THROW(parse("[s] x\n" + line + line, "t"), Error) << "twice";
}

}  // namespace
}  // namespace farcull
