// The reliability lemmas as properties of the real rasterizer (docs/reliability.md), each with a twin that must fail.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "offsets/obb.h"
#include "tests/core/gl_lab.h"
#include "verify/exact.h"

namespace farcull {
namespace {

using lab::Random;

constexpr std::uint64_t kSeed = 20040711;

// What fails at a point Q: a pixel that contains it got no sample, or samples that do not bound its depth.
struct Failures {
  int points = 0;
  int no_sample = 0;
  int not_bounding = 0;
  int all() const { return no_sample + not_bounding; }
};

// Pixel indices, from 0 at the window's left, whose closed interval contains x; -1 for none.
std::pair<int, int> pixels_containing(double x, int side) {
  const double at = x + 0.5 * side;
  const int upper = static_cast<int>(std::floor(at));
  const int lower = at == std::floor(at) ? upper - 1 : upper;
  return {std::max(lower, 0), std::min(upper, side - 1)};
}

// Checks the samples of every pixel that contains q (all coordinates floats) against its depth.
void check_point(const Window& w, const std::vector<float>& entries, const std::vector<float>& exits, const Vec3& q,
                 Failures& f) {
  const auto [x0, x1] = pixels_containing(q[0], w.width);
  const auto [y0, y1] = pixels_containing(q[1], w.height);
  for (int y = y0; y <= y1; ++y) {
    for (int x = x0; x <= x1; ++x) {
      const std::size_t at = static_cast<std::size_t>(y) * w.width + x;
      ++f.points;
      if (std::isnan(entries[at]) || std::isnan(exits[at])) {
        ++f.no_sample;
      } else if (!(entries[at] <= q[2] && q[2] <= exits[at])) {
        ++f.not_bounding;
      }
    }
  }
}

std::vector<Draw> all_elements(const Drawables& drawables) {
  std::vector<Draw> draws;
  for (std::uint32_t e = 0; e < drawables.elements(); ++e) draws.push_back({e, 0});
  return draws;
}

// Points one to a cell of 6 px, so that their solids do not share pixels, each the middle of a short segment at 45
// degrees in the image: its box then has a face a radius away from Q in the direction of the pixel's corner.
struct CornerPoints {
  std::vector<Vec3> points;
  std::vector<Patch> patches;

