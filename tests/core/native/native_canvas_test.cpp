// The canvas on the cores of the CPU against plain loops over pixels: the same bits for every
// instruction set and any number of threads.
#include "core/native/canvas.h"

#include "offsets/offsets.h"
#include "tests/lab/canvas.h"
#include "tests/lab/lanes.h"
#include "tests/lab/reference.h"

namespace farcull {
namespace {

using lab::Random;

std::vector<Fattener> fatteners() { return {obb_fattener(), minkowski_fattener()}; }

// ---- passes ----

/// What a pass has to see, pixel by pixel in the order of the draws.
std::vector<std::uint8_t> plain_run(const Window& w, const Drawables& drawables,
                                    const SolidProgram& program, const Pass& pass, int bits = 32,
                                    bool reversed = false) {
  const float top = 0x1p24f - 1;
  const auto held_as = [&](float mapped) {
    return bits == 24 ? std::nearbyint(mapped * top) : mapped;
  };
  std::vector<float> depth(static_cast<std::size_t>(w.width) * w.height, bits == 24 ? top : 1);
  std::vector<std::uint8_t> seen(pass.slots);
  const float scale = depth_scale(w);
  for (const Step& step : pass.steps) {
    for (std::uint32_t d = step.first; d < step.first + step.count; ++d) {
      for (int y = 0; y < w.height; ++y) {
        for (int x = 0; x < w.width; ++x) {
          const float cx = static_cast<float>(x) + 0.5f - 0.5f * static_cast<float>(w.width),
                      cy = static_cast<float>(y) + 0.5f - 0.5f * static_cast<float>(w.height);
          float& held = depth[static_cast<std::size_t>(y) * w.width + x];
          float entry = 0, exit = 0, place = 0;
          if (pass.draws[d].element != kEverywhere) {
            const Proxy& proxy = drawables.proxies[pass.draws[d].element];
            const auto& c = proxy.corners;
            bool inside = true;
            for (int i = 0; i < 4; ++i) {
              const int j = (i + 1) % 4;
              inside = inside && (c[2 * j] - c[2 * i]) * (cy - c[2 * i + 1]) >=
                                     (c[2 * j + 1] - c[2 * i + 1]) * (cx - c[2 * i]);
            }
            const float lo_x = std::min({c[0], c[2], c[4], c[6]}),
                        hi_x = std::max({c[0], c[2], c[4], c[6]}),
                        lo_y = std::min({c[1], c[3], c[5], c[7]}),
                        hi_y = std::max({c[1], c[3], c[5], c[7]});
            inside = inside && cx >= lo_x && cx <= hi_x && cy >= lo_y && cy <= hi_y;
            if (!inside || !program.interval(cx, cy, proxy.solid, entry, exit)) continue;
            const float z = (step.verb == Verb::store ? entry : exit) * scale;
            place = held_as(std::min(std::max(0.5f + z, 0.25f), 0.75f));
          }
          if (step.verb == Verb::store)
            held = std::min(held, place);
          else if (reversed ? place < held : pass.touching ? place >= held : place > held)
            seen[pass.draws[d].slot] = 1;
        }
      }
    }
  }
  return seen;
}

/// Random triangles of many sizes, and a pass with many steps over them.
struct RandomPass {
  Window window = lab::window(66, 100);
  std::vector<Patch> patches;
  Pass pass;

