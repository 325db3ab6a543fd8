// Threads of a software device are named, and no promise rests on them. Each test runs twice: as
// all others, without such threads, and with LP_NUM_THREADS=2, where it is its own twin.
#include "experiments/record/output.h"
#include "experiments/record/tables.h"
#include "experiments/scenes/builtin/scenes.h"
#include "tests/lab/test.h"
#include "tests/lab/unwrapped.h"

namespace farcull {
namespace {

class GlThreads : public testing::Test {
 protected:
  void SetUp() override {
    if (context.info().renderer.find("llvmpipe") == std::string::npos)
      GTEST_SKIP() << "the software device is " << context.info().renderer;
    // The other probes pass in tests of their own.
    keep_verdict(context.info(), run_probes(context, {.only = "A10"}), 0);
  }

  static RunOptions options(Method method) {
    RunOptions out{.method = method, .verify = false};
    out.device = "software";
    out.resolution = method == Method::far ? 64 : 0;
    return out;
  }

  // Opened before the folder is another one: Mesa keeps its shaders below it.
  static const GlContext& opened() {
    static const GlContext context("software");
    return context;
  }

  const GlContext& context = opened();
  const CacheFolder folder;                                    // for the verdicts
  const int asked = std::atoi(std::getenv("LP_NUM_THREADS"));  // tests/environment.cpp
  const std::string words =
      asked == 1 ? "draws in 1 thread " : "draws in " + std::to_string(asked) + " threads ";
};

TEST_F(GlThreads, AreCounted) {
  EXPECT_EQ(driver_threads(context.info().renderer), asked);
  EXPECT_EQ(driver_threads("softpipe"), 0);
  EXPECT_EQ(risk_of_threads(context.info().renderer).empty(), asked == 0);
  bool among_the_inputs = false;
  for (const auto& [name, value] : verdict_inputs(context.info()))
    among_the_inputs |= name == "threads" && value == std::to_string(asked);
  EXPECT_TRUE(among_the_inputs);
}

TEST_F(GlThreads, RunsNameThemAndPromiseNothing) {
  const Scene scene = make_builtin_scene("two-spheres");
  {
    Session session("software");
    const Record record = run(scene, options(Method::far), session);
    EXPECT_EQ(record.promise.holds, asked == 0) << record.promise.reason;
    EXPECT_EQ(record.promise.reason.find("A10 threads") == std::string::npos, asked == 0);
    EXPECT_EQ(to_json(scene, record)["device"]["threads"], asked);
    const std::string table = lab::unwrapped(run_table(scene, record));
    EXPECT_EQ(table.find(words) == std::string::npos, asked == 0) << table;
    const std::string line = certificate_of(scene, record).run.assumptions.back();
    EXPECT_TRUE(line.starts_with("A10") &&
                line.find(" in " + std::to_string(asked) + " thread") != std::string::npos)
        << line;
  }
}

}  // namespace
}  // namespace farcull
