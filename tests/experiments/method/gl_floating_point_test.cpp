// What draws, in every floating-point environment that a caller may have; and drivers that change
// it.
#include "experiments/method/run.h"
#include "tests/lab/floating_point.h"

// As epoxy declares it: an entry point that can be replaced.
extern "C" void (*epoxy_glDrawArrays)(unsigned, int, int);

namespace farcull {
namespace {

using lab::Disturbed, lab::Environment, lab::environments;

TEST(GlFloatingPoint, EveryMethodThatPromises) {
  RunOptions far{.method = Method::far};
  far.resolution = 64;
  std::vector<RunOptions> ways(3, far);
  ways[1].query = QueryMode::occlusion;
  ways[2].offset = "exact";
  for (const Environment& environment : environments()) {
    std::vector<Record> records;
    FloatingPoint after;
    {
      const Disturbed disturbed(environment);
      Session session("software");  // its context is opened in this environment
      for (const Scene& scene : {lab::tiny_scene(4), lab::huge_scene(4), lab::subnormal_scene(4)})
        for (const RunOptions& options : ways) records.push_back(run(scene, options, session));
      after = floating_point();
    }
    EXPECT_EQ(after, environment.found) << environment.name;
    for (std::size_t i = 0; i < records.size(); ++i) {
      const Record& record = records[i];
      SCOPED_TRACE(environment.name + ", run " + std::to_string(i));
      EXPECT_EQ(record.collisions.pairs.size(), i < 2 * ways.size() ? 16u : 0u);
      EXPECT_EQ(record.verification->false_negatives, 0u);
      EXPECT_TRUE(record.found.device.gl);
      EXPECT_EQ(record.used, kProved);
    }
  }
}

TEST(GlFloatingPoint, AnEnvironmentThatADriverLeavesIsSeenAtTheEndOfItsStage) {
  const GlContext context("software");
  const GlCurrent current(context);
  EXPECT_NO_THROW(check_gl("clean"));
  for (const Environment& environment : environments()) {
    std::string where;
    {
      const Disturbed disturbed(environment);
      try {
        check_gl("disturbed");
      } catch (const Error& error) {
        where = error.where;
      }
    }
    EXPECT_EQ(where, "GL disturbed") << environment.name;
  }
}

void (*draw)(unsigned, int, int) = nullptr;
void draw_and_round_upward(unsigned mode, int first, int count) {
  draw(mode, first, count);
  std::fesetround(FE_UPWARD);
}

// No answer is given that was computed in such an environment; the caller's is as before.
TEST(GlFloatingPoint, ADriverThatChangesItDuringARunEndsTheRun) {
  const Scene scene = lab::tiny_scene(8);
  RunOptions far{.method = Method::far};
  far.resolution = 64;
  Session session("software");
  const auto pairs = [&] { return run(scene, far, session).collisions.pairs.size(); };
  EXPECT_EQ(pairs(), 64u);

  draw = epoxy_glDrawArrays;
  epoxy_glDrawArrays = draw_and_round_upward;
  std::string what = "no error";
  try {
    pairs();
  } catch (const Error& error) {
    what = error.what();
  }
  epoxy_glDrawArrays = draw;
  EXPECT_TRUE(has_text(what, "this thread rounds upward"));
  EXPECT_EQ(floating_point(), kProved);
  EXPECT_EQ(pairs(), 64u);
}

}  // namespace
}  // namespace farcull
