// The rules by which culling leaves out levels, rounds and views; triangles as owners; forms of
// CULLIDE.
#include "core/cull/cull.h"

#include "core/base/text.h"
#include "core/boxes/join.h"
#include "core/cull/view_order.h"
#include "core/native/canvas.h"
#include "experiments/record/stage_words.h"
#include "tests/lab/cull.h"
#include "verify/accounting.h"

namespace farcull {
namespace {

/// Objects of one triangle each in a stack, so close that all boxes overlap.
Scene stack(int objects) {
  std::vector<std::vector<std::array<Vec3, 3>>> out;
  for (double z = 0; z < objects; ++z)
    out.push_back({{Vec3(0, 0, z), Vec3(9, 0, z + objects), Vec3(0, 9, z + objects)}});
  return lab::scene_of(out);
}

CullSettings settings_of(const Fattener& fattener) {
  return {.views = parse_views("x,y,z"),
          .resolution = 64,
          .fattener = fattener,
          .radius = {},
          .worth_a_view = kWorthAView};
}

CullResult cull_of(const Scene& scene, const CullSettings& settings) {
  NativeCanvas canvas(settings.fattener.mode, settings.fattener.solid);
  return cull(scene, find_regions(scene), settings, canvas);
}

const Stage* find_stage(const std::vector<Stage>& stages, StageKind kind) {
  for (const Stage& stage : stages)
    if (stage.kind == kind) return &stage;
  return nullptr;
}

bool asked_objects(const std::vector<Stage>& stages) {
  for (const Stage& stage : stages)
    if (stage.level == kObjectLevel && stage.ran) return true;
  return false;
}

TEST(CullRules, TheObjectLevelCanBeLeftOut) {
  const Fattener fattener = obb_fattener();
  const Scene scene = stack(2);
  for (const bool left_out : {false, true}) {
    SCOPED_TRACE(left_out);
    CullSettings settings = settings_of(fattener);
    settings.object_level = !left_out;
    const CullResult result = cull_of(scene, settings);
    const std::vector<Stage> planned = planned_stages(scene, find_regions(scene), settings);
    for (const auto* stages : {&result.stages, &planned}) {
      const Stage* stage = find_stage(*stages, StageKind::objects);
      EXPECT_EQ(stage != nullptr, left_out);
      EXPECT_EQ(asked_objects(*stages), !left_out);
      if (stage != nullptr) {
        EXPECT_EQ(stage->reason, Reason::asked_singly);
      }
    }
  }
}

// The window cuts the large triangle to a polygon of more than three corners. Small triangles meet
// it everywhere in the window.
TEST(CullRules, EveryPartOfAClippedTriangleIsDrawn) {
  std::vector<std::array<Vec3, 3>> small;
  for (int x = 0; x < 8; ++x) {
    for (int y = 0; y < 8; ++y) {
      const Vec3 p(x, y, -0.5);
      small.push_back({p, p + Vec3(0.5, 0, 1), p + Vec3(0, 0.5, 1)});
    }
  }
  const Scene scene = lab::scene_of(std::vector<std::vector<std::array<Vec3, 3>>>{
      {{Vec3(-90, -80, 0), Vec3(100, -70, 0), Vec3(-10, 120, 0)}}, small});
  for (const Fattener& fattener : {obb_fattener(), minkowski_fattener()}) {
    CullSettings settings = settings_of(fattener);
    settings.views = parse_views("z");
    EXPECT_EQ(cull_of(scene, settings).live.size(), scene.triangles.size()) << fattener.name;
  }
}

/// Adds an object: n x n small triangles in the square from `at` along `u` and `v`.
void add_sheet(Vec3 at, const Vec3& u, const Vec3& v, int n,
               std::vector<std::vector<std::array<Vec3, 3>>>& out) {
  out.emplace_back();
  for (int i = 0; i < n; ++i) {
    for (int k = 0; k < n; ++k) {
      const Vec3 p = at + u * i / n + v * k / n;
      out.back().push_back({p, p + u * 0.01, p + v * 0.01});
    }
  }
}

std::string order_of(const std::vector<std::vector<std::array<Vec3, 3>>>& objects,
                     const std::string& views) {
  const Scene scene = lab::scene_of(objects);
  Regions regions;
  regions.places = {{Vec3::Zero(), Vec3::Constant(100)}};
  regions.triangles.resize(scene.triangles.size());
  std::iota(regions.triangles.begin(), regions.triangles.end(), 0u);
  std::string out;
  for (const View& view : order_views(scene, regions, owners(scene), parse_views(views)))
    out += (out.empty() ? "" : ",") + view.name;
  return out;
}

// Along z, one of two sheets hides the other. Along x and y, each is seen from its edge.
TEST(ViewOrder, BeginsWithTheViewInWhichLeastIsHidden) {
  std::vector<std::vector<std::array<Vec3, 3>>> objects;
  for (const double z : {0, 60}) add_sheet({0, 0, z}, {40, 0, 0}, {0, 40, 0}, 20, objects);
  EXPECT_EQ(order_of(objects, "z,x,y"), "x,z,y");  // equal views stay in their order
  EXPECT_EQ(order_of(objects, "z,y,-x"), "y,z,-x");
  // The second object is cleared against the first, which it hides and so need not be compared
  // with.
  EXPECT_EQ(order_of(objects, "-z,x"), "-z,x");
  const double most = std::numeric_limits<double>::max();
  objects.push_back({{Vec3::Constant(most), Vec3::Constant(-most), Vec3(most, -most, most)}});
  EXPECT_EQ(order_of(objects, "z,x,y"), "x,z,y");
  EXPECT_EQ(order_of(objects, "z"), "z");
  EXPECT_EQ(order_of({}, "z,x"), "z,x");
}

// Along z the objects of three sheets lie in the order 1, 2, 0. Only object 1 is cleared there.
TEST(ViewOrder, CountsWhatBothPassesClear) {
  std::vector<std::vector<std::array<Vec3, 3>>> objects;
  for (const double z : {60, 0, 30}) add_sheet({0, 0, z}, {40, 0, 0}, {0, 40, 0}, 10, objects);
  for (const double x : {0, 80}) add_sheet({x, 60, 0}, {0, 40, 0}, {0, 0, 40}, 12, objects);
  EXPECT_EQ(order_of(objects, "z,x"), "x,z");  // 300 + 144 against 100 + 2 * 144
}

// The sheet in the middle of three, whose object is the last, is hidden in x and in -x.
TEST(ViewOrder, GoesOnWithTheViewThatCullsMostOfTheRest) {
  std::vector<std::vector<std::array<Vec3, 3>>> objects;
  for (const double z : {0, 60}) add_sheet({0, 0, z}, {40, 0, 0}, {0, 40, 0}, 20, objects);
  for (const double x : {0, 80, 40}) add_sheet({x, 60, 0}, {0, 40, 0}, {0, 0, 40}, 10, objects);
  EXPECT_EQ(order_of(objects, "x,-x,z"), "x,z,-x");
}

// Whatever is left out, what intersects stays, and what a run without rules culls is a superset.
TEST(CullRules, AViewFollowsOneThatCulledAThird) {
  const Fattener fattener = obb_fattener();
  int left_out = 0, went_on = 0;
  for (std::uint64_t seed = 1; seed <= 60; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    const Scene scene = lab::random_scene(seed);
    const CullSettings settings = settings_of(fattener);
    CullSettings without = settings;
    without.worth_a_view = 0;
    const CullResult result = cull_of(scene, settings), all = cull_of(scene, without);
    EXPECT_TRUE(
        std::includes(result.live.begin(), result.live.end(), all.live.begin(), all.live.end()));
    std::uint64_t in = 0;   // live triangles before the visit
    std::uint64_t out = 0;  // and behind it
    for (const Stage& stage : result.stages) {
      if (stage.kind == StageKind::fatten) {
        EXPECT_GE((in - out) * kWorthAView, in);  // else there is no further view
        went_on += in > 0;
        in = stage.in;
      }
      if (stage.kind == StageKind::cull) out = stage.out;
      if (stage.reason != Reason::little_culled) continue;
      ++left_out;
      EXPECT_LT(stage.n * kWorthAView, stage.m);
      EXPECT_EQ(stage.m, in);
      EXPECT_EQ(stage.n, in - result.live.size());
    }
  }
  EXPECT_GT(left_out, 5);
  EXPECT_GT(went_on, 5);
}

// ---- Triangles as owners: S-CULLIDE with raw triangles and a strict test, and the same with
// fattened ones, which promises.

using lab::Drawing, lab::Trace;

CullSettings self_settings(const Drawing& drawing, bool touching) {
  const bool raw = drawing.fattener.name == "raw";
  CullSettings settings = lab::cull_settings(drawing, raw ? "z,-z" : "x,y,z", raw ? 24 : 16);
  settings.self = true;
  settings.touching = touching;
  return settings;
}

// Two sheets of one object at one depth touch: seen at the stored depth, not behind it.
TEST(CullSelf, TouchingContactsAreKeptOrIgnoredAsAsked) {
  std::vector<std::array<Vec3, 3>> triangles;
  for (int i = 0; i < 2; ++i)
    triangles.push_back({Vec3(0, 0, 0), Vec3(1, 0.25 * i, 0), Vec3(0.25 * i, 1, 0)});
  triangles.push_back({Vec3(0, 0, 1), Vec3(0, 0, 1), Vec3(0, 0, 1)});  // gives the view a depth
  Scene scene = lab::scene_of(std::vector<std::vector<std::array<Vec3, 3>>>{triangles});
  scene.objects[0].self = true;
  const Drawing raw = lab::raw_on_ideal();
  CullSettings settings = self_settings(raw, true);
  settings.views = parse_views("z");
  EXPECT_EQ(lab::run_by(kQuickRule, scene, raw, settings).result.live,
            (std::vector<std::uint32_t>{0, 1}));
  settings.touching = false;
  EXPECT_TRUE(lab::run_by(kQuickRule, scene, raw, settings).result.live.empty());
}

// The twin: the strict test loses conflicts at equal depth, and objects as owners lose all inside.
TEST(CullSelf, TheStrictTestAndObjectsAsOwnersLoseConflicts) {
  const Drawing raw = lab::raw_on_ideal();
  int strict = 0, objects = 0;
  for (int n = 0; n < 40; ++n) {
    const Scene scene = lab::scene_of(lab::random_small(2200 + n, 80), true);
    CullSettings settings = self_settings(raw, true);
    const lab::Pairs wanted = lab::conflicts(scene, raw, settings);
    settings.touching = false;
    strict += lab::wrongly_cleared(lab::run_by(kQuickRule, scene, raw, settings), wanted);
    settings.touching = true;
    settings.self = false;
    const auto live = lab::run_by(kQuickRule, scene, raw, settings).result.live;
    for (const auto& [u, t] : wanted) objects += !std::ranges::binary_search(live, u);
  }
  EXPECT_GT(strict, 0);
  EXPECT_GT(objects, 0);
}

TEST(CullSelf, FattenedTrianglesAsOwnersMissNothing) {
  const Drawing obb = lab::on_worst(obb_fattener());
  std::size_t pairs = 0, culled = 0;
  for (int n = 0; n < 40; ++n) {
    Scene scene = lab::random_scene(8100 + n);
    for (Object& object : scene.objects) object.self = true;
    const lab::Pairs wanted = lab::collisions(scene);
    const Trace run = lab::run_by(kQuickRule, scene, obb, self_settings(obb, true));
    ASSERT_EQ(lab::wrongly_cleared(run, wanted), 0) << n;
    pairs += wanted.size();
    culled += scene.triangles.size() - run.result.live.size();
  }
  EXPECT_GT(pairs, 500u);
  EXPECT_GT(culled, 50u);
}

TEST(CullSelf, ThePlanTakesTheWholeOfObjectsThatAreTestedAgainstThemselves) {
  const std::array<Vec3, 3> one = {Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(0, 1, 0)};
  Scene scene = lab::scene_of(std::vector<std::vector<std::array<Vec3, 3>>>{{one, one, one}});
  scene.objects[0].self = true;
  EXPECT_TRUE(find_regions(scene).triangles.empty());
  const Regions plan = find_regions(scene, {.self = true});
  EXPECT_EQ(plan.triangles.size(), scene.triangles.size());
  ASSERT_EQ(plan.places.size(), 1u);
  EXPECT_EQ(plan.places[0].lo, plan.object_boxes[0].lo);
  scene.objects[0].self = false;
  EXPECT_TRUE(find_regions(scene, {.self = true}).triangles.empty());
}

// ---- forms: a limit of rounds, views that all have to clear, objects alone ----

using namespace lab;
using Indices = std::vector<std::uint32_t>;

constexpr int kPixels = 24;
constexpr std::uint64_t kScenes = 40;

Scene scene_at(std::uint64_t seed) { return scene_of(random_small(seed, 50)); }

Indices live(const Scene& scene, const Drawing& drawing, const CullSettings& settings) {
  return cull(scene, find_regions(scene), settings, *drawing.canvas).live;
}

TEST(CullRules, RefusesWhatDoesNotFitTheScene) {
  const Drawing drawing = raw_on_ideal();
  const Scene scene = scene_of(random_small(1, 10), true);
  const CullSettings fits = cull_settings(drawing, "x", kPixels);
  CullSettings bits = fits, owners = fits, alone = fits;
  bits.bits = {0};
  owners.owners.resize(3);
  alone.self = alone.objects_alone = true;  // then triangles own, and there are no objects to ask
  for (const CullSettings& settings : {bits, owners, alone}) {
    EXPECT_THROW(cull(scene, find_regions(scene, {.self = true}), settings, *drawing.canvas),
                 std::logic_error);
  }
}

// With offsets that promise, every form keeps the promise; raw triangles do not, on the same
// canvas.
TEST(CullRules, FarMissesNothingInAnyForm) {
  const Drawing drawing = on_worst(obb_fattener());
  const Drawing raw = on_worst(raw_triangles());
  std::uint64_t missed_raw = 0;
  std::array<int, 8> culled{};  // by FAR, in each form
  for (std::uint64_t seed = 1; seed <= kScenes / 8; ++seed) {
    const Scene scene = scene_at(seed);
    for (int form = 0; form < 8; ++form) {
      const auto missed = [&](const Drawing& of) {
        CullSettings settings = cull_settings(of, "x,-x,z", kPixels / 2);
        settings.rounds = form & 1;
        settings.clear = form & 2 ? ClearRule::all : ClearRule::any;
        settings.objects_alone = form & 4;
        const Indices kept = live(scene, of, settings);
        if (&of == &drawing) culled.at(form) += kept.size() < scene.triangles.size();
        return account(scene, box_join(triangle_boxes(scene), owners(scene), kept)).false_negatives;
      };
      EXPECT_EQ(missed(drawing), 0u) << "seed " << seed << " form " << form;
      missed_raw += missed(raw);
    }
  }
  // Objects alone that all views have to clear (6 and 7) are never cleared in these scenes.
  for (int form = 0; form < 6; ++form) EXPECT_GT(culled.at(form), 0) << "form " << form;
  EXPECT_GT(missed_raw, 0u) << "the twin: raw triangles miss";
}

TEST(CullRules, PlansNameTheStagesOfTheFirstRound) {
  const Drawing drawing = raw_on_ideal();
  const Scene scene = scene_at(5);
  for (int form = 0; form < 8; ++form) {
    CullSettings settings = cull_settings(drawing, "x,z", kPixels);
    settings.rounds = form & 1;
    settings.clear = form & 2 ? ClearRule::all : ClearRule::any;
    settings.objects_alone = form & 4;
    settings.full = true;
    std::vector<std::string> planned, went;
    for (const Stage& stage : planned_stages(scene, find_regions(scene), settings))
      if (stage.kind != StageKind::further_rounds) planned.push_back(name_of(stage));
    for (const Stage& stage : cull(scene, find_regions(scene), settings, *drawing.canvas).stages)
      if (stage.kind != StageKind::further_rounds && stage.round <= 1)
        went.push_back(name_of(stage));
    EXPECT_EQ(planned, went) << "form " << form;
  }
}

// ---- what is left out ----

const Stage* stage_named(const CullResult& result, const std::string& part) {
  for (const Stage& stage : result.stages)
    if (name_of(stage).find(part) != std::string::npos) return &stage;
  return nullptr;
}

TEST(CullRules, NoLevelForAnEmptySet) {
  // Two layers apart: the objects clear each other.
  const auto layer = [](double z) {
    return std::vector<std::array<Vec3, 3>>{{Vec3(0, 0, z), Vec3(1, 0, z + 1), Vec3(0, 1, z + 1)}};
  };
  const Drawing drawing = lab::raw_on_ideal();
  const Scene scene =
      lab::scene_of(std::vector<std::vector<std::array<Vec3, 3>>>{layer(0), layer(0.5)});
  CullSettings settings = lab::cull_settings(drawing, "z,x", 16);
  settings.clusters.sizes = {2};
  const CullResult result = lab::run_by(kQuickRule, scene, drawing, settings).result;
  EXPECT_TRUE(result.live.empty());
  for (const char* level : {"cull triangles z, round 1", "view x, round 1", "further rounds"}) {
    const Stage* stage = stage_named(result, level);
    ASSERT_NE(stage, nullptr) << level;
    EXPECT_FALSE(stage->ran);
    EXPECT_TRUE(has_text(reason_of(*stage), "nothing is left"));
  }
}

TEST(CullRules, EnoughEndsTheRunAfterAView) {
  const Drawing drawing = lab::on_worst(obb_fattener());
  const Scene scene = lab::scene_of(lab::random_small(5, 40));
  CullSettings settings = lab::cull_settings(drawing, "x,y,z", 12);
  const CullResult all = lab::run_by(kQuickRule, scene, drawing, settings).result;
  EXPECT_EQ(stage_named(all, "further views"), nullptr);
  settings.enough = 1000;
  const CullResult one = lab::run_by(kQuickRule, scene, drawing, settings).result;
  const Stage* stage = stage_named(one, "further views");
  ASSERT_NE(stage, nullptr);
  EXPECT_FALSE(stage->ran);
  EXPECT_EQ(reason_of(*stage), counted(one.live.size(), "triangle is left", "triangles are left") +
                                   ", at most 1,000 are enough");
  EXPECT_EQ(stage_named(one, " y, round 1"), nullptr);
  EXPECT_TRUE(std::ranges::includes(one.live, all.live));
}

}  // namespace
}  // namespace farcull
