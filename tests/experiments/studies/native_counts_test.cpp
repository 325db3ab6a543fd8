// That every point of the quick grids is in the file of native counts, and that a hash tells
// whatever differs. The counts themselves: ctest -R native-counts.
#include "tests/experiments/studies/native_counts.h"

#include "tests/lab/test.h"

namespace farcull {
namespace {

using namespace native_counts;

const std::string kFile = FARCULL_TEST_DIR "/experiments/studies/native_counts.txt";

TEST(NativeCounts, TheFileHasEveryMethodOfEveryStudyAndIsWhatItWouldBeWrittenAs) {
  const std::string text = read_text(kFile);
  const Lines file = read(kFile);
  EXPECT_EQ(text.substr(0, text.find("\naccuracy") + 1) + to_text(file), text);
  Table table;
  for (const Study& study : studies())
    for (const StudyGridPoint& of : quick_points(study)) add(table, of, of.key);
  const Lines expected = lines_of(table);
  ASSERT_EQ(file.size(), expected.size());
  for (const auto& [name, line] : expected) EXPECT_EQ(file.at(name)[0], line[0]) << name;
}

TEST(NativeCounts, TellEveryChangedDigit) {
  MeasurementContext lab("native");
  const Study& study = study_named("accuracy");
  const std::vector<StudyGridPoint> points = quick_points(study);
  const auto at = std::ranges::find_if(
      points, [](const auto& of) { return of.key.starts_with("needles:60;far;obb;budget;"); });
  ASSERT_NE(at, points.end());
  const std::string row = measured_row(study, at->point, at->key, lab);
  const auto hash = [&](const std::string& of) {
    RowsHash out;
    out.add("another row");
    out.add(of);
    return out.text();
  };
  std::set<std::string> seen = {hash(row)};
  for (const char& digit : row) {
    if (std::isdigit(static_cast<unsigned char>(digit)) == 0) continue;
    std::string other = row;
    other[static_cast<std::size_t>(&digit - row.data())] =
        digit == '9' ? '8' : static_cast<char>(digit + 1);
    EXPECT_TRUE(seen.insert(hash(other)).second) << other;
  }
  EXPECT_GT(seen.size(), 30u);
  // And a hash that the file has otherwise, or not at all.
  Table table;
  add(table, *at, row);
  Lines file = lines_of(table);
  EXPECT_TRUE(differences(file, table, without_meshes).empty());
  file.begin()->second[without_meshes + 1][3] ^= 1;
  EXPECT_EQ(differences(file, table, without_meshes), std::vector<std::string>{"accuracy;far"});
  EXPECT_EQ(differences({}, table, without_meshes), std::vector<std::string>{"accuracy;far"});
}

// Each change of what is drawn changes a count, beyond that of the radius itself.
TEST(NativeCounts, TellAnotherRadiusDepthResolutionAndOffset) {
  MeasurementContext lab("native");
  // Large enough that the exact offset goes on where the boxes end.
  const RunPoint good = far_point(NamedScene{"two-tori"}, "obb", kBudgetRadius, 64);
  const auto row = [&](const RunPoint& point) {
    const std::string text = measured_row(study_named("accuracy"), point, "", lab);
    return text.substr(0, text.find(" radius_px="));
  };
  std::vector<RunPoint> others(4, good);
  others[0].radius = parse_radius("0.5");
  others[1].depth_mode = DepthMode::fixed;
  others[2].resolution = 65;
  others[3].offset = "exact";
  std::set<std::string> seen = {row(good)};
  for (const RunPoint& other : others)
    EXPECT_TRUE(seen.insert(row(other)).second) << describe(key_of(Point(other)));
}

}  // namespace
}  // namespace farcull
