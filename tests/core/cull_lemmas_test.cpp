// The five lemmas of Quick-CULLIDE (docs/reliability.md, "Quick-CULLIDE"), each as a property: on
// raw triangles in the pixel-exact sense, on fattened ones against exact collisions. Each has a
// twin that breaks its rule and is caught.
#include <gtest/gtest.h>

#include "tests/core/cull_lab.h"

namespace farcull {
namespace {

using lab::Drawing;
using lab::Pairs;
using lab::Trace;

struct Question {
  const char* name;
  Drawing drawing;
  bool exact;  // against exact collisions; otherwise pixel-exact conflicts
};

std::vector<Question> questions() {
  return {{"raw", lab::raw_on_ideal(), false},
          {"boxes", lab::on_worst(obb_fattener()), true},
          {"exact offsets", lab::on_worst(exact_fattener()), true}};
}

// All passes run, whatever a rule makes due.
CullSettings settings_for(const Drawing& drawing, const std::string& views) {
  CullSettings settings =
      lab::cull_settings(drawing, views, drawing.fattener.name == "raw" ? 24 : 12);
  settings.full = true;
  return settings;
}

Pairs oracle(const Question& q, const Scene& scene, const CullSettings& settings) {
  return q.exact ? lab::collisions(scene) : lab::conflicts(scene, q.drawing, settings);
}

// How many of `pairs` are both in the set of `bit` (with BFV) at some step.
int both_in_set(const Trace& run, const Pairs& pairs, Bit bit) {
  int found = 0;
  for (const auto& [u, t] : pairs) {
    for (const lab::StepRecord& s : run.steps) {
      if ((s.bits[u] & bit) && (s.bits[t] & bit)) {
        ++found;
        break;
      }
    }
  }
  return found;
}

// A property over scenes and views, for each kind of primitive; `pairs` counts what it was about.
template <class Property>
void for_all(std::uint64_t seed, const Property& property) {
  for (const Question& q : questions()) {
    SCOPED_TRACE(q.name);
    std::size_t pairs = 0;
    lab::expect_property(seed, q.exact ? 20 : 60, [&] {
      const Scene scene = lab::scene_of(*lab::small_triangles());
      const auto views = *rc::gen::elementOf(std::vector<std::string>{"z", "x,y,z", "1:2:3,-x"});
      const CullSettings settings = settings_for(q.drawing, views);
      const Pairs wanted = oracle(q, scene, settings);
      pairs += wanted.size();
      property(q, scene, settings, wanted);
    });
    EXPECT_GT(pairs, 20u);
  }
}

// How many pairs a broken rule or canvas loses on thirty scenes.
int lost_by(const PassRule& rule, const Question& q, const Drawing& drawing) {
  int lost = 0;
  for (int n = 0; n < 30; ++n) {
    const Scene scene = lab::scene_of(lab::random_small(2000 + n, 50));
    const CullSettings settings = settings_for(drawing, "x,y,z");
    lost += lab::wrongly_cleared(lab::run_by(rule, scene, drawing, settings),
                                 oracle(q, scene, settings));
  }
  return lost;
}

TEST(CullLemma, L1FfvAndSfvAreCollisionFree) {
  for_all(811, [](const Question& q, const Scene& scene, const CullSettings& settings,
                  const Pairs& pairs) {
    const Trace run = lab::run_by(kQuickRule, scene, q.drawing, settings);
    RC_ASSERT(both_in_set(run, pairs, kF) == 0);
    RC_ASSERT(both_in_set(run, pairs, kL) == 0);
  });
}

TEST(CullLemma, L1FailsWithASwappedDepthTest) {
  for (const Fattener& fattener : {raw_triangles(), obb_fattener()}) {
    SCOPED_TRACE(fattener.name);
    const Drawing swapped = {fattener,
                             std::make_shared<IdealCanvas>(fattener.solid, CanvasFault::swapped)};
    const Drawing sound = {fattener, std::make_shared<IdealCanvas>(fattener.solid)};
    const Question q = {"", sound, fattener.name != "raw"};
    int found = 0;
    for (int n = 0; n < 30; ++n) {
      const Scene scene = lab::scene_of(lab::random_small(2000 + n, 50));
      const CullSettings settings = settings_for(swapped, "x,y,z");
      const Pairs pairs = oracle(q, scene, settings);
      const Trace run = lab::run_by(kQuickRule, scene, swapped, settings);
      found += both_in_set(run, pairs, kF) + both_in_set(run, pairs, kL);
      ASSERT_EQ(both_in_set(lab::run_by(kQuickRule, scene, sound, settings), pairs, kF), 0);
    }
    EXPECT_GT(found, 0);
  }
}

// L2 and L4: the question that is left out would clear nothing more. (At object level it clears
// less for a while: a triangle that has the bit may speak for its whole group.)
TEST(CullLemma, L2AndL4QuestionsLeftOutWouldClearNothing) {
  PassRule asks_ffv_twice = kQuickRule, asks_sfv_twice = kQuickRule;
  asks_ffv_twice.asks[0][kF] = true;
  asks_sfv_twice.asks[1][kL] = true;
  for_all(812,
          [&](const Question& q, const Scene& scene, const CullSettings& settings, const Pairs&) {
            const Trace quick = lab::run_by(kQuickRule, scene, q.drawing, settings);
            for (const PassRule& rule : {asks_ffv_twice, asks_sfv_twice}) {
              const Trace more = lab::run_by(rule, scene, q.drawing, settings);
              RC_ASSERT(more.result.bits == quick.result.bits);
              for (std::size_t i = 0; i < std::min(more.steps.size(), quick.steps.size()); ++i) {
                for (std::size_t t = 0; t < scene.triangles.size(); ++t)
                  RC_ASSERT((more.steps[i].bits[t] & ~quick.steps[i].bits[t]) == 0);
              }
            }
          });
}

TEST(CullLemma, L2AndL4TheOtherQuestionIsNeeded) {
  PassRule ffv = kQuickRule, sfv = kQuickRule;  // asked only in the pass that it has passed
  ffv.asks[1][kF] = false;
  ffv.asks[0][kF] = true;
  sfv.asks[0][kL] = false;
  sfv.asks[1][kL] = true;
  for (const Question& q : questions()) {
    for (const PassRule& rule : {ffv, sfv}) {
      std::size_t more = 0;
      for (int n = 0; n < 20; ++n) {
        const Scene scene = lab::scene_of(lab::random_small(2100 + n, 30));
        const CullSettings settings = settings_for(q.drawing, "x,y,z");
        more += lab::run_by(rule, scene, q.drawing, settings).result.live.size() -
                lab::run_by(kQuickRule, scene, q.drawing, settings).result.live.size();
      }
      EXPECT_GT(more, 0u) << q.name;
    }
  }
}

// The published statement: storing is needed for one side only. `first` and `second` say in which
// passes a set is stored; everything else is stored in both.
PassRule storing(Bit set, bool first, bool second) {
  PassRule rule = kQuickRule;
  for (int pass = 0; pass < 2; ++pass) {
    for (int bits = 0; bits < kCulled; ++bits) rule.stores[pass][bits] = true;
  }
  rule.stores[0][set] = first;
  rule.stores[1][set] = second;
  return rule;
}

TEST(CullLemma, L3AndL5SetsStoredInOnePassLoseNoPair) {
  for_all(813, [](const Question& q, const Scene& scene, const CullSettings& settings,
                  const Pairs& pairs) {
    for (const PassRule& rule : {storing(kF, true, false), storing(kL, false, true), kQuickRule}) {
      RC_ASSERT(lab::wrongly_cleared(lab::run_by(rule, scene, q.drawing, settings), pairs) == 0);
    }
  });
}

TEST(CullLemma, L3FfvStoredOnlyInTheSecondPassLosesPairs) {
  for (const Question& q : questions())
    EXPECT_GT(lost_by(storing(kF, false, true), q, q.drawing), 0) << q.name;
}

TEST(CullLemma, L5SfvStoredOnlyInTheFirstPassLosesPairs) {
  for (const Question& q : questions())
    EXPECT_GT(lost_by(storing(kL, true, false), q, q.drawing), 0) << q.name;
}

}  // namespace
}  // namespace farcull
