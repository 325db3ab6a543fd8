#include "experiments/studies/run_point.h"

#include "core/canvas/fatten.h"
#include "core/view/regions.h"
#include "core/view/view.h"
#include "experiments/scenes/builtin/scenes.h"
#include "offsets/minkowski.h"
#include "offsets/obb.h"
#include "tests/lab/test.h"

namespace farcull {
namespace {

Record record_at(int resolution, double radius) {
  Record record;
  record.options.method = Method::far;
  record.options.resolution = resolution;
  record.options.views = "x,y,z";
  std::vector<ViewReport> views;
  for (const char* name : {"x", "y", "z"}) {
    ViewReport view{.name = name, .budget = {}};
    view.radius_px = radius;
    views.push_back(view);
  }
  record.found.by = views;
  return record;
}

// Whether the point is inside the closed convex quadrilateral, by the side of each edge.
bool inside(const std::array<float, 8>& c, double x, double y) {
  bool left = true, right = true;
  for (int i = 0; i < 4; ++i) {
    const double ax = c[2 * i], ay = c[2 * i + 1];
    const double bx = c[(2 * i + 2) % 8], by = c[(2 * i + 3) % 8];
    const double side = (bx - ax) * (y - ay) - (by - ay) * (x - ax);
    left &= side >= 0;
    right &= side <= 0;
  }
  return left || right;
}

// Every pixel of every view against every proxy.
Fragments by_all_pixels(const Scene& scene, const Record& record, const Fattener& fattener) {
  Fragments out;
  const Regions plan = find_regions(scene);
  for (const View& view : parse_views(record.options.views)) {
    const auto window = fit_window(view, plan.places, record.options.resolution);
    FattenCounts counts;
    const Drawables drawables =
        fatten(scene, plan.triangles, *window, fattener, record.found.views()[0].radius_px, counts);
    out.elements += drawables.elements();
    for (const Proxy& proxy : drawables.proxies) {
      for (int j = 0; j < window->height; ++j) {
        for (int i = 0; i < window->width; ++i) {
          const double x = i + 0.5 - window->width / 2, y = j + 0.5 - window->height / 2;
          if (!inside(proxy.corners, x, y)) continue;
          float entry = 0, exit = 0;
          ++out.covered;
          out.solid += fattener.solid.interval(static_cast<float>(x), static_cast<float>(y),
                                               proxy.solid, entry, exit);
        }
      }
    }
  }
  return out;
}

TEST(Fragments, AreThoseOfEveryPixelTried) {
  for (const char* name : {"needles:20", "degenerate"}) {
    const Scene scene = make_builtin_scene(name);
    const Record record = record_at(48, 0.75);
    for (const bool exact : {false, true}) {
      const Fragments fast = count_fragments(scene, record, exact ? "exact" : "obb");
      const Fragments slow =
          by_all_pixels(scene, record, exact ? minkowski_fattener() : obb_fattener());
      EXPECT_GT(slow.solid, 0u);
      EXPECT_EQ(fast.elements, slow.elements);
      EXPECT_EQ(fast.covered, slow.covered) << name << (exact ? " exact" : " obb");
      EXPECT_EQ(fast.solid, slow.solid);
    }
  }
}

TEST(Fragments, AreFewerOfTheSmallerSolidAndMoreOfTheLargerBall) {
  const Scene scene = make_builtin_scene("two-spheres");
  const Fragments obb = count_fragments(scene, record_at(128, 0.75), "obb");
  const Fragments exact = count_fragments(scene, record_at(128, 0.75), "exact");
  EXPECT_LT(exact.solid, obb.solid);
  EXPECT_LE(exact.solid, exact.covered);
  EXPECT_GT(count_fragments(scene, record_at(128, 1.5), "obb").solid, obb.solid);
}

}  // namespace
}  // namespace farcull
