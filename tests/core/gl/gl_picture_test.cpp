// Pictures on the device: which pixels a triangle covers, in which colour, and which of two is in
// front.
#include "core/base/error.h"
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

Image draw(const Scene& scene, const std::vector<PictureTriangle>& triangles,
           const PictureSettings& settings = {}, const Vec3& middle = Vec3::Zero()) {
  return draw_picture(lab::context(), scene, window(middle), triangles, settings);
}

std::array<Vec3, 3> square_half(double z) {
  return {Vec3(-0.8, -0.8, z), Vec3(0.8, -0.8, z), Vec3(0, 0.8, z)};
}

std::size_t covered(const Image& image) {
  return static_cast<std::size_t>(
      std::ranges::count_if(image.pixels, [](const Rgba& p) { return p.a > 0; }));
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

TEST(GlPicture, GivesEachTriangleItsOwnColour) {
  const Scene scene = scene_of({{Vec3(-1, -1, 0), Vec3(0, -1, 0), Vec3(-1, 1, 0)},
                                {Vec3(1, 1, 0), Vec3(0, 1, 0), Vec3(1, -1, 0)}});
  const Image image = draw(scene, {{.triangle = 0, .colour = kRed, .shaded = false},
                                   {.triangle = 1, .colour = kGreen, .shaded = false}});
  EXPECT_EQ(image.at(1, 17), kRed);
  EXPECT_EQ(image.at(18, 2), kGreen);
  EXPECT_EQ(image.at(10, 10).a, 0);
}

TEST(GlPicture, ShadesWithTheLightAndNotBeyondTheColour) {
  const Scene scene =
      scene_of({square_half(0), {Vec3(-1, -1, -1), Vec3(1, -1, -1), Vec3(0, -0.9, 1)}});
  const Image front = draw(scene, {{.triangle = 0, .colour = kRed}});
  const Image grazing = draw(scene, {{.triangle = 1, .colour = kRed}});
  EXPECT_GT(front.at(10, 12).r, 100);
  EXPECT_NE(front.at(10, 12), grazing.at(10, 19));
}

// The nearer one is green, whichever comes first.
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

TEST(GlPicture, OutlineShowsWhatHasNoArea) {
  const Scene scene = scene_of({{Vec3(0.5, 0.5, 0), Vec3(0.5, 0.5, 0), Vec3(0.5, 0.5, 0)},
                                {Vec3(-0.5, -0.5, 0), Vec3(0, 0, 0), Vec3(-0.25, -0.25, 0)}});
  for (const std::uint32_t t : {0u, 1u}) {
    EXPECT_EQ(covered(draw(scene, {{.triangle = t, .colour = kRed, .shaded = false}})), 0u);
    const Image image =
        draw(scene, {{.triangle = t, .colour = kRed, .shaded = false, .outline = 4}});
    EXPECT_GE(std::ranges::count(image.pixels, kRed), 9);
  }
}

TEST(GlPicture, IsTheSameFarFromTheOrigin) {
  // 2^30 is added without rounding, so nothing may differ.
  const Vec3 far = Vec3::Constant(0x1p30);
  const std::array<Vec3, 3> near = {Vec3(-0.75, -0.5, 0.25), Vec3(0.5, -0.75, 0),
                                    Vec3(0, 0.75, 0.5)};
  const Scene here = scene_of({near}),
              there = scene_of({{near[0] + far, near[1] + far, near[2] + far}});
  const Image a = draw(here, {{.triangle = 0, .colour = kRed}});
  const Image b = draw(there, {{.triangle = 0, .colour = kRed}}, {}, far);
  EXPECT_GT(covered(a), 50u);
  EXPECT_EQ(a.pixels, b.pixels);
}

TEST(GlPicture, HugeTriangleFillsAllOfIt) {
  const Scene scene = scene_of({{Vec3(-3e9, -2e9, 0), Vec3(3e9, -2e9, 0), Vec3(0, 3e9, 0)}});
  const Image image = draw(scene, {{.triangle = 0, .colour = kRed, .shaded = false}});
  EXPECT_TRUE(std::ranges::all_of(image.pixels, [](const Rgba& p) { return p == kRed; }));
}

TEST(GlPicture, DrawsMoreThanABatch) {
  const Scene scene =
      scene_of({square_half(0), {Vec3(-1, 0.8, 0), Vec3(-0.6, 0.8, 0), Vec3(-1, 1, 0)}});
  std::vector<PictureTriangle> many(100'000, {.triangle = 0, .colour = kGreen, .shaded = false});
  many.front() = many.back() = {.triangle = 1, .colour = kRed, .shaded = false};
  const Image image = draw(scene, many);
  EXPECT_EQ(image.at(0, 1), kRed);
  EXPECT_EQ(image.at(10, 12), kGreen);
}

TEST(GlPicture, RefusesASizeBeyondTheDevice) {
  const Scene scene = scene_of({square_half(0)});
  EXPECT_THROW(draw(scene, {}, {.samples = lab::context().info().max_texture_size}), Error);
}

TEST(GlPicture, WindowHoldsTheBoxes) {
  const std::vector<Box> boxes = {{Vec3(1, 2, 3), Vec3(5, 3, 4)}, {Vec3(-2, 2, 3), Vec3(-1, 9, 3)}};
  for (const char* name : {"x", "-y", "1:2:-3"}) {
    const Window w = picture_window(parse_view(name), boxes, 120, 80, 0.1, "test");
    double largest = 0;
    for (const Box& box : boxes) {
      const Box image = pixel_box(w, box);
      largest = std::max(
          {largest, -image.lo[0] / 60, image.hi[0] / 60, -image.lo[1] / 40, image.hi[1] / 40});
    }
    EXPECT_NEAR(largest, 0.8, 1e-9) << name;  // the margin on both sides, and it is used
  }
}

TEST(GlPicture, WindowRefusesWhatDoublesCannotShow) {
  const std::vector<Box> boxes = {{Vec3::Constant(-1.7e308), Vec3::Constant(1.7e308)}};
  EXPECT_THROW(picture_window(parse_view("1:1:1"), boxes, 64, 64, 0, "huge"), Error);
}

TEST(GlPicture, WindowOfAPointHasPixels) {
  const std::vector<Box> boxes = {{Vec3(1, 1, 1), Vec3(1, 1, 1)}};
  const Window w = picture_window(parse_view("z"), boxes, 64, 64, 0.04, "point");
  EXPECT_GT(w.pixel_size, 0);
  EXPECT_TRUE(to_pixel(w, Vec3(1, 1, 1)).p.allFinite());
}

}  // namespace
}  // namespace farcull
