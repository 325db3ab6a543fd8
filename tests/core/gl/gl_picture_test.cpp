// Pictures on the device: which pixels a triangle covers, in which colour, and which of two is in
// front.
#include "core/gl/picture/picture.h"
#include "tests/lab/gl.h"
#include "tests/lab/scenes.h"

namespace farcull {
namespace {

constexpr Rgba kRed = {200, 20, 30}, kGreen = {10, 180, 60}, kNothing = {0, 0, 0, 0};

Scene scene_of(const std::vector<std::array<Vec3, 3>>& triangles) {
  return lab::scene_of({triangles});
}

// 20 x 20 px of a tenth each, looked at along -z: x to the right, y up, as written.
Window window(const Vec3& middle = Vec3::Zero()) {
  const std::vector<Box> boxes = {{middle - Vec3(1, 1, 1), middle + Vec3(1, 1, 1)}};
  View view = parse_view("-z");
  view.rows << 1, 0, 0, 0, 1, 0, 0, 0, -1;
  return picture_window(view, boxes, 20, 20, 0, "test");
}

Image draw(const Scene& scene, const std::vector<PictureTriangle>& triangles, int samples = 3,
           const Vec3& middle = Vec3::Zero()) {
  return draw_picture(lab::context(), scene, window(middle), triangles, samples);
}

std::array<Vec3, 3> square_half(double z) {
  return {Vec3(-0.8, -0.8, z), Vec3(0.8, -0.8, z), Vec3(0, 0.8, z)};
}

TEST(GlPicture, CoversThePixelsInsideAndNoneOutside) {
  const Scene scene = scene_of({{Vec3(-1, -1, 0), Vec3(1, -1, 0), Vec3(-1, 1, 0)}});
  const Image image = draw(scene, {{.triangle = 0, .colour = kRed, .shaded = false}});
  ASSERT_EQ(image.width, 20);
  ASSERT_EQ(image.height, 20);
  for (int y = 0; y < 20; ++y) {
    for (int x = 0; x < 20; ++x) {
      // The pixel's square, in tenths from the lower left corner of the triangle.
      const int row = 19 - y;
      if (x + row + 2 <= 19) {
        EXPECT_EQ(image.at(x, y), kRed) << x << ", " << y;
      } else if (x + row >= 20 + 1) {
        EXPECT_EQ(image.at(x, y), kNothing) << x << ", " << y;
      } else if (x + row == 19) {  // halved by the long edge
        EXPECT_GT(image.at(x, y).a, 60) << x << ", " << y;
        EXPECT_LT(image.at(x, y).a, 195) << x << ", " << y;
      }
    }
  }
}

bool nearer_hides_farther() {
  const Scene scene = scene_of({square_half(-0.5), square_half(0.5)});  // seen along -z
  std::vector<PictureTriangle> order = {{.triangle = 0, .colour = kRed, .shaded = false},
                                        {.triangle = 1, .colour = kGreen, .shaded = false}};
  bool hides = true;
  for (int turn = 0; turn < 2; ++turn) {
    const Image image = draw(scene, order);
    hides &= image.at(10, 12) == kGreen;
    std::swap(order[0], order[1]);
  }
  return hides;
}

TEST(GlPicture, NearerHidesFarther) { EXPECT_TRUE(nearer_hides_farther()); }

TEST(GlPicture, NearerHidesFartherTwinWithTheDepthTestReversed) {
  const lab::ReversedDepth depth;
  const lab::ReversedClear clear;
  EXPECT_FALSE(nearer_hides_farther());
}

TEST(GlPicture, LiftDecidesBetweenTrianglesInOnePlace) {
  const Scene scene = scene_of({square_half(0), square_half(0)});
  const Image image = draw(scene, {{.triangle = 0, .colour = kGreen, .shaded = false, .lift = 1},
                                   {.triangle = 1, .colour = kRed, .shaded = false}});
  EXPECT_EQ(image.at(10, 12), kGreen);
}

TEST(GlPicture, RefusesASizeBeyondTheDevice) {
  const Scene scene = scene_of({square_half(0)});
  EXPECT_THROW(draw(scene, {}, lab::context().info().max_texture_size), Error);
}

}  // namespace
}  // namespace farcull
