// Runs of the methods that draw follow their plans, on every built-in scene.
#include "tests/lab/plan.h"

namespace farcull {
namespace {

constexpr struct {
  bool self, full;
} kQuestions[] = {{false, false}, {false, true}, {true, false}, {true, true}};

TEST(GlPlan, RunsFollowIt) {
  Session session("software");
  // Rules that depend on more triangles are tested on the CPU (planner_test.cpp).
  for (const std::string& name : lab::scene_names(false, 3000)) {
    Scene scene = make_builtin_scene(name);
    for (const Method method : all_methods()) {
      if (!draws(method)) continue;
      // S-CULLIDE asks triangle by triangle.
      if (tests_self_alone(method) && scene.triangles.size() > 2000) continue;
      for (const auto& [self, full] : kQuestions) {
        if (full && scene.triangles.size() > static_cast<std::size_t>(trials(3000))) continue;
        if (self ? !tests_self(method) : tests_self_alone(method)) continue;
        for (Object& object : scene.objects) object.self = self;
        RunOptions options;
        options.method = method;
        options.device = "software";
        options.resolution = 64;
        options.full = full;
        options.verify = false;
        if (fattens(method)) options.offset = "exact";
        EXPECT_EQ(lab::not_followed(run(scene, options, session)), "")
            << name << " " << to_string(method) << " full " << full << " self " << self;
      }
    }
  }
}

}  // namespace
}  // namespace farcull
