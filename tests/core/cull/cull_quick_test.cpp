// Quick-CULLIDE against plain CULLIDE, step by step on their common schedule; the level of
// clusters, runs in sequence and what may be left out, which must not change what is kept.
#include "core/base/text.h"
#include "core/cull/clusters.h"
#include "experiments/record/stage_words.h"
#include "tests/lab/cull.h"

namespace farcull {
namespace {

using lab::Drawing;
using lab::first_step_behind;
using lab::StepRecord;
using lab::Trace;

bool subset(const std::vector<std::uint32_t>& a, const std::vector<std::uint32_t>& b) {
  return std::includes(b.begin(), b.end(), a.begin(), a.end());
}

struct Case {
  Scene scene;
  CullSettings settings;
};

Case random_case(const Drawing& drawing) {
  const auto triangles = *lab::small_triangles();
  const auto views =
      *rc::gen::elementOf(std::vector<std::string>{"z", "x,y,z", "1:2:3,-x", "z,-z"});
  const auto resolution = *rc::gen::elementOf(std::vector<int>{4, 12, 32});
  return {lab::scene_of(triangles), lab::cull_settings(drawing, views, resolution)};
}

std::vector<Drawing> drawings() {
  return {lab::raw_on_ideal(), lab::on_worst(obb_fattener()), lab::on_worst(minkowski_fattener())};
}

TEST(CullQuick, IsAheadOfPlainAfterEveryStep) {
  for (const Drawing& drawing : drawings()) {
    SCOPED_TRACE(drawing.fattener.name);
    std::uint64_t kept_less = 0, draws_less = 0, queries_less = 0;
    const bool raw = drawing.fattener.name == "raw";
    const auto check = [&] {
      const Case c = random_case(drawing);
      for (const bool touching : {true, false}) {
        CullSettings settings = c.settings;
        settings.touching = touching;
        if (*rc::gen::arbitrary<bool>()) settings.clusters.sizes = {4, 2};
        const Trace quick = lab::run_by(kQuickRule, c.scene, drawing, settings);
        const Trace plain = lab::run_by(kPlainRule, c.scene, drawing, settings);
        RC_ASSERT(first_step_behind(quick, plain) == "");
        RC_ASSERT(subset(quick.result.live, plain.result.live));
        kept_less += plain.result.live.size() - quick.result.live.size();
        if (plain.steps.empty() || quick.steps.empty()) continue;
        const StepRecord& then = quick.steps[std::min(plain.steps.size(), quick.steps.size()) - 1];
        draws_less += plain.draws() - then.draws;
        queries_less += plain.queries() - then.queries;
      }
    };
    lab::expect_property(801, raw ? 100 : 20, check, [&] {
      return (kept_less > 0 || !raw) && draws_less > 100 && queries_less > 100;
    });
  }
}

// The property has teeth: a rule that forgets as plain CULLIDE does but asks nothing of FFV falls
// behind, and one that stores what is cleared is not ahead in draws where plain leaves it out.
TEST(CullQuick, BrokenRulesFallBehindPlain) {
  const Drawing drawing = lab::raw_on_ideal();
  PassRule asks_once = kQuickRule;  // FFV is asked in the first pass, where it has nothing to gain
  asks_once.asks[0][kF] = true;
  asks_once.asks[1][kF] = false;
  PassRule twice = kPlainRule;  // more than plain CULLIDE asks is no subset of it
  PassRule thrifty = kPlainRule;
  thrifty.asks[1][0] = false;
  int behind = 0, ahead = 0;
  for (int n = 0; more_cases(n, 0, behind > 0 && ahead > 0, 200); ++n) {
    const Scene scene = lab::scene_of(lab::random_small(900 + n, 40));
    CullSettings settings = lab::cull_settings(drawing, "x,y,z", 24);
    const Trace plain = lab::run_by(kPlainRule, scene, drawing, settings);
    behind += first_step_behind(lab::run_by(asks_once, scene, drawing, settings), plain) != "";
    ahead += first_step_behind(lab::run_by(twice, scene, drawing, settings),
                               lab::run_by(thrifty, scene, drawing, settings)) != "";
  }
}

// Beside the scene, seen apart from it in every view along an axis: ten objects of the same
// triangles, which collide for good and cost every visit the same.
Scene with_crowd(Scene scene) {
  for (int o = 0; o < 10; ++o) {
    scene.objects.push_back(
        {"crowd", static_cast<std::uint32_t>(scene.triangles.size()), 100, false});
    for (int i = 0; i < 100; ++i) {
      const Vec3 at(3 + 0.1 * (i % 10), 3 + 0.1 * (i / 10), 3 + 0.1 * (i % 10));
      add_triangle(scene, {at, at + Vec3(0.2, 0, 0.1), at + Vec3(0, 0.2, 0.1)});
    }
  }
  return scene;
}

// Quick-CULLIDE goes on where plain CULLIDE has come to rest: bits of different views join, and
// free one triangle after another. It then culls more, and in a crowd that stays, its total exceeds
// plain CULLIDE's.
TEST(CullQuick, MayExceedPlainsTotalByGoingOn) {
  const Drawing drawing = lab::raw_on_ideal();
  int exceeds = 0;
  for (int n = 0; more_cases(n, 20, exceeds > 0, 500); ++n) {
    const Scene scene = with_crowd(lab::scene_of(lab::random_small(1000 + n, 100)));
    const CullSettings settings = lab::cull_settings(drawing, "x,y,z", 58);
    const Trace quick = lab::run_by(kQuickRule, scene, drawing, settings);
    const Trace plain = lab::run_by(kPlainRule, scene, drawing, settings);
    EXPECT_EQ(first_step_behind(quick, plain), "") << n;
    if (quick.draws() <= plain.draws() && quick.queries() <= plain.queries()) continue;
    ++exceeds;
    EXPECT_LT(quick.result.live.size(), plain.result.live.size()) << n;
  }
}

// draws_saved and queries_saved count against plain CULLIDE's pass on the same live triangles:
// while both have the same, used and saved together are what plain CULLIDE used.
TEST(CullQuick, SavedAndUsedTogetherArePlainsCost) {
  for (const Drawing& drawing : drawings()) {
    std::uint64_t saved = 0;
    int compared = 0;
    for (int n = 0; more_cases(n, trials(60), compared > 20 && saved > 50); ++n) {
      const Scene scene = lab::scene_of(lab::random_small(1400 + n, 30));
      const CullSettings settings = lab::cull_settings(drawing, "x,y,z", 12);
      const Trace quick = lab::run_by(kQuickRule, scene, drawing, settings);
      const Trace plain = lab::run_by(kPlainRule, scene, drawing, settings);
      for (std::size_t i = 0; i < std::min(quick.steps.size(), plain.steps.size()); ++i) {
        const StepRecord& q = quick.steps[i];
        ASSERT_EQ(q.draws + q.draws_saved, plain.steps[i].draws) << n << ", " << q.name;
        ASSERT_EQ(q.queries + q.queries_saved, plain.steps[i].queries) << n << ", " << q.name;
        ++compared;
        const auto culled = [](const StepRecord& s) { return std::ranges::count(s.bits, kCulled); };
        if (culled(q) != culled(plain.steps[i])) break;
      }
      std::uint64_t draws_saved = 0, queries_saved = 0;
      for (const Stage& stage : quick.result.stages) {
        draws_saved += stage.draws_saved;
        queries_saved += stage.queries_saved;
      }
      for (const Stage& stage : plain.result.stages) ASSERT_EQ(stage.draws_saved, 0u);
      if (quick.steps.empty()) continue;
      ASSERT_EQ(draws_saved, quick.steps.back().draws_saved);
      ASSERT_EQ(queries_saved, quick.steps.back().queries_saved);
      saved += draws_saved;
    }
  }
}

// ---- clusters ----

TEST(CullClusters, ChangeNoFixedPoint) {
  for (const Drawing& drawing : drawings()) {
    const bool raw = drawing.fattener.name == "raw";
    for (int n = 0; n < trials(raw ? 40 : 8); ++n) {
      const Scene scene = lab::scene_of(lab::random_small(1600 + n, 50));
      CullSettings settings = lab::cull_settings(drawing, "x,y,z", raw ? 24 : 12);
      for (const PassRule& rule : {kQuickRule, kPlainRule}) {
        settings.clusters = {};
        const CullResult without = lab::run_by(rule, scene, drawing, settings).result;
        for (const std::vector<std::uint32_t>& sizes :
             {std::vector<std::uint32_t>{2}, std::vector<std::uint32_t>{8, 3}}) {
          settings.clusters.sizes = sizes;
          const CullResult with = lab::run_by(rule, scene, drawing, settings).result;
          ASSERT_EQ(with.live, without.live) << n;
          ASSERT_EQ(with.bits, without.bits) << n;
        }
      }
    }
  }
}

// Draws only the first element of every slot.
class FirstOfSlot : public IdealCanvas {
 public:
  using IdealCanvas::IdealCanvas;
  std::vector<std::uint8_t> run(const Pass& pass) override {
    Pass cut = pass;
    for (const Step& step : cut.steps) {
      if (step.verb == Verb::store) continue;
      std::size_t kept = step.first;
      for (std::uint32_t d = step.first; d < step.first + step.count; ++d)
        if (d > step.first && cut.draws[d].slot == pass.draws[d - 1].slot)
          cut.draws[d] = cut.draws[kept];
        else
          kept = d;
    }
    return IdealCanvas::run(cut);
  }
};

TEST(CullClusters, AClusterJudgedByOneOfItsTrianglesLosesOthers) {
  const Fattener raw = raw_triangles();
  const Drawing broken = {raw, std::make_shared<FirstOfSlot>(raw.solid)};
  int lost = 0;
  for (int n = 0; more_cases(n, 0, lost > 0, 200); ++n) {
    const Scene scene = lab::scene_of(lab::random_small(1600 + n, 50));
    CullSettings settings = lab::cull_settings(broken, "x,y,z", 24);
    settings.clusters.sizes = {8};
    lost += lab::wrongly_cleared(lab::run_by(kQuickRule, scene, broken, settings),
                                 lab::conflicts(scene, lab::raw_on_ideal(), settings));
  }
}

TEST(CullClusters, CutEachOwnerAlongTheCurve) {
  const Scene scene = lab::scene_of(lab::random_small(77, 200));
  const Regions plan = find_regions(scene);
  const std::vector<std::uint32_t> owner = owners(scene);
  const std::vector<std::uint32_t> order =
      spatial_order(plan.triangles, owner, plan.triangle_boxes);
  std::vector<std::uint32_t> sorted = order;
  std::ranges::sort(sorted);
  EXPECT_EQ(sorted, plan.triangles);
  const std::vector<std::uint32_t> number = cluster_numbers(order, owner, 4);
  std::uint32_t filled = 1;
  for (std::size_t i = 1; i < order.size(); ++i) {
    ASSERT_LE(owner[order[i - 1]], owner[order[i]]);
    const bool next = number[order[i]] != number[order[i - 1]];
    ASSERT_EQ(next, owner[order[i]] != owner[order[i - 1]] || filled == 4);
    filled = next ? 1 : filled + 1;
  }
}

TEST(CullClusters, AreUsualWhereAQuestionCostsAndManyTrianglesAreAsked) {
  EXPECT_TRUE(usual_clusters(false, 1'000'000).sizes.empty());
  EXPECT_TRUE(usual_clusters(true, 1'000).sizes.empty());
  const Clusters clusters = usual_clusters(true, 1'000'000);
  EXPECT_FALSE(clusters.sizes.empty());
  EXPECT_EQ(clusters.reason, Reason::clusters_large);
}

TEST(CullClusters, OrderSurvivesTheLargestBoxes) {
  const double most = std::numeric_limits<double>::max();
  const std::vector<Box> boxes = {{Vec3(-most, -most, -most), Vec3(most, most, most)},
                                  {Vec3(most, most, most), Vec3(most, most, most)},
                                  {Vec3(0, 0, 0), Vec3(0, 0, 0)}};
  const std::vector<std::uint32_t> all = {0, 1, 2}, owner = {0, 0, 0};
  EXPECT_EQ(spatial_order(all, owner, boxes).size(), 3u);
  EXPECT_EQ(spatial_order(all, owner, boxes).back(), 1u);
}

// ---- runs in sequence ----

TEST(CullSequence, ExactOffsetsAfterBoxesKeepNoMoreThanAlone) {
  const Drawing obb = lab::on_worst(obb_fattener()), exact = lab::on_worst(minkowski_fattener());
  std::size_t fewer = 0, after_boxes = 0;
  for (int n = 0; more_cases(n, trials(40), after_boxes > 0); ++n) {  // culled of what boxes leave
    const Scene scene = lab::scene_of(lab::random_small(8000 + n, 20));
    const lab::Pairs pairs = lab::collisions(scene);
    CullSettings settings = lab::cull_settings(exact, "x,y,z", 12);
    const Trace alone = lab::run_by(kQuickRule, scene, exact, settings);
    settings.fattener = obb.fattener;
    const Trace boxes = lab::run_by(kQuickRule, scene, obb, settings);
    settings.fattener = exact.fattener;
    settings.bits = boxes.result.bits;
    const Trace after = lab::run_by(kQuickRule, scene, exact, settings);
    ASSERT_TRUE(subset(after.result.live, alone.result.live)) << n;
    ASSERT_TRUE(subset(after.result.live, boxes.result.live)) << n;
    ASSERT_EQ(lab::wrongly_cleared(after, pairs), 0) << n;
    fewer += alone.result.live.size() - after.result.live.size();
    after_boxes += boxes.result.live.size() - after.result.live.size();
  }
  std::printf("%zu culled after boxes, %zu fewer kept than by exact offsets alone\n", after_boxes,
              fewer);
}

TEST(CullSequence, BitsThatAreNoFactsLosePairs) {
  const Drawing exact = lab::on_worst(minkowski_fattener());
  std::size_t lost = 0;
  for (int n = 0; more_cases(n, 0, lost > 0, 100); ++n) {
    const Scene scene = lab::scene_of(lab::random_small(8000 + n, 20));
    CullSettings settings = lab::cull_settings(exact, "x,y,z", 12);
    settings.bits = lab::run_by(kQuickRule, scene, exact, settings).result.bits;
    for (std::uint8_t& bits : settings.bits)
      if (bits == 0) bits = kF;
    const Trace wrong = lab::run_by(kQuickRule, scene, exact, settings);
    for (const auto& [u, t] : lab::collisions(scene)) {
      const auto& live = wrong.result.live;
      lost += !std::ranges::binary_search(live, u) || !std::ranges::binary_search(live, t);
    }
  }
  EXPECT_GT(lost, 0u);
}

TEST(CullSequence, RefusesBitsOfAnotherScene) {
  const Drawing exact = lab::on_worst(minkowski_fattener());
  CullSettings settings = lab::cull_settings(exact, "x", 12);
  settings.bits = {0};
  EXPECT_THROW(lab::run_by(kQuickRule, lab::random_scene(1), exact, settings), std::logic_error);
}

// ---- what is left out ----

TEST(CullLeftOut, FullRunsEverythingAndKeepsTheSame) {
  std::size_t left_out = 0;
  for (const Drawing& drawing : drawings()) {
    for (int n = 0; n < 20; ++n) {
      const Scene scene = lab::scene_of(lab::random_small(1800 + n, 2 + n));
      CullSettings settings = lab::cull_settings(drawing, "x,y,z", 12);
      settings.clusters = {.sizes = {4}, .reason = Reason::clusters_given};
      const CullResult lean = lab::run_by(kQuickRule, scene, drawing, settings).result;
      settings.full = true;
      settings.enough = 1000;
      const CullResult full = lab::run_by(kQuickRule, scene, drawing, settings).result;
      ASSERT_EQ(full.live, lean.live);
      ASSERT_EQ(full.bits, lean.bits);
      for (const Stage& stage : full.stages) ASSERT_TRUE(stage.ran) << name_of(stage);
      for (const Stage& stage : lean.stages) {
        left_out += !stage.ran;
        ASSERT_FALSE(reason_of(stage).empty()) << name_of(stage);
      }
    }
  }
  EXPECT_GT(left_out, 100u);
}

const Stage* stage_named(const CullResult& result, const std::string& part) {
  for (const Stage& stage : result.stages)
    if (name_of(stage).find(part) != std::string::npos) return &stage;
  return nullptr;
}

TEST(CullLeftOut, NoLevelForAnEmptySet) {
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

TEST(CullLeftOut, EnoughEndsTheRunAfterAView) {
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
  EXPECT_TRUE(subset(all.live, one.live));
}

}  // namespace
}  // namespace farcull
