// The pairs at which libraries erred, asked of our methods that draw, on software GL.
#include "tests/experiments/peers/library_examples.h"

namespace farcull {
namespace {

TEST(GlLibraryExamples, AreAnsweredRightlyByOurMethods) {
  for (const char* method : {"far", "far-pairs"}) expect_right_on_examples(method, "software");
}

}  // namespace
}  // namespace farcull
