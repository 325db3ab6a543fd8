// The methods that draw, end to end on a GL device: the planner changes no answer, both query modes
// give the same, and the CULLIDE family is ordered as it should be.
#include "experiments/record/output.h"
#include "experiments/record/tables.h"
#include "tests/lab/plan.h"
#include "tests/lab/scenes.h"

namespace farcull {
namespace {

using lab::not_followed;

Session& session() {
  static Session shared("gl");
  return shared;
}

RunOptions options_of(Method method, int resolution = 64) {
  RunOptions options;
  options.method = method;
  options.resolution = resolution;
  return options;
}

constexpr Method kDrawing[] = {Method::far, Method::cullide, Method::quick_cullide,
                               Method::s_cullide};

Scene scene_for(const std::string& name, Method method) {
  Scene scene = make_builtin_scene(name);
  if (tests_self_alone(method))
    for (Object& object : scene.objects) object.self = true;
  return scene;
}

// GL draws where it is named, even if it is a software renderer, and finds the pairs of the native
// canvas where FAR promises. canvas_device_test.cpp has runs that name no device.
TEST(GlMethods, AreDrawnOnGlWhereItIsNamed) {
  const Scene scene = make_builtin_scene("crowd");
  Session native("native");
  RunOptions options = options_of(Method::far);
  options.device = "native";
  const Record there = run(scene, options, native);
  EXPECT_FALSE(there.found.device.gl);
  for (const std::string name : {"gl", "software"}) {
    Session gl(name);
    EXPECT_FALSE(gl.canvas_device().native);
    EXPECT_EQ(gl.canvas_device().reason, "--device " + name);
    options.device = name;
    const Record here = run(scene, options, gl);
    ASSERT_TRUE(here.found.device.gl);
    if (name == "software") {
      EXPECT_EQ(here.found.device.gl->kind, "software");
    }
    EXPECT_FALSE(here.found.device.cpu);
    EXPECT_EQ(here.collisions.pairs, there.collisions.pairs);
  }
}

TEST(GlMethods, RunsFollowThePlan) {
  for (const Method method : kDrawing) {
    for (const char* name : {"far-apart", "crowd"}) {
      // Each triangle of S-CULLIDE is drawn by itself.
      const Scene scene = scene_for(method == Method::s_cullide ? "degenerate" : name, method);
      for (const bool full : {false, true}) {
        RunOptions options = options_of(method);
        options.full = full;
        for (const QueryMode query : {QueryMode::flags, QueryMode::occlusion}) {
          options.query = query;
          EXPECT_EQ(not_followed(run(scene, options, session())), "")
              << scene.name << " " << to_string(method) << " full " << full;
        }
      }
    }
  }
}

// OBBs first, then exact offsets on what they have left, from the bits that they have set.
TEST(GlMethods, ExactOffsetsSeeWhatBoxesHaveLeft) {
  const Scene scene = make_builtin_scene("two-tori");
  RunOptions options = options_of(Method::far, 128);
  options.verify = false;
  const Record boxes = run(scene, options, session());
  options.offset = "exact";
  const Record both = run(scene, options, session());
  options.full = true;
  const Record alone = run(scene, options, session());
  ASSERT_GT(boxes.found.triangle_count, kFewTriangles);
  EXPECT_LT(both.found.triangle_count, boxes.found.triangle_count);
  std::uint64_t draws = 0, first_in = 0;
  bool second = false;
  for (const Stage& stage : both.trace) {
    second |= stage.kind == StageKind::setup && stage.fattener == "exact";
    if (second && first_in == 0 && stage.kind == StageKind::fatten) first_in = stage.in;
    if (second) draws += stage.draws;
  }
  EXPECT_EQ(first_in, boxes.found.triangle_count);
  std::uint64_t alone_draws = 0;
  for (const Stage& stage : alone.trace) alone_draws += stage.draws;
  EXPECT_GT(draws, 0u);
  // Those with bit F or L are asked and stored in one pass of a view, not in both.
  EXPECT_LT(draws, alone_draws / 2);
}

// Without a promise the exact offset stands alone, as a study of it means.
TEST(GlMethods, BoxesComeFirstOnlyWhereTheyCannotMiss) {
  const Scene scene = make_builtin_scene("crowd");
  RunOptions options = options_of(Method::far);
  options.offset = "exact";
  options.verify = false;
  const auto setups = [&] {
    const Record record = run(scene, options, session());
    return std::ranges::count_if(record.trace,
                                 [](const Stage& s) { return s.kind == StageKind::setup; });
  };
  EXPECT_EQ(setups(), 2);
  options.radius.factor = 0.9;
  EXPECT_EQ(setups(), 1);
}

TEST(GlMethods, ContactsOfAllThatIsMissedAreCounted) {
  const Record record =
      run(make_builtin_scene("two-spheres"), options_of(Method::cullide), session());
  ASSERT_GT(record.verification->false_negatives, kExamples);
  EXPECT_EQ(record.verification->examples.size(), kExamples);
  EXPECT_EQ(record.missed->touching + record.missed->penetrating,
            record.verification->false_negatives);
}

// What a run asked of its device is in its record, and adds up with its stages.
TEST(GlMethods, WhatADrawingRunAskedIsInItsRecord) {
  for (const Method method : kDrawing) {
    const Scene scene = scene_for("degenerate", method);
    for (const QueryMode query : {QueryMode::flags, QueryMode::occlusion}) {
      SCOPED_TRACE(std::string(to_string(method)) + (query == QueryMode::flags ? " flags" : ""));
      RunOptions options = options_of(method);
      options.query = query;
      const Record record = run(scene, options, session());
      const CanvasWork& work = record.found.asked;
      const Stage drawn = work_of(record.trace);
      const nlohmann::ordered_json json = to_json(scene, record)["device_work"];
      ASSERT_GT(work.passes, 0u);
      EXPECT_EQ(json["passes"], work.passes);
      EXPECT_EQ(json["draw_calls"], work.draws);
      EXPECT_EQ(json["uploaded_bytes"], work.uploaded_bytes);
      // A pass has two steps at least, each with a draw call of its own for the control items.
      EXPECT_GE(work.draws, 2 * work.passes);
      EXPECT_GE(work.state_changes, 2 * work.passes);
      // Each slot is a query, and so are a control item of each step and one for all primitives.
      if (query == QueryMode::flags) {
        EXPECT_EQ(work.queries, work.passes);
        EXPECT_EQ(work.readbacks, work.waits + work.passes);
      } else {
        EXPECT_GE(work.queries, drawn.queries + work.passes);
        EXPECT_GE(work.readbacks, drawn.queries + work.passes);
        EXPECT_GE(work.downloaded_bytes, 4 * drawn.queries);
      }
      // Each pass is waited for once, and so is each upload.
      EXPECT_GT(work.waits, work.passes);
      EXPECT_EQ(work.spans, work.waits);
      EXPECT_GE(work.uploaded_bytes, 8 * drawn.draws);
      EXPECT_EQ(json["device_ms"].is_null(), work.timed < work.spans);
      if (work.known_ms()) {
        EXPECT_GT(*work.known_ms(), 0);
        EXPECT_LT(*work.known_ms(), record.ms.setup + record.ms.cull);
      }
      EXPECT_TRUE(has_text(run_table(scene, record, ""), "\nwork "));
    }
  }
  // On the cores of the CPU there is no device to ask.
  RunOptions options = options_of(Method::far);
  options.device = "native";
  Session native("native");
  const Scene scene = make_builtin_scene("degenerate");
  const Record record = run(scene, options, native);
  EXPECT_TRUE(to_json(scene, record)["device_work"].is_null());
  EXPECT_FALSE(has_text(run_table(scene, record, ""), "\nwork "));
}

// One object: a sheet, and in it a triangle that only touches it and one that goes through.
TEST(GlMethods, SCullideMissesWhatOnlyTouchesAndSaysSo) {
  Scene scene = lab::scene_of({{{Vec3(0, 0, 0), Vec3(8, 0, 0), Vec3(0, 8, 0)},
                                {Vec3(2, 2, 0), Vec3(3, 2, 1), Vec3(2, 3, 1)},
                                {Vec3(1, 1, -1), Vec3(1.5, 1, 1), Vec3(1, 1.5, 1)}}});
  scene.objects[0].self = true;
  RunOptions options = options_of(Method::s_cullide, 256);
  options.views = "-z";
  const Record record = run(scene, options, session());
  EXPECT_EQ(record.collisions.pairs, (std::vector<TrianglePair>{{0, 2}}));
  ASSERT_TRUE(record.verification);
  EXPECT_EQ(record.verification->false_negatives, 1u);
  EXPECT_EQ(record.missed, (ContactCounts{.touching = 1, .penetrating = 0}));
  EXPECT_FALSE(broken(record, false));
  EXPECT_TRUE(broken(record, true));
  // The reliable answer beside it.
  RunOptions pairs = options_of(Method::boxes);
  EXPECT_EQ(run(scene, pairs, session()).collisions.pairs,
            (std::vector<TrianglePair>{{0, 1}, {0, 2}}));
}

// Spheres of 5120 triangles: 16 patches each.
TEST(GlMethods, FarFindsThePairsInsideObjectsToo) {
  Scene scene = make_builtin_scene("two-spheres");
  // Vertices of one half moved through the other: the sphere pierces itself.
  for (std::size_t v = 0; v < scene.vertices.size(); v += 40) scene.vertices[v] *= 0.5;
  for (Object& object : scene.objects) object.self = true;
  const Record exact = run(scene, options_of(Method::exact), session());
  ASSERT_GT(exact.collisions.neighbour_pairs.size() + exact.collisions.pairs.size(), 0u);
  for (const char* offset : {"obb", "exact"}) {
    for (const bool full : {false, true}) {
      RunOptions options = options_of(Method::far, 128);
      options.offset = offset;
      options.full = full;
      const Record record = run(scene, options, session());
      EXPECT_EQ(record.collisions.pairs, exact.collisions.pairs);
      EXPECT_EQ(record.collisions.neighbour_pairs, exact.collisions.neighbour_pairs);
      EXPECT_EQ(record.verification->false_negatives, 0u);
      EXPECT_TRUE(record.promise.holds);
      EXPECT_EQ(not_followed(record), "");
    }
  }
  RunOptions options = options_of(Method::far, 128);
  options.verify = options.neighbours = false;
  const Record apart = run(scene, options, session());
  EXPECT_EQ(apart.collisions.pairs, exact.collisions.pairs);
  EXPECT_EQ(apart.collisions.neighbours, 0u);
  EXPECT_LT(apart.found.count, exact.found.count / 2);
}

}  // namespace
}  // namespace farcull
