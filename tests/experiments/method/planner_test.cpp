// The planner without a GL device: what is left out, that it is said, and that it changes no
// answer.
#include "experiments/method/plan.h"
#include "experiments/record/output.h"

#include <rapidcheck/gtest.h>

#include "experiments/measure/compare.h"
#include "tests/lab/plan.h"
#include "tests/lab/runs.h"
#include "tests/lab/scenes.h"

namespace farcull {
namespace {

using lab::not_followed, lab::on_cpu, lab::run;

Stage stage_named(const Plan& plan, const std::string& name) {
  for (const Stage& stage : plan.stages())
    if (name_of(stage) == name) return stage;
  ADD_FAILURE() << name << " is not in the plan";
  return {};
}

std::string decision(const Plan& plan, const std::string& name) {
  return decision_of(stage_named(plan, name));
}

bool has(const Plan& plan, StageKind kind) {
  const std::vector<Stage> stages = plan.stages();
  return std::ranges::any_of(stages, [&](const Stage& stage) { return stage.kind == kind; });
}

TEST(Planner, LeavesTheDeviceOutWhereBoxesDecide) {
  const Scene scene = make_builtin_scene("far-apart");
  RunOptions far{.method = Method::far};
  EXPECT_EQ(decision(plan(scene, far), "draw"), "left out");
  EXPECT_FALSE(has(plan(scene, far), StageKind::setup));
  far.full = true;
  EXPECT_EQ(decision(plan(scene, far), "setup"), "runs");
  EXPECT_EQ(decision(plan(scene, on_cpu(Method::boxes)), "blocks"), "left out");
  const Record record = run(scene, on_cpu(Method::boxes));
  EXPECT_FALSE(record.found.device.cpu);
  EXPECT_FALSE(record.found.device.gl);
  EXPECT_FALSE(no_device_reason(record.trace).empty());
}

// FAR draws on every scene whose objects' boxes overlap, without a flag. Where none do, it says so.
void expect_drawn(bool of_packaged_meshes) {
  std::size_t drawn = 0, apart = 0;
  for (const std::string& name : lab::scene_names(of_packaged_meshes)) {
    const Scene scene = make_builtin_scene(name);
    const std::vector<Box> boxes = object_boxes(scene, triangle_boxes(scene));
    bool meet = has_self(scene);  // patches of such an object are drawn
    for (auto a = boxes.begin(); a != boxes.end() && !meet; ++a)
      meet = std::any_of(boxes.begin(), a, [&](const Box& b) { return overlap(*a, b); });
    const Plan planned = plan(scene, {.method = Method::far});
    EXPECT_EQ(has(planned, StageKind::fatten), meet) << name;
    const std::string heading = plan_table(scene, planned).substr(0, 200);
    EXPECT_EQ(has_text(heading, ", far at 512 px"), meet) << heading;
    EXPECT_EQ(has_text(heading, ", far, nothing left to draw"), !meet) << heading;
    EXPECT_EQ(has_text(heading, "takes less time than drawing"), meet) << heading;
    ++(meet ? drawn : apart);
  }
  EXPECT_GT(drawn, apart);
  EXPECT_GT(apart, 0u) << "the twin: a scene of separate boxes";
}

TEST(Planner, FarDrawsWhereverBoxesOfObjectsOverlap) { expect_drawn(false); }
TEST(PackagedScenes, FarDrawsWhereverBoxesOfObjectsOverlap) { expect_drawn(true); }

TEST(Planner, ABroadPhaseOfTrianglesLeavesLessToDraw) {
  const Scene scene = make_builtin_scene("two-spheres");
  // Shortcuts end a run after a view that culls little, which differs for the two.
  RunOptions far{.method = Method::far, .device = "native", .no_shortcuts = true};
  const Record exact = run(scene, {.method = Method::exact});
  const Record published = run(scene, far);
  far.broad_phase = BroadPhase::triangles;
  const Record drawn = run(scene, far);
  EXPECT_EQ(drawn.collisions.pairs, exact.collisions.pairs);
  EXPECT_LT(drawn.found.count, exact.found.count);
  EXPECT_LE(drawn.found.triangle_count, published.found.triangle_count);
  EXPECT_LT(drawn.found.views()[0].pixel_size, published.found.views()[0].pixel_size);
}

// Where slivers overlap, boxes of triangles settle little, and those of objects are compared.
TEST(Planner, TheRecordNamesTheBoxesThatWereCompared) {
  const auto phase_of = [](const char* name) {
    return run(make_builtin_scene(name), {.method = Method::far,
                                          .resolution = 64,
                                          .broad_phase = BroadPhase::triangles,
                                          .device = "native"})
        .options.broad_phase;
  };
  EXPECT_EQ(phase_of("cad-cut:2000"), BroadPhase::objects);
  EXPECT_EQ(phase_of("two-spheres"), BroadPhase::triangles);
}

// A record names only what drew.
TEST(Planner, OptionsOfDrawingAreNullWhereNothingIsLeftToDraw) {
  for (const Method method : {Method::far, Method::cullide}) {
    const Scene apart = make_builtin_scene("far-apart"),
                spheres = make_builtin_scene("two-spheres");
    const RunOptions options{.method = method, .resolution = 64, .device = "native"};
    const nlohmann::ordered_json none = to_json(apart, run(apart, options));
    const nlohmann::ordered_json some = to_json(spheres, run(spheres, options));
    for (const char* key : {"resolution", "depth", "depth_format", "clear", "level", "views"}) {
      EXPECT_TRUE(none.at(key).is_null()) << key;
      EXPECT_FALSE(some.at(key).is_null()) << key;
    }
    for (const char* key : {"radius", "offset", "budget"}) {
      EXPECT_TRUE(none.at(key).is_null()) << key;
      EXPECT_EQ(some.at(key).is_null(), method != Method::far && key != std::string("budget"));
    }
    EXPECT_EQ(none.at("broad_phase"), "objects");
    const std::string table = run_table(apart, run(apart, options));
    EXPECT_TRUE(has_text(table, "method     " + to_string(method) + ", nothing left to draw"));
    EXPECT_FALSE(has_text(table, " px"));
  }
}

// Two triangles that share a vertex are no drawn pair, and boxes of others do not overlap.
TEST(Planner, SaysWhyBoxesOfTrianglesLeaveNothingToDraw) {
  Scene scene = lab::scene_of({{{Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(0, 1, 0)}},
                               {{Vec3(0, 0, 0), Vec3(0, 0, 1), Vec3(1, 1, 1)}}});
  scene.triangles[1][0] = scene.triangles[0][0];
  const RunOptions far{.method = Method::far, .broad_phase = BroadPhase::triangles};
  EXPECT_EQ(stage_named(plan(scene, far), "draw").reason, Reason::nothing_to_look_at);
  EXPECT_EQ(run(scene, far).collisions.pairs.size(), 1u);
  const auto at = [](double x) {
    return std::array{Vec3(x, x, x), Vec3(x + 1, x, x), Vec3(x, x + 1, x)};
  };
  const Scene apart = lab::scene_of({{at(0), at(10)}, {at(5), at(15)}});
  EXPECT_EQ(stage_named(plan(apart, far), "draw").reason, Reason::no_box_pairs);
}

// An object that is tested against itself is cut into patches, which are no objects, also where
// nothing else would be drawn.
TEST(Planner, RefusesToAskObjectsAloneWhereOneIsCut) {
  Scene scene = make_builtin_scene("two-spheres");
  RunOptions far{.method = Method::far};
  far.objects_alone = true;
  EXPECT_NO_THROW(plan(scene, far));
  for (Object& object : scene.objects) object.self = true;
  for (const BroadPhase phase : {BroadPhase::objects, BroadPhase::triangles}) {
    far.broad_phase = phase;
    EXPECT_THROW(plan(scene, far), Error);
  }
}

TEST(Planner, SaysWhatItLeavesOut) {
  const Scene scene = make_builtin_scene("two-spheres");
  RunOptions far{.method = Method::far};
  EXPECT_FALSE(has(plan(scene, far), StageKind::offset));
  EXPECT_EQ(decision(plan(scene, far), "sub-object level"), "left out");
  EXPECT_EQ(decision(plan(scene, far), "fatten x, round 1"), "runs");
  EXPECT_EQ(decision(plan(scene, far), "cull triangles x, round 1"), "runs");
  const Scene crowd = make_builtin_scene("crowd");
  EXPECT_EQ(decision(plan(crowd, far), "object level"), "left out") << "triangles are asked anyway";
  EXPECT_EQ(decision(plan(scene, far), "fatten y, round 1"), "depends");
  far.offset = "exact";
  EXPECT_EQ(decision(plan(scene, far), "offset exact"), "depends");
  far.verify = false;
  EXPECT_EQ(decision(plan(scene, far), "verify"), "left out");
  // A method that promises nothing leaves out no view that could cull: its answer would change.
  far = {};
  far.method = Method::cullide;
  EXPECT_EQ(reason_of(stage_named(plan(scene, far), "fatten y, round 1")),
            "if any triangle is left");
  far.full = true;
  EXPECT_EQ(decision(plan(scene, far), "fatten y, round 1"), "runs");
  far.method = Method::far;
  EXPECT_EQ(decision(plan(crowd, far), "cull objects x, round 1"), "runs");
}

TEST(Planner, ASampleOrdersTheViewsOfFarUnlessTheyAreGiven) {
  const Scene scene = make_builtin_scene("two-tori");
  RunOptions far{.method = Method::far};
  EXPECT_EQ(decision(plan(scene, far), "fatten z, round 1"), "runs");
  EXPECT_EQ(decision(plan(scene, far), "fatten x, round 1"), "depends");
  const auto of_y = [&] { return reason_of(stage_named(plan(scene, far), "fatten y, round 1")); };
  EXPECT_EQ(of_y(), "if more than 256 triangles are left, and the last view culled one in 3");
  far.views = "x,y,z";
  EXPECT_EQ(decision(plan(scene, far), "fatten x, round 1"), "runs");
  far.clear = ClearRule::all;  // the rule is then one of rounds
  EXPECT_EQ(of_y(), "if any triangle is left");
}

TEST(Planner, IsTheSameTwiceAndNamesEveryStageInJson) {
  const Scene scene = make_builtin_scene("crowd");
  for (const Method method : all_methods()) {
    if (tests_self_alone(method)) continue;
    RunOptions options;
    options.method = method;
    const Plan planned = plan(scene, options);
    const nlohmann::ordered_json once = plan_json(scene, planned);
    EXPECT_EQ(once, plan_json(scene, plan(scene, options)));
    EXPECT_EQ(once["steps"].size(), planned.stages().size());
    for (const auto& s : once["steps"]) EXPECT_FALSE(s["reason"].get<std::string>().empty());
  }
}

// An object of one patch has nothing to draw: the answer is that of a box join, without a device.
TEST(Planner, FarJoinsSmallObjectsByBoxesAlone) {
  int colliding = 0;
  const RunOptions options{.method = Method::far, .broad_phase = BroadPhase::triangles};
  for (int seed = 0; seed < 20; ++seed) {
    Scene scene = lab::random_scene(seed);
    scene.objects.resize(1);
    scene.triangles.resize(scene.objects[0].triangle_count);
    scene.source_face.resize(scene.triangles.size());
    scene.objects[0].self = true;
    const Record far = run(scene, options);
    const Record exact = run(scene, on_cpu(Method::exact));
    EXPECT_EQ(far.collisions.pairs, exact.collisions.pairs);
    EXPECT_EQ(far.verification->false_negatives, 0u);
    EXPECT_EQ(not_followed(far), "");
    EXPECT_TRUE(far.promise.holds);
    EXPECT_FALSE(far.found.device.gl);
    EXPECT_EQ(far.plan[1].kind, StageKind::patches);
    EXPECT_EQ(decision_of(far.plan[1]), "left out");
    colliding += static_cast<int>(far.collisions.pairs.size());
  }
  EXPECT_GT(colliding, 0);
}

// The methods that draw nothing, on every built-in scene.
void expect_runs_follow(bool of_packaged_meshes) {
  const auto most_triangles =
      static_cast<std::size_t>(trials(5000));  // of a run that leaves out nothing
  for (const std::string& name : lab::scene_names(of_packaged_meshes)) {
    Scene scene = make_builtin_scene(name);
    for (const bool self : {false, true}) {
      for (Object& object : scene.objects) object.self = self;
      for (const Method method : {Method::boxes, Method::i_collide, Method::exact}) {
        for (const bool full : {false, true}) {
          RunOptions options = on_cpu(method);
          options.full = options.verify = full;
          if (full && scene.triangles.size() > most_triangles) continue;
          EXPECT_EQ(not_followed(run(scene, options)), "")
              << name << " " << to_string(method) << " full " << full << " self " << self;
        }
      }
    }
  }
}

TEST(Planner, RunsFollowIt) { expect_runs_follow(false); }
TEST(PackagedScenes, RunsFollowTheirPlans) { expect_runs_follow(true); }

// The methods that draw, on the native canvas; gl_methods_test.cpp has some on GL.
TEST(Planner, RunsThatDrawFollowIt) {
  Session session("native");
  for (const std::string& name : lab::scene_names(false, 3000)) {
    Scene scene = make_builtin_scene(name);
    for (const Method method : all_methods()) {
      if (!draws(method)) continue;
      // S-CULLIDE asks triangle by triangle.
      if (tests_self_alone(method) && scene.triangles.size() > 2000) continue;
      for (const bool self : {false, true}) {
        if (self ? !tests_self(method) : tests_self_alone(method)) continue;
        for (Object& object : scene.objects) object.self = self;
        for (const bool full : {false, true}) {
          if (full && scene.triangles.size() > 3000) continue;
          RunOptions options{.method = method, .resolution = 64, .device = "native"};
          options.full = full;
          options.verify = false;
          if (fattens(method)) options.offset = "exact";
          EXPECT_EQ(not_followed(run(scene, options, session)), "")
              << name << " " << to_string(method) << " full " << full << " self " << self;
        }
      }
    }
  }
}

TEST(PlannerTwin, ARunThatDoesNotFollowIsNoticed) {
  const Scene scene = make_builtin_scene("two-spheres");
  const Record good = run(scene, on_cpu(Method::boxes));
  ASSERT_EQ(not_followed(good), "");
  const auto spoilt = [&](auto change) {
    Record record = good;
    change(record);
    return not_followed(record);
  };
  EXPECT_NE(spoilt([](Record& r) { r.trace.erase(r.trace.begin()); }), "");
  EXPECT_NE(spoilt([](Record& r) { r.plan.erase(r.plan.begin()); }), "");
  EXPECT_NE(spoilt([](Record& r) { ++r.plan.front().n; }), "");
  EXPECT_NE(spoilt([](Record& r) { r.trace.front().reason = Reason::full; }), "");
  EXPECT_NE(spoilt([](Record& r) { r.trace.back().ran = false; }), "");
  EXPECT_NE(spoilt([](Record& r) { r.plan.push_back({.kind = StageKind::sweep, .ran = true}); }),
            "");
  // A stage that only pixels may decide, though the plan has none of its kind.
  EXPECT_NE(spoilt([](Record& r) {
              r.trace.push_back({.kind = StageKind::sweep, .ran = true, .depends = true});
            }),
            "");
}

// The guarantee of the planner: what is left out changes no answer.
RC_GTEST_PROP(Planner, FullFindsTheSamePairs, ()) {
  Scene scene = lab::random_scene(*rc::gen::arbitrary<std::uint64_t>());
  const bool self = *rc::gen::arbitrary<bool>();
  for (Object& object : scene.objects) object.self = self;
  const Record exact = run(scene, on_cpu(Method::exact));
  for (const Method method : {Method::boxes, Method::i_collide}) {
    for (const bool full : {false, true}) {
      RunOptions options = on_cpu(method);
      options.full = full;
      const Record record = run(scene, options);
      RC_ASSERT(record.collisions.pairs == exact.collisions.pairs);
      RC_ASSERT(record.collisions.neighbour_pairs == exact.collisions.neighbour_pairs);
      RC_ASSERT(record.verification->false_negatives == 0u);
    }
  }
}

TEST(ICollide, CountsTheTrianglesThatBoxesOfObjectsLeave) {
  const Scene scene = make_builtin_scene("crowd");
  const std::vector<Box> boxes = object_boxes(scene, triangle_boxes(scene));
  std::uint64_t triangles = 0;
  for (std::size_t a = 0; a < boxes.size(); ++a) {
    bool meets = false;
    for (std::size_t b = 0; b < boxes.size(); ++b) meets |= a != b && overlap(boxes[a], boxes[b]);
    if (meets) triangles += scene.objects[a].triangle_count;
  }
  EXPECT_GT(triangles, 0u);
  EXPECT_EQ(run(scene, on_cpu(Method::i_collide)).found.swept_triangles(), triangles);
}

TEST(ICollide, TheSweepOfASessionServesAnyScene) {
  Session session("cpu");
  for (const char* name : {"crowd", "two-spheres", "crowd", "far-apart", "crowd"}) {
    const Scene scene = make_builtin_scene(name);
    const Record kept = run(scene, on_cpu(Method::i_collide), session);
    EXPECT_EQ(kept.collisions.pairs, run(scene, on_cpu(Method::exact)).collisions.pairs) << name;
  }
}

TEST(Methods, NamesGoBothWaysAndUnknownOnesAreRefused) {
  for (const Method method : all_methods()) EXPECT_EQ(parse_method(to_string(method)), method);
  const Error error = error_of([] { parse_method("nope"); });
  EXPECT_EQ(error.where, "--method");
  for (const Method method : all_methods()) EXPECT_TRUE(has_text(error.remedy, to_string(method)));
}

}  // namespace
}  // namespace farcull
