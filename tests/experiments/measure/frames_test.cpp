#include "experiments/measure/frames.h"

#include "tests/lab/process.h"

namespace farcull {
namespace {

constexpr const char* kFloor = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";

std::string falling(double z) {
  const std::string h = std::to_string(z), l = std::to_string(z - 0.25);
  return "v 0.1 0.1 " + h + "\nv 0.9 0.1 " + h + "\nv 0.1 0.1 " + l + "\nf 1 2 3\n";
}

FramesQuestion question(Method method, FrameRange range) {
  FramesQuestion out;
  out.options.method = method;
  out.options.device = "cpu";
  out.range = range;
  out.pairs = true;
  return out;
}

TEST(Frames, RangesAreACountOrFirstAndLast) {
  EXPECT_EQ(parse_frames("3").first, 0);
  EXPECT_EQ(parse_frames("3").last, 2);
  EXPECT_EQ(parse_frames("7:7").count(), 1);
  EXPECT_EQ(parse_frames("5:14").count(), 10);
  for (const char* bad : {"", "0", "-3", "x", "1:", ":1", "4:3", "1:2:3", "1000001", "0:1000000"})
    EXPECT_EQ(error_of([&] { parse_frames(bad); }).where, "--frames") << bad;
}

TEST(Frames, NumberedNamesHoldOnePlace) {
  EXPECT_EQ(numbered("a_%d.obj", 7), "a_7.obj");
  EXPECT_EQ(numbered("a_%04d.obj", 7), "a_0007.obj");
  EXPECT_EQ(numbered("a_%02d.obj", 1234), "a_1234.obj");
  EXPECT_EQ(numbered("50%/%03d.obj", 12), "50%/012.obj");
  for (const char* name :
       {"a.obj", "a%.obj", "a%s.obj", "a%4d.obj", "a%0d.obj", "a%00d.obj", "%d_%d.obj", "a%04"})
    EXPECT_FALSE(is_numbered(name)) << name;
}

TEST(Frames, SummaryIsMedianNearestRankAndMaximum) {
  std::vector<double> ms;
  for (int i = 100; i > 0; --i) ms.push_back(i);
  EXPECT_EQ(summary_of(ms).median, 50.5);
  EXPECT_EQ(summary_of(ms).p95, 95);
  EXPECT_EQ(summary_of(ms).max, 100);
  EXPECT_EQ(summary_of({3}).p95, 3);
}

TEST(Frames, NumberedMeshesGiveThePairsOfEachFrame) {
  const ScratchFolder folder;
  const std::string floor = folder.write("floor.obj", kFloor);
  for (int frame = 1; frame <= 4; ++frame)
    folder.write("fall_" + std::to_string(frame) + ".obj", falling(0.9 - 0.3 * frame));
  const std::vector<std::string> scene = {folder.path("fall_%d.obj"), floor};
  for (const Method method : {Method::boxes, Method::exact}) {
    const FramesResult result = run_frames(scene, question(method, {1, 4}));
    ASSERT_EQ(result.json["frames"].size(), 4u);
    std::vector<int> colliding;
    for (const auto& frame : result.json["frames"]) colliding.push_back(frame["colliding_pairs"]);
    EXPECT_EQ(colliding, (std::vector<int>{0, 0, 1, 0}));  // at z 0.6, 0.3, 0 and -0.3
    EXPECT_EQ(result.json["frames"][2]["frame"], 3);
    EXPECT_EQ(result.json["summary"]["missed"], 0);
    EXPECT_EQ(result.json["summary"]["frames"], 4);
    EXPECT_EQ(result.pairs_csv, "frame,object_a,triangle_a,object_b,triangle_b\n3,0,0,1,0\n");
    EXPECT_EQ(result.broken, "");
  }
}

TEST(Frames, OnlyVerticesChange) {
  FrameSource source({"two-spheres"}, {0, 8}, true);
  const Scene& first = source.at(0);
  const auto* const triangles = first.triangles.data();
  const std::vector<Vec3> before = first.vertices;
  const Scene& later = source.at(3);
  EXPECT_EQ(&first, &later);
  EXPECT_EQ(later.triangles.data(), triangles);
  EXPECT_NE(later.vertices, before);
  EXPECT_TRUE(later.objects[0].self);
  EXPECT_EQ(source.at(0).vertices, before);  // and nothing is remembered
}

TEST(Frames, MissingFilesAndScenesThatStandStillAreNamed) {
  const ScratchFolder folder;
  folder.write("m_0.obj", kFloor);
  folder.write("m_1.obj", kFloor);
  const std::string path = folder.path("m_%d.obj");
  FrameSource source({path}, {0, 2}, false);
  ASSERT_TRUE(source.missing().has_value());
  EXPECT_EQ(source.missing()->where, folder.path("m_2.obj"));
  EXPECT_TRUE(has_text(source.missing()->remedy, "--frames 0:1 instead of 0:2"));
  EXPECT_EQ(source.at(1).triangles.size(), 1u);
  EXPECT_EQ(error_of([&] { source.at(2); }).where, folder.path("m_2.obj"));
  EXPECT_FALSE(FrameSource({path}, {0, 1}, false).missing().has_value());
  EXPECT_EQ(error_of([&] { FrameSource({path}, {2, 3}, false); }).where, folder.path("m_2.obj"));
  EXPECT_EQ(error_of([&] {
              FrameSource({folder.path("m_0.obj")}, {0, 2}, false);
            }).where,
            "--frames");
  EXPECT_EQ(error_of([&] { FrameSource({"two-tori"}, {0, 2}, false); }).where, "--frames");
}

// When a frame begins, the file holds the frames before it, as a whole document.
TEST(Frames, ARecordIsWholeAfterEachFrame) {
  const ScratchFolder folder;
  const std::string path = folder.write("record.json", "of an earlier run");
  FrameRecord record(path);
  std::size_t frames = 0;
  std::string rows, csv;
  FramesQuestion asked = question(Method::boxes, {0, 4});
  const FramesResult result =
      run_frames({"two-spheres"}, asked, {}, [&](const FrameReport& report) {
        record.add(report);
        const auto json = nlohmann::json::parse(read_text(path));
        EXPECT_EQ(json["frames"].size(), ++frames);
        EXPECT_EQ(json["frames"].back()["frame"], frames - 1);
        EXPECT_EQ(json["summary"]["frames"], frames);
        EXPECT_EQ(json["summary"]["wanted"], 5);
        EXPECT_EQ(json["method"], "boxes");
        // The first frame comes with a heading; a later one where a column grows wider.
        EXPECT_GE(std::ranges::count(report.rows, '\n'), frames == 1 ? 2 : 1);
        csv += report.pairs_csv;
      });
  record.finish();
  EXPECT_EQ(frames, 5u);
  const std::string text = read_text(path);
  EXPECT_EQ(text, nlohmann::ordered_json::parse(text).dump(2) + "\n");
  EXPECT_FALSE(result.json.contains("frames"));
  const FramesResult whole = run_frames({"two-spheres"}, asked);
  EXPECT_EQ(whole.pairs_csv, csv);
  EXPECT_EQ(whole.json["frames"].size(), 5u);
}

TEST(GrowingOutput, AFullDiskLeavesWhatWasWhole) {
  const ScratchFolder folder;
  const std::string path = folder.path("growing");
  prepare_output();
  GrowingOutput output(path);
  output.add("[1", "]");
  output.add(",2", " ] ");
  output.add(",3", "]");
  EXPECT_EQ(read_text(path), "[1,2,3]");
  const std::string long_text = "," + std::string(200, '4');
  {
    const FileSizeLimit limit(100);
    EXPECT_EQ(error_of([&] { output.add(long_text, "]"); }).where, path);
  }
  EXPECT_EQ(read_text(path), "[1,2,3]");
  output.add(long_text, "]");
  output.finish();
  EXPECT_EQ(read_text(path), "[1,2,3" + long_text + "]");
}

// A frame is what its file says, triangles included.
TEST(Frames, MeshesMayChangeTheirTopology) {
  const ScratchFolder folder;
  const std::string floor = folder.write("floor.obj", kFloor);
  const std::string high = "v 0.1 0.1 0.5\nv 0.9 0.1 0.5\nv 0.1 0.1 0.25\n";
  const std::string low = "v 0.1 0.1 0.5\nv 0.3 0.1 0.5\nv 0.1 0.1 -0.25\n";
  folder.write("m_0.obj", high + "f 1 2 3\n");
  folder.write("m_1.obj", high + "f 1 2 3\n");                 // as before
  folder.write("m_2.obj", high + low + "f 1 2 3\nf 4 5 6\n");  // one more
  folder.write("m_3.obj", high + low + "f 1 2 3\nf 1 3 2\n");  // as many, others
  folder.write("m_4.obj", high + low + "f 4 5 6\n");           // one fewer
  const std::vector<std::string> scene = {folder.path("m_%d.obj"), floor};
  for (const Method method : {Method::boxes, Method::exact}) {
    const FramesResult result = run_frames(scene, question(method, {0, 4}));
    std::vector<int> colliding, triangles;
    std::vector<bool> changed;
    for (const auto& frame : result.json["frames"]) {
      colliding.push_back(frame["colliding_pairs"]);
      triangles.push_back(frame["triangles"]);
      changed.push_back(frame["topology_changed"]);
    }
    EXPECT_EQ(colliding, (std::vector<int>{0, 0, 1, 0, 1}));
    EXPECT_EQ(triangles, (std::vector<int>{2, 2, 3, 3, 2}));
    EXPECT_EQ(changed, (std::vector<bool>{false, false, true, true, true}));
    EXPECT_EQ(result.json["summary"]["topology_changes"], 3);
    EXPECT_EQ(result.json["summary"]["missed"], 0);
    EXPECT_EQ(result.json["scene"]["triangles"], 2);
    EXPECT_TRUE(has_text(result.table, "topology  changed 3 times"));
  }
  folder.write("m_1.obj", high + "f 1 2 9\n");  // and each is validated
  FrameSource source(scene, {0, 4}, false);
  source.at(0);
  EXPECT_EQ(error_of([&] { source.at(1); }).where, folder.path("m_1.obj"));
}

TEST(Frames, RatesAreThoseOfTheTimes) {
  EXPECT_EQ(per_second(20), 50);
  EXPECT_FALSE(per_second(0));
  EXPECT_FALSE(per_second(-1));
  EXPECT_FALSE(per_second(std::numeric_limits<double>::infinity()));
  const FramesResult result = run_frames({"crowd:20"}, question(Method::boxes, {0, 4}));
  const auto& summary = result.json["summary"];
  EXPECT_EQ(summary["fps"]["median"], 1000 / summary["ms"]["median"].get<double>());
  EXPECT_EQ(summary["fps"]["p95"], 1000 / summary["ms"]["p95"].get<double>());
  for (const auto& frame : result.json["frames"]) {
    const double ms =
        frame["time_ms"]["cull"].get<double>() + frame["time_ms"]["exact"].get<double>();
    EXPECT_EQ(frame["fps"], 1000 / ms);
    EXPECT_EQ(frame["draws"], 0);  // nothing is drawn there
    EXPECT_TRUE(frame.contains("radius")) << "boxes may leave nothing to draw in a frame";
    EXPECT_EQ(frame["warning"], nullptr);
  }
  EXPECT_FALSE(result.json.contains("radius"));
  for (const char* column : {"fps", "PCS objects", "PCS triangles"})
    EXPECT_TRUE(has_text(result.table, column)) << column;
  EXPECT_FALSE(has_text(result.table, "  draws"));
}

}  // namespace
}  // namespace farcull
