// The figures of the paper are those that the program draws today.
#include "experiments/picture/paper.h"

#include "tests/lab/test.h"

namespace farcull {
namespace {

const std::string kPair =
    std::string(FARCULL_TEST_DIR) + "/cases/published-far-loses-this-pair.obj";

std::size_t count_of(const std::string& word, const std::string& text) {
  std::size_t count = 0;
  for (auto at = text.find(word); at != std::string::npos; at = text.find(word, at + 1)) ++count;
  return count;
}

// Where this fails, bash experiments/paper.sh draws them anew; look at them before they are
// committed.
TEST(PaperFigures, AreThoseOfThePages) {
  const std::vector<PaperFigure> figures = paper_figures(kPair);
  EXPECT_EQ(figures.size(), 6u);
  for (const PaperFigure& figure : figures) {
    EXPECT_EQ(figure.svg,
              read_text(std::string(FARCULL_TEST_DIR) + "/../docs/figures/" + figure.name + ".svg"))
        << figure.name;
  }
}

// Theorem 9, as the figure shows it: each triangle misses two of the four centres, and no centre is
// hit by both.
TEST(PaperFigures, OfThePublishedRadiusShowsNoCentreThatBothHit) {
  const std::string svg = published_figure(kPair).svg;
  EXPECT_EQ(count_of(": hit", svg), 4u);
  EXPECT_EQ(count_of(": miss", svg), 4u);
  EXPECT_TRUE(has_text(svg, "least miss: 0.00138 px"));
}

TEST(PaperFiguresTwin, OfAPairFartherFrom45DegreesShowsNoMiss) {
  std::string text = read_text(kPair);
  for (auto at = text.find("0.99375"); at != std::string::npos; at = text.find("0.99375"))
    text.replace(at, 7, "0.5");
  const std::string other = testing::TempDir() + "other_pair.obj";
  std::ofstream(other) << text;
  EXPECT_EQ(count_of(": hit", published_figure(other).svg), 8u);
}

TEST(PaperFigures, OfAMissingCaseIsAnError) {
  const Error error = error_of([] { published_figure(kPair + "none.obj"); });
  EXPECT_TRUE(has_text(error.what(), "none.obj"));
}

// Two pairs cross: their four triangles have one bit at the end, and so has the one behind them.
TEST(PaperFigures, OfThePassesKeepsWhatCrosses) {
  const std::string svg = passes_figure().svg;
  const std::string end = svg.substr(svg.find("At the end"));
  EXPECT_EQ(count_of("stroke=\"#b30\" stroke-width=\"4\"", end), 1u) << "the legend alone";
  EXPECT_EQ(count_of("stroke=\"#bbb\" stroke-width=\"4\"", end), 7u + 1u);
  EXPECT_EQ(count_of("stroke=\"#07a\" stroke-width=\"4\"", end) +
                count_of("stroke=\"#283\" stroke-width=\"4\"", end),
            5u + 2u);
}

}  // namespace
}  // namespace farcull
