// A session of runs in which an allocation of a device fails: the runs after it are right.
#include <gtest/gtest.h>

#include "experiments/method/run.h"
#include "experiments/scenes/builtin/scenes.h"
#include "tests/faults/outcomes.h"

namespace farcull {
namespace {

using lab::GlFault;
using lab::GlFaultOutcome;

TEST(SessionFaults, ASessionGoesOnAfterAFailure) {
  const Scene scene = make_builtin_scene("two-spheres");
  for (const Method method : {Method::far, Method::far_pairs}) {
    RunOptions options;
    options.method = method;
    options.resolution = 32;
    options.verify = false;
    Session session("software");
    const auto right = run(scene, options, session).collisions.pairs;
    ASSERT_GT(right.size(), 0u);
    const auto outcomes = lab::try_gl_faults(
        GlFault::out_of_memory, [&] { session.forget_device(); },
        [&] { return run(scene, options, session).collisions.pairs == right; });
    EXPECT_GT(outcomes.size(), 4u);
    for (const GlFaultOutcome& o : outcomes) EXPECT_TRUE(o.threw) << o.at;
    lab::expect_no_wrong_answer("failed allocations of a session", outcomes);
  }
}

}  // namespace
}  // namespace farcull