  explicit RandomPass(std::uint64_t seed) {
    Random random(seed);
    for (int i = 0; i < 60; ++i) {
      const double reach = std::exp2(random.between(-3, 5));
      Patch p;
      const Vec3 at(random.between(-30, 30), random.between(-30, 30), random.between(-60, 60));
      for (int k = 0; k < 3; ++k) {
        Vec3 q =
            at + reach * Vec3(random.between(-1, 1), random.between(-1, 1), random.between(-1, 1));
        for (int axis = 0; axis < 3; ++axis)
          q[axis] = std::clamp(q[axis], window.lo[axis], window.hi[axis]);
        p.corners[p.count++] = q;
      }
      patches.push_back(p);
    }
    pass.touching = random.below(2) != 0;
    pass.slots = 24;
    std::uint32_t slot = 0;
    for (int s = 0; s < 8; ++s) {
      const Verb verb = s % 2 == 0 ? Verb::store : Verb::ask;
      Step step{verb, static_cast<std::uint32_t>(pass.draws.size()), 0};
      for (int d = 0; d < 6; ++d) {
        pass.draws.push_back({static_cast<std::uint32_t>(random.below(60)),
                              verb == Verb::ask ? slot + static_cast<std::uint32_t>(d) : 0});
      }
      if (verb == Verb::store && random.below(12) == 0) pass.draws.push_back({kEverywhere, 0});
      if (verb == Verb::ask) slot += 6;
      step.count = static_cast<std::uint32_t>(pass.draws.size()) - step.first;
      pass.steps.push_back(step);
    }
  }
};

/// The same pass with every draw many times over, which changes no answer: so many that the rows of
/// the window are divided among three threads.
Pass repeated(const Pass& pass) {
  constexpr std::uint32_t kTimes = 140;
  Pass out;
  out.touching = pass.touching;
  out.slots = pass.slots;
  for (const Draw& draw : pass.draws) out.draws.insert(out.draws.end(), kTimes, draw);
  for (const Step& step : pass.steps)
    out.steps.push_back({step.verb, step.first * kTimes, step.count * kTimes});
  return out;
}

TEST(NativeCanvas, PassesSeeWhatPlainLoopsSee) {
  const int seeds = trials(40);
  on_every_target([&] {
    int seen_in_all = 0, reversed_differs = 0;
    for (std::uint64_t seed = 1; seed <= static_cast<std::uint64_t>(seeds); ++seed) {
      const RandomPass random(seed);
      const Pass many = repeated(random.pass);
      ASSERT_GT(many.draws.size(), 3 * 2048u);
      for (const Fattener& fattener : fatteners()) {
        SCOPED_TRACE(fattener.name + ", seed " + std::to_string(seed));
        const Drawables drawables = lab::fattened(random.window, fattener, 0.72, random.patches);
        const auto run = [&](int bits, bool reversed) {
          return plain_run(random.window, drawables, fattener.solid, random.pass, bits, reversed);
        };
        for (const int bits : {32, 24}) {
          const auto wanted = run(bits, false);
          for (const unsigned threads : {1u, 2u, 3u}) {
            NativeCanvas canvas(fattener.mode, fattener.solid,
                                {.depth_bits = bits, .threads = threads});
            canvas.begin(random.window, drawables);
            EXPECT_EQ(canvas.run(random.pass), wanted) << bits << " bits";
            EXPECT_EQ(canvas.run(many), wanted) << bits << " bits, " << threads << " threads";
          }
          seen_in_all += static_cast<int>(std::ranges::count(wanted, 1));
          reversed_differs += run(bits, true) != wanted;
        }
      }
    }
    EXPECT_GT(seen_in_all, 10 * seeds);
    EXPECT_LT(seen_in_all, seeds * 4 * 24 - 10 * seeds);
    EXPECT_GT(reversed_differs, 13 * seeds / 4) << "a swapped depth test has to be noticed";
  });
}

// ---- proxies that are fitted as they are drawn ----

/// The triangles of a random pass as a scene, since pixel space is the world itself.
Scene scene_of(const RandomPass& random) {
  std::vector<reference::Triangle> triangles;
  for (const Patch& p : random.patches)
    triangles.push_back({p.corners[0], p.corners[1], p.corners[2]});
  return reference::scene_of({triangles});
}

Drawables waiting(const Scene& scene, const Window& window, const Fattener& fattener, double radius,
                  double reach) {
  std::vector<std::uint32_t> items(scene.triangles.size());
  std::iota(items.begin(), items.end(), 0);
  FattenCounts counts;
  return fatten(scene, items, window, fattener, radius, counts, {}, reach);
}

TEST(NativeCanvas, ProxiesThatWaitAreSeenAsPlainLoopsSeeThem) {
  // Twins: outlines that are wrong by a few pixels, in depth or in the plane.
  using Change = void (*)(ProxyOutline & outline);
  const Change twins[] = {[](ProxyOutline& o) { o.farthest -= 8; },
                          [](ProxyOutline& o) { o.depth += 8; },
                          [](ProxyOutline& o) { o.x = o.range.x0; }};
  const int seeds = trials(40);
  on_every_target([&] {
    int different[std::size(twins)] = {}, too_far = 0;
    for (std::uint64_t seed = 1; seed <= static_cast<std::uint64_t>(seeds); ++seed) {
      const RandomPass random(seed);
      const Scene scene = scene_of(random);
      const Pass many = repeated(random.pass);
      for (const Fattener& fattener : fatteners()) {
        for (const double radius : {0.72, 0.3}) {
          SCOPED_TRACE(fattener.name + ", seed " + std::to_string(seed));
          const double input = budget_for(native_limits(), 128).input;
          const Drawables fitted = lab::fattened(random.window, fattener, radius, random.patches);
          const Drawables right = waiting(scene, random.window, fattener, radius, radius - input);
          ASSERT_EQ(right.first, fitted.first);
          ASSERT_TRUE(right.proxies.empty());
          const auto seen = [&](const Drawables& drawables, const Pass& pass, int bits) {
            NativeCanvas canvas(fattener.mode, fattener.solid, {.depth_bits = bits, .threads = 2});
            canvas.begin(random.window, drawables);
            return canvas.run(pass);
          };
          for (const int bits : {32, 24}) {
            const auto wanted = plain_run(random.window, fitted, fattener.solid, random.pass, bits);
            EXPECT_EQ(seen(right, random.pass, bits), wanted) << bits << " bits";
            EXPECT_EQ(seen(right, many, bits), wanted) << bits << " bits, many draws";
          }
          const auto wanted = seen(right, random.pass, 32);
          for (std::size_t t = 0; t < std::size(twins); ++t) {
            Drawables wrong = right;
            for (ProxyOutline& outline : wrong.outlines) twins[t](outline);
            different[t] += seen(wrong, random.pass, 32) != wanted;
          }
          too_far +=
              seen(waiting(scene, random.window, fattener, radius, 3), random.pass, 32) != wanted;
        }
      }
    }
    for (std::size_t t = 0; t < std::size(twins); ++t) EXPECT_GT(different[t], 0) << "twin " << t;
    EXPECT_GT(too_far, 0);
  });
}

/// What is seen of a triangle that lies behind a small one and before a large one, where the
/// outline of the small one is this much too far away.
std::vector<std::uint8_t> seen_between(const Fattener& fattener, float too_far) {
  const Window window = lab::window(66, 100);
  const auto flat = [](double size, double z) {
    return reference::Triangle{Vec3(-size, -size, z), Vec3(size, -size, z), Vec3(0, size, z)};
  };
  const Scene scene = reference::scene_of({{flat(30, 50), flat(0.2, 0), flat(0.2, 20)}});
  Drawables drawables = waiting(scene, window, fattener, 0.72, 0.71);
  drawables.outlines[1].nearest += too_far;
  Pass pass;
  pass.slots = 1;
  pass.draws = {{0, 0}, {1, 0}, {2, 0}};
  pass.steps = {{Verb::store, 0, 1}, {Verb::store, 1, 1}, {Verb::ask, 2, 1}};
  NativeCanvas canvas(fattener.mode, fattener.solid);
  canvas.begin(window, drawables);
  return canvas.run(pass);
}

TEST(NativeCanvasTwin, AnOutlineThatIsTooFarAwayLosesWhatIsStored) {
  on_every_target([] {
    for (const Fattener& fattener : fatteners()) {
      EXPECT_EQ(seen_between(fattener, 0), std::vector<std::uint8_t>{1});
      EXPECT_EQ(seen_between(fattener, 60), std::vector<std::uint8_t>{0});
    }
  });
}

TEST(NativeCanvas, OutlinesAreThoseOfTheFittedProxies) {
  on_every_target([] {
    int sure = 0;
    for (std::uint64_t seed = 1; seed <= 20; ++seed) {
      const RandomPass random(seed);
      const Scene scene = scene_of(random);
      for (const Fattener& fattener : fatteners()) {
        const Drawables fitted = lab::fattened(random.window, fattener, 0.72, random.patches);
        const Drawables found = waiting(scene, random.window, fattener, 0.72, 0.71);
        for (std::size_t e = 0; e < found.outlines.size(); ++e) {
          const ProxyOutline &outline = found.outlines[e],
                             expected = outline_of(fitted.proxies[e], random.window);
          const Solid& solid = fitted.proxies[e].solid;
          EXPECT_EQ(std::memcmp(&outline.range, &expected.range, sizeof(PixelRange)), 0);
          EXPECT_EQ(outline.nearest, solid[0][3]);
          EXPECT_EQ(outline.farthest, fattener.name == "obb" ? solid[4][0] : solid[2][3]);
          if (outline.x == kNoPixel) continue;
          ++sure;
          float entry = 0, exit = 0;
          ASSERT_TRUE(fattener.solid.interval(static_cast<float>(outline.x) + 0.5f - 33,
                                              static_cast<float>(outline.y) + 0.5f - 33, solid,
                                              entry, exit));
          EXPECT_GE(exit, outline.depth);
        }
      }
    }
    EXPECT_GT(sure, 1000);
  });
}

// Large enough that rows are shared out among threads.
TEST(NativeCanvas, AnyNumberOfThreadsGivesTheSameBits) {
  Random random(7);
  const Window w = lab::window(200, 100);
  std::vector<Patch> patches;
  for (int i = 0; i < 12'000; ++i) {
    const Vec3 at(random.between(-98, 98), random.between(-98, 98), random.between(-90, 90));
    const auto near = [&] {
      return Vec3(at + Vec3(random.between(-2, 2), random.between(-2, 2), random.between(-2, 2)));
    };
    patches.push_back(lab::patch({near(), near(), near()}));
  }
  for (Fattener fattener : {obb_fattener(), minkowski_fattener(), raw_triangles()}) {
    const Drawables drawables = lab::fattened(w, fattener, 0.72, patches);
    Pass pass;
    pass.slots = 6000;
    for (std::uint32_t i = 0; i < 12'000; ++i) pass.draws.push_back({i, i < 6000 ? 0 : i - 6000});
    pass.steps = {{Verb::store, 0, 6000}, {Verb::ask, 6000, 6000}};
    std::vector<std::uint8_t> first;
    std::vector<float> first_depths;
    on_every_target([&] {
      for (const unsigned threads : {1u, 2u, 3u, 7u}) {
        NativeCanvas canvas(fattener.mode, fattener.solid, {.threads = threads});
        canvas.begin(w, drawables);
        const auto seen = canvas.run(pass);
        const auto depths = canvas.depths(Verb::store, pass.draws);
        if (first.empty()) {
          first = seen;
          first_depths = depths;
        }
        EXPECT_EQ(seen, first) << fattener.name << ", " << threads << " threads";
        EXPECT_EQ(depths, first_depths) << fattener.name << ", " << threads << " threads";
      }
    });
    EXPECT_GT(std::ranges::count(first, 0), 100);
    EXPECT_GT(std::ranges::count(first, 1), 100);
  }
}

TEST(NativeCanvas, HoldsTheSamplesUnderTheDepthMap) {
  const Fattener fattener = obb_fattener();
  for (const int bits : {32, 24}) {
    NativeCanvas canvas(fattener.mode, fattener.solid, {.depth_bits = bits});
    lab::expect_held_under_map(canvas, fattener, bits, 0);
  }
}

// ---- raw triangles ----

std::vector<int> coverage(const Window& w, const std::vector<Patch>& patches) {
  const Fattener fattener = raw_triangles();
  std::vector<int> out(static_cast<std::size_t>(w.width) * w.height);
  NativeCanvas canvas(fattener.mode, fattener.solid);
  const Drawables drawables = lab::fattened(w, fattener, 0, patches);
  canvas.begin(w, drawables);
  for (std::uint32_t e = 0; e < drawables.elements(); ++e) {
    const std::vector<float> held = canvas.depths(Verb::store, {{e, 0}});
    for (std::size_t i = 0; i < out.size(); ++i) out[i] += held[i] < 1;
  }
  return out;
}

// A fan about a point, its corners on pixel centres and between them: every pixel inside belongs to
// one triangle alone.
TEST(NativeTriangles, OfTrianglesThatShareEdgesOneOwnsEachPixel) {
  const Window w = lab::window(40, 10);
  on_every_target([&] {
    for (std::uint64_t seed = 1; seed <= 40; ++seed) {
      Random random(seed);
      const auto point = [&](double x, double y) {
        // On the subpixel grid, half of the time on pixel centres.
        const double grid = random.below(2) ? 1 : 0x1p-8;
        return Vec3(std::floor(x / grid) * grid + 0.5, std::floor(y / grid) * grid + 0.5, 0);
      };
      const Vec3 corners[4] = {
          {-19.5, -19.5, 0}, {18.5, -19.5, 0}, {18.5, 18.5, 0}, {-19.5, 18.5, 0}};
      const Vec3 middle = point(random.between(-15, 15), random.between(-15, 15));
      std::vector<Patch> fan;
      for (int i = 0; i < 4; ++i) {
        const bool turned = random.below(2) != 0;
        fan.push_back(lab::patch(
            {middle, corners[turned ? (i + 1) % 4 : i], corners[turned ? i : (i + 1) % 4]}));
      }
      const std::vector<int> counts = coverage(w, fan);
      for (int y = 1; y < 38; ++y)
        for (int x = 1; x < 38; ++x)
          EXPECT_EQ(counts[static_cast<std::size_t>(y) * 40 + x], 1) << x << ", " << y;
      // The twin: with one triangle left out, pixels are left over.
      fan.pop_back();
      const std::vector<int> fewer = coverage(w, fan);
      EXPECT_GT(std::count(fewer.begin() + 41, fewer.begin() + 1500, 0),
                std::count(counts.begin() + 41, counts.begin() + 1500, 0));
    }
  });
}

TEST(NativeTriangles, DepthIsInterpolatedAtPixelCentres) {
  const Window w = lab::window(40, 100);
  const auto plane = [](double x, double y) { return 3 * x - 2 * y + 1; };
  const auto at = [&](double x, double y) { return Vec3(x, y, plane(x, y)); };
  const Fattener fattener = raw_triangles();
  NativeCanvas canvas(fattener.mode, fattener.solid);
  const Drawables drawables =
      lab::fattened(w, fattener, 0, {{lab::patch({at(-15, -14), at(16, -10), at(2, 17)})}});
  canvas.begin(w, drawables);
  const std::vector<float> held = canvas.depths(Verb::store, {{0, 0}});
  int covered = 0;
  for (int y = 0; y < 40; ++y) {
    for (int x = 0; x < 40; ++x) {
      const float d = held[static_cast<std::size_t>(y) * 40 + x];
      if (d >= 1) continue;
      ++covered;
      // Places of corners and of the sample, each rounded to float.
      const double wanted = 0.5 + plane(x + 0.5 - 20, y + 0.5 - 20) * double(depth_scale(w));
      EXPECT_LE(std::abs(d - wanted), 4 * 0x1p-24);
    }
  }
  EXPECT_GT(covered, 400);
}

// Whether the closed square of a pixel and a triangle with corners on the subpixel grid have a
// point in common. Convex polygons have none iff a normal of one of their edges separates them. In
// whole subpixels.
bool touches(const std::array<std::array<std::int64_t, 2>, 3>& t, std::int64_t x, std::int64_t y) {
  constexpr std::int64_t kSide = 256;
  using Point = std::array<std::int64_t, 2>;
  std::vector<Point> normals = {{1, 0}, {0, 1}};
  for (int i = 0; i < 3; ++i) {
    const Point &a = t[i], &b = t[(i + 1) % 3];
    normals.push_back({b[1] - a[1], a[0] - b[0]});
  }
  for (const Point& n : normals) {
    const auto along = [&](const Point& p) { return n[0] * p[0] + n[1] * p[1]; };
    const auto [low, high] = std::minmax({along(t[0]), along(t[1]), along(t[2])});
    const auto [from, to] = std::minmax({along({x, y}), along({x + kSide, y}),
                                         along({x, y + kSide}), along({x + kSide, y + kSide})});
    if (high < from || to < low) return false;
  }
  return true;
}

// Points, slivers and triangles below a pixel among them. Corners lie on the subpixel grid, so that
// snapping does not move them.
TEST(NativeTriangles, ConservativelyCoverWhateverTheyTouch) {
  constexpr int kSide = 16;
  const Window window = lab::window(kSide);
  const Fattener raw = raw_triangles();
  on_every_target([&] {
    NativeCanvas canvas(DepthMode::fixed, raw.solid, {.conservative = true});
    NativeCanvas plain(DepthMode::fixed, raw.solid);
    Random random(11);
    int plain_lacks = 0;
    for (int round = 0; round < 300; ++round) {
      std::array<std::array<std::int64_t, 2>, 3> corners;
      const int reach = 1 << random.below(12);
      const std::int64_t at[2] = {random.below(kSide * 256), random.below(kSide * 256)};
      Drawables drawables;
      drawables.mode = DepthMode::fixed;
      std::array<float, 12> t{};
      double low = 1e9, high = -1e9;
      for (int i = 0; i < 3; ++i) {
        const double z = random.below(20) - 10;
        low = std::min(low, z);
        high = std::max(high, z);
        for (int k = 0; k < 2; ++k) {
          corners[i][k] =
              std::clamp<std::int64_t>(at[k] + random.below(2 * reach + 1) - reach, 0, kSide * 256);
          if (i == 2 && round % 5 == 0) corners[i][k] = corners[1][k];
          t[4 * i + k] = static_cast<float>(corners[i][k] - kSide * 128) / 256;
        }
        t[4 * i + 2] = static_cast<float>(z);
      }
      drawables.triangles.push_back(t);
      drawables.first.push_back(1);
      canvas.begin(window, drawables);
      plain.begin(window, drawables);
      const std::vector<float> depths = canvas.depths(Verb::store, {{0, 0}});
      const std::vector<float> usual = plain.depths(Verb::store, {{0, 0}});
      const double scale = depth_scale(window);
      for (int y = 0; y < kSide; ++y) {
        for (int x = 0; x < kSide; ++x) {
          const float depth = depths[y * kSide + x];
          const bool touched = touches(corners, x * 256, y * 256);
          ASSERT_EQ(depth < 1, touched) << "round " << round << " pixel " << x << " " << y;
          plain_lacks += touched && usual[y * kSide + x] == 1;
          if (!touched) continue;
          EXPECT_GE(depth, 0.5 + low * scale - 0x1p-22);
          EXPECT_LE(depth, 0.5 + high * scale + 0x1p-22);
        }
      }
    }
    EXPECT_GT(plain_lacks, 0) << "the twin: samples at centres do not cover all of them";
  });
}

// ---- misuse ----

TEST(NativeCanvas, RefusesWhatItCannotDraw) {
  EXPECT_THROW(NativeCanvas(DepthMode::fragment, {}), std::logic_error);
  EXPECT_THROW(NativeCanvas(DepthMode::fixed, {}, {.depth_bits = 16}), Error);
  NativeCanvas canvas(DepthMode::fragment, obb_fattener().solid);
  EXPECT_THROW(canvas.run({}), std::logic_error);
  Drawables raw;
  raw.mode = DepthMode::fixed;
  EXPECT_THROW(canvas.begin(lab::window(64), raw), std::logic_error);
  NativeCanvas triangles(DepthMode::fixed, {});
  triangles.begin(lab::window(64), raw);
  EXPECT_THROW(triangles.samples(Verb::store, {}), std::logic_error);
}

}  // namespace
}  // namespace farcull
