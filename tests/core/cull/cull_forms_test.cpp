// Forms of CULLIDE: a limit of rounds, views that all have to clear, objects alone. Each against
// what single views and single rounds give by themselves.
#include "core/boxes/join.h"
#include "experiments/record/stage_words.h"
#include "tests/lab/cull.h"
#include "verify/accounting.h"

namespace farcull {
namespace {

using namespace lab;
using Indices = std::vector<std::uint32_t>;

constexpr int kPixels = 24;
constexpr std::uint64_t kScenes = 40;

Scene scene_at(std::uint64_t seed) { return scene_of(random_small(seed, 50)); }

Indices live(const Scene& scene, const Drawing& drawing, const CullSettings& settings) {
  return cull(scene, find_regions(scene), settings, *drawing.canvas).live;
}

bool subset(const Indices& a, const Indices& b) {
  return std::includes(b.begin(), b.end(), a.begin(), a.end());
}

// What at least one of the views keeps when it is drawn alone, for one round.
Indices kept_by_some_view(const Scene& scene, const Drawing& drawing, CullSettings settings) {
  Indices out;
  for (const View& view : parse_views("x,y,z")) {
    CullSettings alone = settings;
    alone.views = {view};
    alone.rounds = 1;
    alone.clear = ClearRule::any;
    const Indices kept = live(scene, drawing, alone);
    Indices both;
    std::set_union(out.begin(), out.end(), kept.begin(), kept.end(), std::back_inserter(both));
    out = std::move(both);
  }
  return out;
}

TEST(CullForms, AllViewsCullWhatEachViewCullsAlone) {
  const Drawing drawing = raw_on_ideal();
  int any_differs = 0, culled = 0;
  for (std::uint64_t seed = 1; seed <= kScenes; ++seed) {
    const Scene scene = scene_at(seed);
    for (const bool quick : {false, true}) {
      CullSettings settings = cull_settings(drawing, "x,y,z", kPixels);
      settings.quick = quick;
      settings.rounds = 1;
      settings.clear = ClearRule::all;
      const Indices expected = kept_by_some_view(scene, drawing, settings);
      EXPECT_EQ(live(scene, drawing, settings), expected) << "seed " << seed << " quick " << quick;
      culled += expected.size() < find_regions(scene).triangles.size();
      settings.clear = ClearRule::any;
      any_differs += live(scene, drawing, settings) != expected;
    }
  }
  EXPECT_GT(culled, 0);
  EXPECT_GT(any_differs, 0) << "the twin: any view would have given the same";
}

// A view that cannot be drawn clears nothing: sums of such coordinates are beyond all doubles.
TEST(CullForms, AllViewsCullNothingWhereOneCannotBeDrawn) {
  const Drawing drawing = raw_on_ideal();
  Scene scene = scene_at(3);
  for (Vec3& v : scene.vertices) v *= 0.4 * DBL_MAX;
  const Regions regions = find_regions(scene);
  const auto run = [&](const std::string& views, ClearRule clear) {
    CullSettings settings = cull_settings(drawing, views, kPixels);
    settings.clear = clear;
    return cull(scene, regions, settings, *drawing.canvas);
  };
  const CullResult all = run("x,1:1:1,z", ClearRule::all);
  ASSERT_TRUE(all.views[0].drawn && !all.views[1].drawn && all.views[2].drawn);
  EXPECT_EQ(all.live, regions.triangles);
  // The twins: without that view, and where any may clear, something is culled.
  EXPECT_LT(run("x,z", ClearRule::all).live.size(), regions.triangles.size());
  EXPECT_LT(run("x,1:1:1,z", ClearRule::any).live.size(), regions.triangles.size());
}

TEST(CullForms, RoundsEndWhereTheyAreLimited) {
  const Drawing drawing = raw_on_ideal();
  int further = 0;
  for (std::uint64_t seed = 1; seed <= kScenes; ++seed) {
    const Scene scene = scene_at(seed);
    CullSettings settings = cull_settings(drawing, "x,y,z", kPixels);
    settings.quick = seed % 2 == 0;
    const Indices end = live(scene, drawing, settings);
    Indices before = find_regions(scene).triangles;
    for (int rounds = 1; rounds <= 3; ++rounds) {
      settings.rounds = rounds;
      const CullResult run = cull(scene, find_regions(scene), settings, *drawing.canvas);
      EXPECT_TRUE(subset(run.live, before)) << seed;
      EXPECT_TRUE(subset(end, run.live)) << seed;
      int last = 0;
      for (const Stage& stage : run.stages) last = std::max(last, stage.round);
      EXPECT_LE(last, rounds) << seed;
      const auto limit = std::ranges::find_if(
          run.stages, [](const Stage& s) { return s.reason == Reason::rounds_given; });
      if (rounds == 1) {
        EXPECT_NE(limit, run.stages.end());
      }
      further += rounds == 1 && run.live != end;
      before = run.live;
    }
  }
  EXPECT_GT(further, 0) << "the twin: one round would always have been enough";
}

TEST(CullForms, ObjectsAloneStayWhole) {
  const Drawing drawing = raw_on_ideal();
  int cut = 0, culled = 0;
  for (std::uint64_t seed = 1; seed <= kScenes; ++seed) {
    const Scene scene = scene_at(seed);
    const Indices all = find_regions(scene).triangles;
    const auto halves = [&](const Indices& kept) {
      int count = 0;
      for (const Object& object : scene.objects) {
        const auto of = [&](const Indices& list) {
          const auto from = std::ranges::lower_bound(list, object.first_triangle);
          const auto to =
              std::lower_bound(from, list.end(), object.first_triangle + object.triangle_count);
          return to - from;
        };
        count += of(kept) != 0 && of(kept) != of(all);
      }
      return count;
    };
    CullSettings settings = cull_settings(drawing, "x,y,z", kPixels);
    settings.quick = seed % 2 == 0;
    cut += halves(live(scene, drawing, settings));
    settings.objects_alone = true;
    const Indices kept = live(scene, drawing, settings);
    EXPECT_EQ(halves(kept), 0) << "seed " << seed;
    culled += kept.size() < all.size();
  }
  EXPECT_GT(cut, 0) << "the twin: triangles are culled out of objects";
  EXPECT_GT(culled, 0);
}

TEST(CullForms, ObjectsAloneNeedObjectsThatOwn) {
  const Drawing drawing = raw_on_ideal();
  const Scene scene = scene_of(random_small(1, 10), true);
  CullSettings settings = cull_settings(drawing, "x", kPixels);
  settings.self = settings.objects_alone = true;
  EXPECT_THROW(cull(scene, find_regions(scene, {.self = true}), settings, *drawing.canvas),
               std::logic_error);
}

// With offsets that promise, every form keeps the promise; raw triangles do not, on the same
// canvas.
TEST(CullForms, FarMissesNothingInAnyForm) {
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

// A plan says what a run does, in every form.
TEST(CullForms, PlansNameTheStagesOfTheFirstRound) {
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

}  // namespace
}  // namespace farcull