  CornerPoints(const Window& w, double spread, Random& random) {
    for (int y = -w.height / 2 + 3; y < w.height / 2 - 3; y += 6) {
      for (int x = -w.width / 2 + 3; x < w.width / 2 - 3; x += 6) {
        const Vec3 q(static_cast<float>(x + random.between(-spread, spread)),
                     static_cast<float>(y + random.between(-spread, spread)), random.grid(-200, 200, 0x1p-8));
        const Vec3 half(0x1p-12 * random.sign(), 0x1p-12 * random.sign(), 0);
        points.push_back(q);
        patches.push_back(lab::patch({q - half, q + half, q + half}));
      }
    }
  }
};

Failures lemma1(double factor, bool published, double spread) {
  const Window w = lab::window(512);
  const Fattener fattener = obb_fattener();
  GlCanvas canvas(lab::context(), fattener.mode, fattener.solid);
  const double radius = published ? published_radius(depth_step(w, 32)) : factor * lab::budget_radius(canvas, w);
  Random random(kSeed);
  Failures failures;
  for (int round = 0; round < 4; ++round) {
    const CornerPoints corner(w, spread, random);
    const Drawables drawables = lab::fattened(w, fattener, radius, corner.patches);
    canvas.begin(w, drawables);
    const std::vector<float> entries = canvas.samples(Verb::store, all_elements(drawables));
    const std::vector<float> exits = canvas.samples(Verb::ask, all_elements(drawables));
    for (const Vec3& q : corner.points) check_point(w, entries, exits, q, failures);
  }
  return failures;
}

TEST(GlLemma, Lemma1HoldsNearPixelCornersAtTheBudgetRadius) {
  for (const double spread : {0.0, 1e-6, 1e-3, 0.1, 0.5}) {
    SCOPED_TRACE(spread);
    const Failures f = lemma1(1, false, spread);
    EXPECT_GE(f.points, 27'000);
    EXPECT_EQ(f.no_sample, 0);
    EXPECT_EQ(f.not_bounding, 0);
  }
}

TEST(GlLemma, Lemma1FailsAtNineTenthsOfTheBudget) {
  const Failures f = lemma1(0.9, false, 1e-3);
  EXPECT_GT(f.no_sample, f.points / 2) << f.no_sample << " of " << f.points;
}

TEST(GlLemma, Lemma1FailsAtThePublishedRadiusNearPixelCorners) {
  const Failures f = lemma1(1, true, 1e-3);
  RecordProperty("violations", f.all());
  RecordProperty("points", f.points);
  EXPECT_GT(f.no_sample, f.points / 20) << f.no_sample << " of " << f.points;
}

// Triangles with corners on a grid of 2^-8 px and points at barycentric weights k / 64: points are exactly on their
// triangle, and floats.
struct GridTriangle {
  std::array<Vec3, 3> corners;
  std::vector<Vec3> points;
};

Vec3 grid_point(Random& random, double reach) {
  return {random.grid(-reach, reach, 0x1p-8), random.grid(-reach, reach, 0x1p-8), random.grid(-reach, reach, 0x1p-8)};
}

GridTriangle grid_triangle(Random& random) {
  GridTriangle t;
  const double reach = std::exp2(random.between(-6, 4.6));  // up to 24 px
  const int kind = random.below(6);
  for (Vec3& c : t.corners) c = grid_point(random, reach);
  if (kind == 1) t.corners[1] = t.corners[0] + Vec3(0x1p-8, 0, 0);           // a sliver
  if (kind == 2) t.corners[2] = t.corners[1];                                // a segment
  if (kind == 3) t.corners[2] = t.corners[1] = t.corners[0];                 // a point
  if (kind == 4) t.corners[2] = t.corners[1] + Vec3(0, 0, 0x1p-8 * 1000);    // steep: all but end-on
  if (kind == 5) {                                                           // edge-on: contains the view direction
    t.corners[2] = t.corners[0];
    t.corners[2][2] += 20;
  }
  for (int i = 0; i < 40; ++i) {
    const int a = random.below(65), b = random.below(65 - a);
    t.points.push_back((a * t.corners[0] + b * t.corners[1] + (64 - a - b) * t.corners[2]) / 64.0);
  }
  for (const Vec3& c : t.corners) t.points.push_back(c);
  return t;
}

Failures lemma2(double factor) {
  const Window w = lab::window(768, 128);
  const Fattener fattener = obb_fattener();
  GlCanvas canvas(lab::context(), fattener.mode, fattener.solid);
  const double radius = factor * lab::budget_radius(canvas, w);
  Random random(kSeed);
  Failures failures;
  for (int round = 0; round < 60; ++round) {
    // A triangle to a cell of 128 px: its box, at most 48 * sqrt(3) px across, stays inside.
    std::vector<GridTriangle> triangles;
    std::vector<Patch> patches;
    for (int cell = 0; cell < 36; ++cell) {
      GridTriangle t = grid_triangle(random);
      const Vec3 centre(128 * (cell % 6) - 320, 128 * (cell / 6) - 320, 0);
      for (Vec3& c : t.corners) c += centre;
      for (Vec3& p : t.points) p += centre;
      patches.push_back(lab::patch({t.corners[0], t.corners[1], t.corners[2]}));
      triangles.push_back(std::move(t));
    }
    const Drawables drawables = lab::fattened(w, fattener, radius, patches);
    canvas.begin(w, drawables);
    const std::vector<float> entries = canvas.samples(Verb::store, all_elements(drawables));
    const std::vector<float> exits = canvas.samples(Verb::ask, all_elements(drawables));
    for (const GridTriangle& t : triangles) {
      for (const Vec3& q : t.points) check_point(w, entries, exits, q, failures);
    }
  }
  return failures;
}

TEST(GlLemma, Lemma2SamplesBoundEveryPointOfATriangle) {
  const Failures f = lemma2(1);
  EXPECT_GE(f.points, 80'000);
  EXPECT_EQ(f.no_sample, 0);
  EXPECT_EQ(f.not_bounding, 0);
}

TEST(GlLemma, Lemma2FailsWithoutARadius) {
  const Failures f = lemma2(0);
  EXPECT_GT(f.no_sample, f.points / 20) << f.no_sample << " of " << f.points;
}

// Pairs of triangles, one pair to a cell of `cell` px: store the first of each, ask the second; and the other way round.
struct Pairs {
  std::vector<std::array<Vec3, 3>> first, second;
};

struct Seen {
  std::vector<std::uint8_t> forward, backward;
};

Seen ask_pairs(const Pairs& pairs, const Window& w, double factor, const GlCanvasOptions& options) {
  const Fattener fattener = obb_fattener();
  GlCanvas canvas(lab::context(), fattener.mode, fattener.solid, options);
  const double radius = factor * lab::budget_radius(canvas, w);
  std::vector<Patch> patches;
  for (const auto* side : {&pairs.first, &pairs.second}) {
    for (const auto& t : *side) patches.push_back(lab::patch({t[0], t[1], t[2]}));
  }
  const Drawables drawables = lab::fattened(w, fattener, radius, patches);
  canvas.begin(w, drawables);
  const auto n = static_cast<std::uint32_t>(pairs.first.size());
  const auto pass = [&](std::uint32_t stored, std::uint32_t asked) {
    Pass p;
    p.slots = n;
    for (std::uint32_t i = 0; i < n; ++i) lab::add(p.draws, drawables, stored + i, 0);
    for (std::uint32_t i = 0; i < n; ++i) lab::add(p.draws, drawables, asked + i, i);
    p.steps = {{Verb::store, 0, n}, {Verb::ask, n, n}};
    return p;
  };
  return {canvas.run(pass(0, n)), canvas.run(pass(n, 0))};
}

// Pairs that share an exact point: inside both, on edges, at corners; in cells of 96 px, at random offsets that include
// pixel corners and centres.
Pairs touching_pairs(Random& random, int per_side) {
  Pairs pairs;
  for (int cell = 0; cell < per_side * per_side; ++cell) {
    const double half = 0.5 * per_side;
    Vec3 centre(96 * (cell % per_side - half) + 48, 96 * (cell / per_side - half) + 48, 0);
    if (random.below(2)) centre += 0.5 * Vec3(random.below(2), random.below(2), 0);
    if (random.below(2)) centre += Vec3(random.grid(-1, 1, 0x1p-8), random.grid(-1, 1, 0x1p-8), random.grid(-9, 9, 0x1p-8));
    std::array<std::array<Vec3, 3>, 2> pair;
    for (auto& t : pair) {
      const double reach = std::exp2(random.between(-7, 3.5));
      const int kind = random.below(4);
      const Vec3 a = grid_point(random, reach), b = grid_point(random, reach);
      // The shared point, here the origin, as a combination of the corners with exact weights.
      if (kind == 0) t = {a, b, -(a + b)};                    // the centroid
      if (kind == 1) t = {a, -a, b};                          // on an edge
      if (kind == 2) t = {Vec3::Zero(), a, b};                // a corner
      if (kind == 3) t = {a, -a, -a};                         // a segment through it
      for (Vec3& c : t) c += centre;
    }
    pairs.first.push_back(pair[0]);
    pairs.second.push_back(pair[1]);
  }
  return pairs;
}

int count_unseen(const std::vector<std::uint8_t>& seen) {
  return static_cast<int>(std::count(seen.begin(), seen.end(), 0));
}

TEST(GlLemma, Theorem1IntersectingTrianglesSeeEachOther) {
  Random random(kSeed);
  const Window w = lab::window(960, 64);
  for (int round = 0; round < 40; ++round) {
    const Pairs pairs = touching_pairs(random, 10);
    for (std::size_t i = 0; i < pairs.first.size(); ++i) ASSERT_TRUE(intersects(pairs.first[i], pairs.second[i]));
    for (const GlCanvasOptions& options :
         {GlCanvasOptions{}, GlCanvasOptions{.query = QueryMode::occlusion},
          GlCanvasOptions{.depth_format = DepthFormat::fixed24, .query = QueryMode::occlusion}}) {
      const Seen seen = ask_pairs(pairs, w, 1, options);
      EXPECT_EQ(count_unseen(seen.forward), 0) << "round " << round;
      EXPECT_EQ(count_unseen(seen.backward), 0) << "round " << round;
    }
  }
}

TEST(GlLemma, Theorem1FailsWithoutARadius) {
  Random random(kSeed);
  const Window w = lab::window(960, 64);
  int unseen = 0;
  for (int round = 0; round < 4; ++round) {
    const Seen seen = ask_pairs(touching_pairs(random, 10), w, 0, {});
    unseen += count_unseen(seen.forward) + count_unseen(seen.backward);
  }
  EXPECT_GT(unseen, 100);
}

// Two segments that cross at 45 degrees close to a pixel's corner.
Pairs corner_pairs(Random& random, const Window& w) {
  Pairs pairs;
  for (int y = -w.height / 2 + 3; y < w.height / 2 - 3; y += 6) {
    for (int x = -w.width / 2 + 3; x < w.width / 2 - 3; x += 6) {
      const Vec3 q(x + random.grid(-0x1p-10, 0x1p-10, 0x1p-14), y + random.grid(-0x1p-10, 0x1p-10, 0x1p-14),
                   random.grid(-50, 50, 0x1p-8));
      const Vec3 u(0x1p-12, 0x1p-12, 0), v(0x1p-12, -0x1p-12, 0);
      pairs.first.push_back({q - u, q + u, q + u});
      pairs.second.push_back({q - v, q + v, q + v});
    }
  }
  return pairs;
}

TEST(GlLemma, Theorem1HoldsNearPixelCornersAndFailsAtNineTenths) {
  Random random(kSeed);
  const Window w = lab::window(512, 64);
  const Pairs pairs = corner_pairs(random, w);
  const Seen seen = ask_pairs(pairs, w, 1, {});
  EXPECT_EQ(count_unseen(seen.forward) + count_unseen(seen.backward), 0);
  const Seen twin = ask_pairs(pairs, w, 0.9, {});
  EXPECT_GT(count_unseen(twin.forward), static_cast<int>(pairs.first.size()) / 2);
}

TEST(GlLemma, Corollary1UnseenMeansDisjoint) {
  Random random(kSeed);
  const Window w = lab::window(960, 64);
  int unseen = 0, intersecting = 0;
  for (int round = 0; round < 60; ++round) {
    Pairs pairs;
    for (int cell = 0; cell < 100; ++cell) {
      const Vec3 centre(96 * (cell % 10) - 432, 96 * (cell / 10) - 432, 0);
      const double reach = std::exp2(random.between(-4, 4));
      std::array<std::array<Vec3, 3>, 2> pair;
      for (auto& t : pair) {
        for (Vec3& c : t) c = centre + grid_point(random, reach);
      }
      pairs.first.push_back(pair[0]);
      pairs.second.push_back(pair[1]);
    }
    const Seen seen = ask_pairs(pairs, w, 1, {});
    for (std::size_t i = 0; i < pairs.first.size(); ++i) {
      const bool meet = intersects(pairs.first[i], pairs.second[i]);
      intersecting += meet;
      for (const auto& answers : {seen.forward, seen.backward}) {
        unseen += !answers[i];
        EXPECT_FALSE(meet && !answers[i]) << "round " << round << ", pair " << i;
      }
    }
  }
  EXPECT_GT(unseen, 1000) << "a canvas that sees everything would pass";
  EXPECT_GT(intersecting, 500) << "the generator makes too few intersecting pairs to find a miss";
}

}  // namespace
}  // namespace farcull
