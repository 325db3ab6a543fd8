// The Voronoi diagram on GL with one call to GL lost or one allocation failed at a time, with wrong
// depth tests, and with a wrong square root: the answer is right, or there is an error.
#include "core/base/error.h"
#include "core/gl/base/driver_fault.h"
#include "core/gl/voronoi/voronoi.h"
#include "tests/faults/gl_calls.h"
#include "tests/lab/gl.h"
#include "tests/lab/voronoi.h"

namespace farcull {
namespace {

using lab::expect_no_wrong_answer;
using lab::GlFault;
using lab::OtherShaderText;

// Triangles in one plane, so that the grid has one slice and an answer few calls.
Scene flat_scene() {
  Scene scene = lab::neighbours_scene(5, 0);
  for (Vec3& v : scene.vertices) v[2] = 0;
  return scene;
}

class VoronoiFaults : public testing::Test {
 protected:
  std::unique_ptr<GlContext> context;
  const Scene scene = flat_scene();
  const VoronoiOptions options{.resolution = 6};
  const std::unique_ptr<VoronoiDevice> cpu = cpu_voronoi_device(1);
  const std::vector<ObjectPair> named = voronoi_neighbours(scene, options, *cpu).objects;
  const std::vector<TrianglePair> kept = reliable_neighbours(scene, options, *cpu).triangles;
  std::unique_ptr<VoronoiDevice> device;

  void open() {
    device.reset();
    if (!context) context = std::make_unique<GlContext>();
    device = gl_voronoi_device(*context);
  }
  // A device that failed is made anew for the next answer, and its context too.
  template <class Answer>
  bool answered(const Answer& answer) {
    try {
      if (!device) open();
      return answer();
    } catch (...) {
      device.reset();
      context.reset();
      throw;
    }
  }
  bool published() {
    return answered([&] { return voronoi_neighbours(scene, options, *device).objects == named; });
  }
  bool reliable() {
    return answered([&] { return reliable_neighbours(scene, options, *device).triangles == kept; });
  }
};

TEST_F(VoronoiFaults, TheUndisturbedAnswersAreThoseOfTheCpu) {
  EXPECT_GT(named.size(), 1u);
  EXPECT_GT(kept.size(), 1u);
  EXPECT_TRUE(published());
  EXPECT_TRUE(reliable());
}

TEST_F(VoronoiFaults, EveryLostCallOfTheFirstAnswerIsNoticed) {
  const auto outcomes = lab::try_gl_faults(
      GlFault::drop, [&] { device.reset(); }, [&] { return published(); });
  EXPECT_GT(outcomes.size(), 100u);
  expect_no_wrong_answer("lost calls, published, first answer", outcomes);
}

TEST_F(VoronoiFaults, EveryLostCallOfTheReliableFormIsNoticed) {
  const auto outcomes = lab::try_gl_faults(
      GlFault::drop, [&] { ASSERT_TRUE(published()); }, [&] { return reliable(); });
  EXPECT_GT(outcomes.size(), 100u);
  expect_no_wrong_answer("lost calls, reliable", outcomes);
}

TEST_F(VoronoiFaults, EveryFailedAllocationIsNoticed) {
  const auto outcomes = lab::try_gl_faults(
      GlFault::out_of_memory, [&] { device.reset(); }, [&] { return reliable(); });
  EXPECT_GT(outcomes.size(), 5u);
  for (const lab::GlFaultOutcome& o : outcomes) EXPECT_TRUE(o.threw) << o.at;
  expect_no_wrong_answer("failed allocations", outcomes);
}

// ---- devices that compute otherwise ----

using DepthFunc = GlEntryPoint<&epoxy_glDepthFunc>;
GLenum other_function = GL_LESS;
void other_depth_func(GLenum) { DepthFunc::original(other_function); }

// What is said with another depth test; empty where there is an answer.
class VoronoiFaultsDepth : public VoronoiFaults {
 protected:
  std::string said(GLenum function, bool of_reliable) {
    const DepthFunc other(&other_depth_func);
    other_function = function;
    try {
      right = of_reliable ? reliable() : published();
      return "";
    } catch (const Error& error) {
      return error.reason;
    }
  }
  bool right = true;
};

TEST_F(VoronoiFaultsDepth, AnotherTestIsRefused) {
  for (const bool of_reliable : {false, true}) {
    EXPECT_EQ(said(GL_LESS, of_reliable), "");
    EXPECT_TRUE(right);
    EXPECT_NE(said(GL_GREATER, of_reliable), "");
    EXPECT_NE(said(GL_NEVER, of_reliable), "");
    EXPECT_EQ(said(GL_ALWAYS, of_reliable), "the depth test kept a distance that is not the least");
  }
}

// The twin: without the comparison of the last pass the wrong answer is given.
TEST_F(VoronoiFaultsDepth, WithoutTheComparisonAnotherTestGivesAWrongAnswer) {
  const OtherShaderText text{{"flags |= kWrong;", ";"}};
  open();
  EXPECT_EQ(text.replaced(), 3);
  EXPECT_EQ(said(GL_ALWAYS, false), "");
  EXPECT_FALSE(right);
}

TEST_F(VoronoiFaultsDepth, AWorseRootIsRefused) {
  const OtherShaderText text{
      {"float length = sqrt(square);", "float length = sqrt(square) * 1.00001;"}};
  open();
  EXPECT_EQ(text.replaced(), 1);
  EXPECT_EQ(said(GL_LESS, false), "a square root is too inexact");
  open();
  EXPECT_EQ(said(GL_LESS, true), "a square root is too inexact");
}

// A distance that a device computes wrongly without any of this being broken is for the probes to
// find (assumption A4): here every distance is that of another point.
TEST_F(VoronoiFaultsDepth, AnotherCentreGivesAnotherAnswer) {
  const OtherShaderText text{{"float(pixel.x) + 0.5", "float(pixel.x) + 3.5"}};
  open();
  EXPECT_EQ(text.replaced(), 1);
  EXPECT_EQ(said(GL_LESS, true), "");
  EXPECT_FALSE(right);
}

}  // namespace
}  // namespace farcull
