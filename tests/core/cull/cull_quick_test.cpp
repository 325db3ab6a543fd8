// Quick-CULLIDE against plain CULLIDE, step by step on their common schedule: theorem 3 of
// docs/reliability.md, "Quick-CULLIDE". The level of clusters, and runs in sequence.
#include "core/base/text.h"
#include "experiments/record/stage_words.h"
#include "tests/lab/cull.h"

namespace farcull {
namespace {

using lab::Drawing, lab::first_step_behind, lab::StepRecord, lab::Trace;

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

TEST(CullQuick, IsAheadOfPlainAfterEveryStep) {
  for (const Drawing& drawing :
       {lab::raw_on_ideal(), lab::on_worst(obb_fattener()), lab::on_worst(minkowski_fattener())}) {
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
        RC_ASSERT(std::ranges::includes(plain.result.live, quick.result.live));
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

// ---- clusters ----

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

}  // namespace
}  // namespace farcull
