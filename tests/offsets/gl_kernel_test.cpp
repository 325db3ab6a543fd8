// The kernels as the GL device runs them: what they answer is what the same text answers as C++,
// or where a normal was chosen in another way, an interval that holds the exact one too.
#include "offsets/offsets.h"
#include "tests/lab/gl.h"
#include "tests/lab/rational.h"
#include "verify/solid_lines.h"

namespace farcull {
namespace {

using minkowski_line::Answer, rational::Random;

constexpr int kSide = 256;

struct Cell {
  float cx, cy;
  Solid solid;
};

Cell random_cell(Random& random, int index, bool box) {
  const float cx = static_cast<float>(index % kSide) + 0.5f - kSide / 2;
  const float cy = static_cast<float>(index / kSide) + 0.5f - kSide / 2;
  const double size = std::abs(random.scaled(-8, 6));
  const double depth = random.below(4) == 0 ? std::abs(random.scaled(0, 30)) : size;
  const Vec3 at = Vec3(cx, cy, random.uniform(-200, 200)) +
                  Vec3(random.uniform(-1, 1), random.uniform(-1, 1), 0) * (0.7 + size);
  std::array<Vec3, 3> t;
  for (Vec3& p : t) p = at + random.cube(1).cwiseProduct(Vec3(size, size, depth));
  const int kind = random.below(8);
  if (kind == 0)  // needle
    t[2] = t[0] + random.uniform(0, 1) * (t[1] - t[0]) + random.scaled3(-40, -10);
  if (kind == 1) t[2] = t[1];                             // segment
  if (kind == 2) t[1] = t[2] = t[0];                      // point
  if (kind == 3) t[1] = Vec3(t[0][0], t[0][1], t[1][2]);  // vertical edge
  if (kind == 4) t[1][2] = t[2][2] = t[0][2];             // flat
  const double radius = random.below(8) == 0 ? 0 : 0.72;
  return {cx, cy, box ? obb_of(t, radius) : minkowski_solid(t[0], t[1], t[2], radius)};
}

/// A proxy that is its pixel, a little larger.
Proxy pixel_proxy(const Cell& cell) {
  const float x0 = cell.cx - 0.625f, x1 = cell.cx + 0.625f, y0 = cell.cy - 0.625f,
              y1 = cell.cy + 0.625f;
  return {{x0, y0, x1, y0, x1, y1, x0, y1}, cell.solid};
}

struct Comparison {
  std::vector<Cell> cells;
  std::vector<Answer> cpp, gl;
  long hits = 0, other_bits = 0, only_one = 0;
};

Comparison compare(const Fattener& fattener, const Fattener& reference, std::uint64_t seed) {
  Random random(seed);
  Comparison out;
  const bool box = fattener.name == "obb";
  Drawables drawables;
  std::vector<Draw> draws;
  for (int i = 0; i < kSide * kSide; ++i) {
    out.cells.push_back(random_cell(random, i, box));
    drawables.proxies.push_back(pixel_proxy(out.cells.back()));
    drawables.first.push_back(static_cast<std::uint32_t>(i + 1));
  }
  GlCanvas canvas(lab::context(), fattener.mode, fattener.solid);
  const Window window = lab::window(kSide, 0x1p31);
  canvas.begin(window, drawables);
  // Neighbouring proxies overlap, so that each surely covers its centre: never in the same draw.
  std::vector<float> entry(kSide * kSide), exit(kSide * kSide);
  for (int phase = 0; phase < 4; ++phase) {
    draws.clear();
    const auto mine = [phase](int i) { return (i % kSide % 2 + i / kSide % 2 * 2) == phase; };
    for (int i = 0; i < kSide * kSide; ++i)
      if (mine(i)) draws.push_back({static_cast<std::uint32_t>(i), 0});
    const std::vector<float> first = canvas.samples(Verb::store, draws);
    const std::vector<float> last = canvas.samples(Verb::ask, draws);
    for (int i = 0; i < kSide * kSide; ++i) {
      if (mine(i)) {
        entry[i] = first[i];
        exit[i] = last[i];
      }
    }
  }
  for (int i = 0; i < kSide * kSide; ++i) {
    const Cell& cell = out.cells[i];
    const Answer a = minkowski_line::answer(reference.solid.interval, cell.cx, cell.cy, cell.solid);
    const Answer b{!std::isnan(entry[i]), entry[i], exit[i]};
    EXPECT_EQ(std::isnan(entry[i]), std::isnan(exit[i])) << "pixel " << i;
    out.cpp.push_back(a);
    out.gl.push_back(b);
    out.hits += a.hit && b.hit;
    out.only_one += a.hit != b.hit;
    out.other_bits +=
        a.hit && b.hit &&
        (std::bit_cast<std::uint32_t>(a.entry) != std::bit_cast<std::uint32_t>(b.entry) ||
         std::bit_cast<std::uint32_t>(a.exit) != std::bit_cast<std::uint32_t>(b.exit));
  }
  std::printf("%s: %ld lines hit; %ld with other bits, %ld hit by only one of C++ and GL\n",
              fattener.name.c_str(), out.hits, out.other_bits, out.only_one);
  return out;
}

// Everything in the box's kernel is `precise`: on a device that rounds to nearest, the same bits.
TEST(GlKernel, BoxAnswersTheSameBitsAsCpp) {
  const Comparison found = compare(obb_fattener(), obb_fattener(), 801);
  EXPECT_GT(found.hits, kSide * kSide / 4);
  EXPECT_EQ(found.other_bits, 0);
  EXPECT_EQ(found.only_one, 0);
}

// The exact kernel's normals are chosen in plain float arithmetic, which a device may fuse: then
// both answers must hold the exact interval.
TEST(GlKernel, ExactHoldsTheExactIntervalWhereItsBitsDiffer) {
  const Comparison found = compare(minkowski_fattener(), minkowski_fattener(), 802);
  EXPECT_GT(found.hits, kSide * kSide / 4);
  EXPECT_LT(found.hits, kSide * kSide * 9 / 10);
  Random random(803);
  minkowski_line::Tally tally;
  for (std::size_t i = 0; i < found.cells.size(); ++i) {
    const Cell& cell = found.cells[i];
    const minkowski_line::Line line(cell.solid, cell.cx, cell.cy);
    for (const Answer& a : {found.cpp[i], found.gl[i]}) {
      check_contacts(line, cell.solid, cell.cx, cell.cy, a, tally);
      const double u = random.uniform(0, 1), v = random.uniform(0, 1);
      check(line, cell.solid, cell.cx, cell.cy,
            minkowski_line::weights(std::min(u, v), std::abs(u - v)), a, tally);
    }
  }
  EXPECT_EQ(tally.violations, 0) << "of " << tally.checks;
  EXPECT_GT(tally.checks, kSide * kSide);
}

// Two kernels that differ must be told apart: the box's program against a kernel whose widening is
// one float more.
TEST(GlKernel, OneFloatMoreIsSeen) {
  Fattener other = obb_fattener();
  other.solid.interval = [](float cx, float cy, const Solid& solid, float& entry, float& exit) {
    const bool hit = obb_fattener().solid.interval(cx, cy, solid, entry, exit);
    entry = std::nextafter(entry, -std::numeric_limits<float>::infinity());
    return hit;
  };
  const Comparison found = compare(obb_fattener(), other, 801);
  EXPECT_EQ(found.other_bits, found.hits);
}

// The exact kernel's program without its widening, on the device: the check above sees it.
TEST(GlKernel, ExactWithoutWideningLosesPointsOnTheDevice) {
  Fattener bare = minkowski_fattener();
  bare.solid.glsl = "#define FAR_WIDEN 0.0f\n" + bare.solid.glsl;
  const Comparison found = compare(bare, minkowski_fattener(), 802);
  minkowski_line::Tally tally;
  for (std::size_t i = 0; i < found.cells.size(); ++i) {
    const Cell& cell = found.cells[i];
    const minkowski_line::Line line(cell.solid, cell.cx, cell.cy);
    check_contacts(line, cell.solid, cell.cx, cell.cy, found.gl[i], tally);
  }
  EXPECT_GT(tally.violations, 1000);
  std::printf("%ld of %ld points lost\n", tally.violations, tally.checks);
}

}  // namespace
}  // namespace farcull
