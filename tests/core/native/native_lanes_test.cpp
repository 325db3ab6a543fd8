// Kernels and fattening on the lanes of every instruction set: the bits of the scalar text.
#include "core/native/canvas.h"
#include "core/view/regions.h"
#include "offsets/offsets.h"
#include "tests/lab/lanes.h"
#include "tests/lab/scenes.h"
#include "tests/lab/solids.h"

namespace farcull {
namespace {

TEST(NativeLanes, TheProcessorsTargetsAreListedAndAnUnknownOneIsRefused) {
  const std::vector<std::string> targets = lane_targets();
  EXPECT_EQ(lane_target(), targets.front());
  EXPECT_THROW(use_lane_target("abacus"), Error);
  EXPECT_EQ(lane_target(), targets.front());
}

// ---- kernels ----

bool same_bits(float a, float b) {
  return std::bit_cast<std::uint32_t>(a) == std::bit_cast<std::uint32_t>(b);
}

/// Lines of a solid whose answer on lanes differs from that of the scalar text.
std::uint64_t different_lines(const SolidProgram& program, const Solid& solid,
                              const std::vector<float>& cx, const std::vector<float>& cy) {
  const std::size_t count = cx.size();
  std::vector<std::uint8_t> hit(count);
  std::vector<float> entry(count), exit(count);
  program.lines_native({&solid, static_cast<std::uint32_t>(count), cx.data(), cy.data(), hit.data(),
                        entry.data(), exit.data()});
  std::uint64_t different = 0;
  for (std::size_t i = 0; i < count; ++i) {
    float first = 0, last = 0;
    const bool met = program.interval(cx[i], cy[i], solid, first, last);
    different +=
        met != (hit[i] != 0) || (met && (!same_bits(first, entry[i]) || !same_bits(last, exit[i])));
  }
  return different;
}

const auto kTriangles = static_cast<std::uint64_t>(trials(60'000));
constexpr std::uint64_t kLines = 37;  // of a triangle

/// On every instruction set lines through solids that `draw` makes are those of the scalar text;
/// it says where a line is.
template <class Draw>
void expect_scalar_lines(const SolidProgram& program, std::uint64_t seed, const Draw& draw) {
  on_every_target([&] {
    rational::Draws random(seed);
    std::uint64_t lines = 0, different = 0;
    for (std::uint64_t n = 0; n < kTriangles; ++n) {
      const auto [cx, cy, solid] = draw(random, n);
      std::vector<float> x, y;
      for (std::uint64_t i = 0; i < kLines; ++i) {  // the line itself, and others around it
        x.push_back(i == 0 ? cx : static_cast<float>(cx + random.uniform(-2, 2)));
        y.push_back(i == 0 ? cy : static_cast<float>(cy + random.uniform(-2, 2)));
      }
      lines += x.size();
      different += different_lines(program, solid, x, y);
    }
    EXPECT_EQ(different, 0u);
    EXPECT_EQ(lines, kTriangles * kLines);
  });
}

TEST(NativeLanes, BoxesAreThoseOfTheScalarTextBitForBit) {
  expect_scalar_lines(obb_fattener().solid, 20261122, [](rational::Draws& random, std::uint64_t) {
    return box_line::adversarial(random);
  });
}

TEST(NativeLanes, ExactOffsetsAreThoseOfTheScalarTextBitForBit) {
  expect_scalar_lines(
      minkowski_fattener().solid, 20261123, [](rational::Draws& random, std::uint64_t n) {
        const auto t = minkowski_cases::random_triangle(
            random, static_cast<int>(n % minkowski_cases::kKindCount));
        const Vec3 p = (t[0] + t[1] + t[2]) / 3;
        return std::tuple(static_cast<float>(p[0]), static_cast<float>(p[1]),
                          minkowski_solid(t[0], t[1], t[2], random.uniform(0.1, 3)));
      });
}

// ---- fattening ----

TEST(NativeLanes, FattenedTrianglesAreThoseOfTheScalarTextBitForBit) {
  on_every_target([&] {
    long on_lanes = 0, left = 0;
    for (std::uint64_t seed = 1; seed <= 20; ++seed) {
      const Scene scene = lab::random_scene(seed);
      const Regions regions = find_regions(scene);
      if (regions.triangles.empty()) continue;
      for (const std::string view : {"x", "1:2:0.5"}) {
        const auto window = fit_window(parse_view(view), regions.places, 64);
        ASSERT_TRUE(window);
        for (const Fattener& fattener : {obb_fattener(), minkowski_fattener()}) {
          Fattener one_by_one = fattener;
          one_by_one.fatten_inside = nullptr;
          FattenCounts counts, counts_one;
          const Drawables many = fatten(scene, regions.triangles, *window, fattener, 0.71, counts);
          const Drawables one =
              fatten(scene, regions.triangles, *window, one_by_one, 0.71, counts_one);
          ASSERT_EQ(many.proxies.size(), one.proxies.size());
          EXPECT_EQ(many.first, one.first);
          EXPECT_EQ(many.undrawable, one.undrawable);
          EXPECT_EQ(counts.clipped, counts_one.clipped);
          EXPECT_EQ(counts.outside, counts_one.outside);
          // That lanes did most of it, and left what has to be clipped.
          std::vector<Proxy> proxies(regions.triangles.size());
          std::vector<std::uint8_t> done(proxies.size());
          fattener.fatten_inside({.scene = &scene,
                                  .items = regions.triangles.data(),
                                  .count = proxies.size(),
                                  .window = &*window,
                                  .radius = 0.71,
                                  .bounds = proxy_bounds(*window),
                                  .done = done.data(),
                                  .out = proxies.data()});
          on_lanes += std::ranges::count(done, 1);
          left += std::ranges::count(done, 0);
          EXPECT_EQ(std::memcmp(many.proxies.data(), one.proxies.data(),
                                many.proxies.size() * sizeof(Proxy)),
                    0)
              << fattener.name << ", seed " << seed;
        }
      }
    }
    EXPECT_GT(on_lanes, 100);
    EXPECT_GT(left, 10);
  });
}

}  // namespace
}  // namespace farcull
