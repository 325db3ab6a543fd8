// What the canvas on the cores of the CPU does at the very borders: depths that are equal, depths
// of 24 bits, and corners that doubles know too badly.
#include "core/native/canvas.h"
#include "offsets/minkowski.h"
#include "offsets/obb.h"
#include "tests/lab/canvas.h"
#include "tests/lab/lanes.h"

namespace farcull {
namespace {

/// A box over the whole window with these ends in depth (px), which are floats.
Proxy slice(float near, float far) {
  Proxy out{};
  out.corners = {-20, -20, 20, -20, 20, 20, -20, 20};
  out.solid = {{{0, 0, 0, near}, {1, 0, 0, 100}, {0, 1, 0, 100}, {0, 0, 1, 100}, {far, 0, 0, 0}}};
  return out;
}

/// Whether element 1 is seen behind element 0 in some pixel.
bool is_seen(NativeCanvas& canvas, const Window& window, const Drawables& drawables,
             bool touching) {
  Pass pass;
  pass.slots = 1;
  pass.touching = touching;
  pass.draws = {{0, 0}, {1, 0}};
  pass.steps = {{Verb::store, 0, 1}, {Verb::ask, 1, 1}};
  canvas.begin(window, drawables);
  return canvas.run(pass)[0] != 0;
}

// Two solids that share a depth and no more touch. FAR asks for that, since such triangles may
// meet.
TEST(NativeDepth, SolidsThatTouchAreSeenWhereTouchingCounts) {
  const Window window = lab::window(40, 100);
  Drawables drawables;
  drawables.first = {0, 1, 2};
  on_every_target([&] {
    for (const int bits : {32, 24}) {
      NativeCanvas canvas(DepthMode::fragment, obb_fattener().solid, {.depth_bits = bits});
      drawables.proxies = {slice(3, 9), slice(-5, 3)};
      EXPECT_TRUE(is_seen(canvas, window, drawables, true)) << bits;
      EXPECT_FALSE(is_seen(canvas, window, drawables, false)) << bits;
      // The twins: a quarter of a pixel less, or more.
      drawables.proxies[1] = slice(-5, 2.75f);
      EXPECT_FALSE(is_seen(canvas, window, drawables, true)) << bits;
      drawables.proxies[1] = slice(-5, 3.25f);
      EXPECT_TRUE(is_seen(canvas, window, drawables, false)) << bits;
    }
  });
}

TEST(NativeDepth, TrianglesThatTouchAreSeenWhereTouchingCounts) {
  const Window window = lab::window(40, 100);
  const auto triangle = [](float z) {
    return std::array<float, 12>{-20, -20, z, 0, 40, -20, z, 0, -20, 40, z, 0};
  };
  Drawables drawables;
  drawables.mode = DepthMode::fixed;
  drawables.first = {0, 1, 2};
  on_every_target([&] {
    for (const int bits : {32, 24}) {
      for (const bool conservative : {false, true}) {
        NativeCanvas canvas(DepthMode::fixed, {},
                            {.depth_bits = bits, .conservative = conservative});
        drawables.triangles = {triangle(3), triangle(3)};
        EXPECT_TRUE(is_seen(canvas, window, drawables, true)) << bits;
        EXPECT_FALSE(is_seen(canvas, window, drawables, false)) << bits;
        drawables.triangles[1] = triangle(2.75f);
        EXPECT_FALSE(is_seen(canvas, window, drawables, true)) << bits;
        drawables.triangles[1] = triangle(3.25f);
        EXPECT_TRUE(is_seen(canvas, window, drawables, false)) << bits;
      }
    }
  });
}

// depth_rounding() (core/canvas/canvas.h) counts half a step for it.
TEST(NativeDepth, TwentyFourBitsHoldTheNearestStep) {
  const Window window = lab::window(40, 100);
  const Fattener raw = raw_triangles();
  const Drawables drawables = lab::fattened(
      window, raw, 0, {{lab::patch({Vec3(-19, -18, -71), Vec3(19, -17, 23), Vec3(1, 19, 88)})}});
  constexpr float kTop = 0x1p24f - 1;
  on_every_target([&] {
    const auto depths = [&](int bits) {
      NativeCanvas canvas(DepthMode::fixed, {}, {.depth_bits = bits});
      canvas.begin(window, drawables);
      return canvas.depths(Verb::store, {{0, 0}});
    };
    const std::vector<float> fine = depths(32), held = depths(24);
    int covered = 0, cut_differs = 0;
    for (std::size_t i = 0; i < fine.size(); ++i) {
      if (fine[i] == 1) continue;
      ++covered;
      EXPECT_EQ(held[i], std::nearbyint(fine[i] * kTop) / kTop);
      cut_differs += held[i] != std::floor(fine[i] * kTop) / kTop;
    }
    EXPECT_GT(covered, 500);
    EXPECT_GT(cut_differs, 30) << "the twin: steps that are cut off";
  });
}

// A corner may lie inside the region of a window although its image is known too badly to be drawn.
// Then the lanes leave its triangle to the scalar text, which says that it cannot be drawn.
TEST(NativeDepth, LanesLeaveOutWhatDoublesKnowTooBadly) {
  Window window = lab::window(40, 100);
  window.view = parse_view("1:1:0");
  window.map = window.view.rows;
  const Vec3 right = window.view.rows.row(0), up = window.view.rows.row(1),
             depth = window.view.rows.row(2);
  // A triangle of a pixel's size whose image lies at (reach, reach, reach), in px.
  const auto scene_at = [&](double reach) {
    Scene scene;
    const Vec3 far = reach * (right + up + depth);
    scene.vertices = {far, far + right, far + up};
    scene.triangles = {{0, 1, 2}};
    scene.objects = {{.name = "far", .first_triangle = 0, .triangle_count = 1}};
    return scene;
  };
  window.lo = Vec3::Constant(-0x1p50);
  window.hi = Vec3::Constant(0x1p50);
  on_every_target([&] {
    for (const Fattener& fattener : {obb_fattener(), minkowski_fattener()}) {
      const auto undrawable = [&](double reach) {
        FattenCounts counts;
        const std::vector<std::uint32_t> items = {0};
        const Drawables out = fatten(scene_at(reach), items, window, fattener, 0.72, counts);
        EXPECT_EQ(out.undrawable.size() + out.proxies.size(), 1u);
        return !out.undrawable.empty();
      };
      // The error is 2^-50 of the terms, the limit 2^-10 px.
      EXPECT_TRUE(undrawable(0x1p44));
      EXPECT_FALSE(undrawable(0x1p34)) << "the twin: known well enough";
    }
  });
}

}  // namespace
}  // namespace farcull
