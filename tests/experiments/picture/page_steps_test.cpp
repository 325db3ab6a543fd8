// The steps that a reader of a page can choose among.
#include <gtest/gtest.h>

#include "experiments/picture/picture.h"

namespace farcull {
namespace {

RunOptions of(Method method, int resolution = 0) {
  RunOptions out;
  out.method = method;
  out.resolution = resolution;
  return out;
}

std::vector<std::string> titles(const std::vector<RunOptions>& steps) {
  std::vector<std::string> out;
  for (const RunOptions& options : steps) out.push_back(panel_title(options));
  return out;
}

TEST(PageSteps, AMethodThatDrawsHasEveryResolutionOnceAscending) {
  const std::vector<std::string> expected = {"cullide at 32 px", "cullide at 128 px",
                                             "far at 32 px", "far at 128 px"};
  EXPECT_EQ(titles(at_resolutions({of(Method::cullide, 512), of(Method::far)}, {128, 32, 128})),
            expected);
}

TEST(PageSteps, PanelsOfOneMethodAreItsStepsOnce) {
  EXPECT_EQ(at_resolutions({of(Method::cullide, 64), of(Method::cullide, 128)}, {64, 128}).size(),
            2u);
}

TEST(PageSteps, MethodsWithoutAChoiceStayAsTheyAre) {
  EXPECT_EQ(titles(at_resolutions({of(Method::exact), of(Method::far_pairs)}, {32, 64})),
            (std::vector<std::string>{"exact", "far-pairs"}));
}

// The radius makes another method of it.
TEST(PageSteps, FormsOfFarAreApart) {
  RunOptions published = of(Method::far);
  published.radius = parse_radius("published");
  EXPECT_EQ(at_resolutions({of(Method::far), published}, {32, 64}).size(), 4u);
}

}  // namespace
}  // namespace farcull
