// Which pixels a point lies in: pixels are closed squares, so a border belongs to both sides.
#include "verify/exact_point.h"

#include "tests/lab/test.h"

namespace farcull {
namespace {

using Places = std::vector<std::pair<int, int>>;

// The pixels of a window of 4 x 2 px, whose middle is the origin, that contain the point;
// ascending.
Places places_of(const ExactPoint& point) {
  Places out;
  for (const Pixel& pixel : pixels_containing(point, 4, 2)) out.push_back({pixel.x, pixel.y});
  std::ranges::sort(out);
  return out;
}

ExactPoint at(double x, double y) {
  const Vec3 p(x, y, 7);
  return {{p, p, p}, {1, 0, 0}};
}

TEST(ExactPixels, ABorderBelongsToBothSidesAndACornerToFourPixels) {
  EXPECT_EQ(places_of(at(0.5, 0.5)), (Places{{2, 1}}));
  EXPECT_EQ(places_of(at(1, 0.5)), (Places{{2, 1}, {3, 1}}));
  EXPECT_EQ(places_of(at(0.5, 0)), (Places{{2, 0}, {2, 1}}));
  EXPECT_EQ(places_of(at(-1, 0)), (Places{{0, 0}, {0, 1}, {1, 0}, {1, 1}}));
}

TEST(ExactPixels, TheRimOfTheWindowBelongsToItAndNothingBeyond) {
  EXPECT_EQ(places_of(at(-2, -1)), (Places{{0, 0}}));
  EXPECT_EQ(places_of(at(2, 1)), (Places{{3, 1}}));
  EXPECT_TRUE(places_of(at(std::nextafter(2, 3), 0.5)).empty());
  EXPECT_TRUE(places_of(at(0.5, std::nextafter(-1, -2))).empty());
}

TEST(ExactPixels, NothingIsRounded) {
  // A third of 3 along x, then of the double below 3.
  const auto third = [](double x) {
    return ExactPoint{{Vec3(x, 0.5, 0), Vec3(0, 0.5, 0), Vec3(0, 0.5, 0)}, {7, 7, 7}};
  };
  EXPECT_EQ(places_of(third(3)), (Places{{2, 1}, {3, 1}}));
  EXPECT_EQ(places_of(third(std::nextafter(3, 0))), (Places{{2, 1}}));
}

}  // namespace
}  // namespace farcull
