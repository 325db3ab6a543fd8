// Parts that touch but for rounding, and the tolerance that calls them so. Twins overlap or are
// apart by more than the tolerance.
#include <Eigen/Geometry>

#include "experiments/method/clash.h"
#include "tests/lab/parts.h"

namespace farcull {
namespace {

using lab::Parts;
using enum ClashVerdict;

/// How the coordinates of walls are written.
struct Writing {
  const char* name;
  bool turned, single_precision;
  double far;  // added to x and y
  double tolerance;
};

/// Pairs of walls that are flush in decimals of two digits, each 10 high, at other heights. The
/// second wall of each is moved by `shift`, away from the first.
Scene flush_walls(const Writing& how, double shift, int pairs) {
  Parts parts;
  RandomNumbers random(1);
  const auto rounded = [&](double x) {
    return how.single_precision ? double(static_cast<float>(x)) : x;
  };
  for (int k = 0; k < pairs; ++k) {
    const int first = 5 + random.below(60), second = 5 + random.below(60);
    const int middle = random.below(1000) - 500;
    const double a = how.far + middle / 100.0, b = how.far + (2 * middle + first + second) / 200.0;
    const auto wall = [&](const char* name, double at, int thick, double more, double length) {
      const double half = rounded(thick / 100.0) / 2;
      parts.add_box(name + std::to_string(k),
                    {rounded(rounded(at) - half) + more, how.far - length, 20.0 * k},
                    {rounded(rounded(at) + half) + more, how.far + length, 20.0 * k + 10});
    };
    wall("a", a, first, 0, 5);
    wall("b", b, second, shift, k % 3 == 0 ? 5 : 4);
  }
  const Eigen::AngleAxisd turn(0.7, Vec3(1, 2, 3).normalized());
  for (Vec3& p : parts.scene.vertices) {
    if (how.turned) p = turn * p;
    p = {rounded(p.x()), rounded(p.y()), rounded(p.z())};
  }
  return parts.scene;
}

TEST(ClashTolerance, OfFlushWallsIsThatOfTheirRounding) {
  for (const Writing& how :
       {Writing{"plain", false, false, 0, 1e-8}, Writing{"turned", true, false, 0, 1e-8},
        Writing{"far", false, false, 1e6, 1e-8}, Writing{"far and turned", true, false, 1e5, 1e-8},
        Writing{"single", false, true, 0, 4e-6}}) {
    SCOPED_TRACE(how.name);
    const double tolerance = how.tolerance;
    const auto record_of = [&](double shift, double allowed, int pairs = 300) {
      return clashes(flush_walls(how, shift, pairs), {.tolerance = allowed});
    };
    // Exactly, some clash and some are apart.
    const ClashRecord exact = record_of(0, 0);
    EXPECT_GT(exact.count(clash), 20u);
    EXPECT_LT(exact.count(clash) + exact.count(touch), 280u);
    EXPECT_EQ(exact.within_tolerance, 0u);
    const ClashRecord allowed = record_of(0, tolerance);
    ASSERT_EQ(allowed.count(touch), 300u);
    EXPECT_EQ(allowed.count(clash), 0u);
    EXPECT_EQ(allowed.within_tolerance, 300 - exact.count(touch));
    for (const ClashRow& row : allowed.rows) {
      const auto at = std::ranges::find(exact.rows, row.objects, &ClashRow::objects);
      EXPECT_EQ(row.exact, at == exact.rows.end() ? clear : at->verdict);
      EXPECT_EQ(row.depth.has_value(), row.exact == clash);
      if (row.depth) {
        EXPECT_LE(row.depth->hi, tolerance);
        EXPECT_LE(row.depth->translation.norm(), row.depth->hi);
      }
      EXPECT_EQ(row.squared.has_value(), row.exact == clear);
    }
    EXPECT_EQ(record_of(-0.5 * tolerance, tolerance, 60).count(touch), 60u);
    // The twins.
    EXPECT_EQ(record_of(-2 * tolerance, tolerance, 60).count(clash), 60u);
    EXPECT_EQ(record_of(2 * tolerance, tolerance).rows.size(), 0u);
  }
}

// Of parts so small the depth has no lower bound but 0. The upper one decides.
TEST(ClashTolerance, IsComparedWithTheUpperBoundOfTheDepth) {
  const double unit = 1e-80;
  Parts parts;
  parts.add_box("a", Vec3(0, 0, 0), Vec3(1, 1, 1) * unit);
  parts.add_box("b", Vec3(0.7, -0.2, -0.3) * unit, Vec3(2, 1.2, 1.5) * unit);
  const ClashRecord deep = clashes(parts.scene, {.tolerance = 0.2 * unit, .depth = true});
  ASSERT_EQ(deep.count(clash), 1u);
  EXPECT_EQ(deep.rows[0].depth->lo, 0);
  const ClashRecord allowed = clashes(parts.scene, {.tolerance = 0.31 * unit});
  EXPECT_EQ(allowed.count(touch), 1u);
  EXPECT_EQ(allowed.rows[0].exact, clash);
}

TEST(ClashTolerance, OfAGapIsExact) {
  for (const bool above : {false, true}) {
    Parts parts;
    parts.add_box("a", {0, 0, 0}, {1, 1, 1});
    parts.add_box("b", {3, 0, 0}, {4, 1, 1});
    const double tolerance = above ? 2 : std::nextafter(2.0, 0);
    EXPECT_EQ(clashes(parts.scene, {.tolerance = tolerance}).count(touch), above ? 1u : 0u);
    const ClashRow row = clashes(parts.scene, {.clearance = 5, .tolerance = tolerance}).rows[0];
    EXPECT_EQ(row.verdict, above ? touch : near);
    EXPECT_EQ(row.exact, near);
    EXPECT_EQ(row.distance, 2);
  }
}

// A part in the corner of another one, too far in by `in` on two sides: no plane divides them.
Scene in_a_corner(double in) {
  Parts parts;
  const std::uint32_t first = parts.next();
  const std::array<std::array<double, 2>, 6> corners = {
      {{0, 0}, {10, 0}, {10, 3}, {3, 3}, {3, 10}, {0, 10}}};
  for (const double z : {0.0, 10.0}) {
    for (const auto& [x, y] : corners) parts.vertex(x, y, z);
  }
  for (std::uint32_t i = 0; i < 6; ++i) {
    const std::uint32_t j = (i + 1) % 6;
    parts.quad(first, {i, j, 6 + j, 6 + i});
  }
  for (const std::array<std::uint32_t, 4>& q : {std::array{0u, 1u, 2u, 3u}, {0u, 3u, 4u, 5u}}) {
    parts.quad(first, {q[3], q[2], q[1], q[0]});
    parts.quad(first, {q[0] + 6, q[1] + 6, q[2] + 6, q[3] + 6});
  }
  parts.end("corner");
  parts.add_box("cupboard", {3 - in, 3 - in, 1}, {8, 8, 9});
  return parts.scene;
}

TEST(ClashTolerance, AppliesWhereNoPlaneDividesTheParts) {
  for (const double in : {1e-15, 1e-10, 0.01}) {
    const Scene scene = in_a_corner(in);
    ASSERT_EQ(clashes(scene, {}).count(clash), 1u);
    // Out of the corner: the diagonal, which is the square root of 2 times `in`.
    EXPECT_EQ(clashes(scene, {.tolerance = 1.6 * in + 1e-12}).count(touch), 1u) << in;
    EXPECT_EQ(clashes(scene, {.tolerance = 1.4 * in}).count(clash), 1u) << in;
  }
}

TEST(ClashTolerance, IsNoExcuseForWhatIsInsideOrCrosses) {
  const double thin = 1e-9;
  for (const double depth : {5.0, thin}) {
    Parts parts;
    parts.add_box("block", {0, 0, 0}, {10, 10, 10});
    parts.add_box("foil", {1, 1, 10 - depth - thin}, {9, 9, 10 - depth});
    const ClashRecord record = clashes(parts.scene, {.tolerance = 1e-8});
    EXPECT_EQ(record.rows.at(0).verdict, depth > 1 ? contained : touch);
    EXPECT_EQ(record.rows[0].exact, contained);
  }
  Parts through;
  through.add_box("block", {0, 0, 0}, {10, 10, 10});
  through.add_box("foil", {-1, -1, 5}, {11, 11, 5 + thin});
  EXPECT_EQ(clashes(through.scene, {.tolerance = 1e-8}).count(clash), 1u);
  // Near a wall from inside: neither touch nor near.
  Parts inside;
  inside.add_box("block", {0, 0, 0}, {10, 10, 10});
  inside.add_box("a", {1, 1, thin}, {2, 2, 2});
  EXPECT_EQ(clashes(inside.scene, {.tolerance = 1e-8}).count(contained), 1u);
  Parts open;
  open.box({0, 0, 0}, {10, 10, 10}, false, true);
  open.end("tray");
  open.add_box("a", {1, 1, thin}, {2, 2, 2});
  open.add_box("through", {8, 8, -thin}, {9, 9, 2});
  const ClashRecord record = clashes(open.scene, {.tolerance = 1e-8});
  EXPECT_EQ(record.count(unknown), 1u);
  EXPECT_EQ(record.count(clash), 1u);
  EXPECT_EQ(record.rows[0].open, 0u) << "which is why there is no depth";
}

TEST(ClashTolerance, IsADistance) {
  Parts parts;
  parts.add_box("a", {0, 0, 0}, {1, 1, 1});
  parts.add_box("b", {3, 0, 0}, {4, 1, 1});
  for (const double bad : {-1.0, std::nan(""), HUGE_VAL})
    EXPECT_THROW(clashes(parts.scene, {.tolerance = bad}), Error);
}

TEST(Clash, OfChosenPairsIsAboutThemAlone) {
  Parts parts;
  parts.add_box("a", {0, 0, 0}, {2, 2, 2});
  parts.add_box("b", {1, 1, 1}, {3, 3, 3});
  parts.add_box("c", {1, 0, 0}, {3, 2, 2});
  parts.end("empty");
  const ClashRecord record =
      clashes(parts.scene, {.ignored = {{1, 2}}, .only = {{{0, 1}, {1, 2}, {2, 3}}}});
  EXPECT_EQ(record.asked, 2u);
  EXPECT_EQ(record.examined, 1u);
  EXPECT_EQ(record.ignored, 1u);
  ASSERT_EQ(record.rows.size(), 2u);
  EXPECT_EQ(record.rows[0].objects, (ObjectPair{0, 1}));
  EXPECT_TRUE(record.rows[1].ignored);
  EXPECT_EQ(record.triangle_pairs, record.rows[0].pairs + record.rows[1].pairs);
}

TEST(Clash, NotesCopiesAndSizes) {
  Parts parts;
  parts.add_box("a", {0.1, 0, 0}, {1, 1, 1});
  parts.add_box("b", {5, 0, 0}, {6, 1, 1});
  parts.add_box("as floats", {0.1f, 0, 0}, {1, 1, 1});
  const ClashRecord record = clashes(parts.scene, {});
  EXPECT_EQ(record.copies, (std::vector<ObjectPair>{{0, 2}}));
  EXPECT_FALSE(record.sizes);
  parts.add_box("in mm", {50, 0, 0}, {1050, 1000, 1000});
  const ClashRecord mixed = clashes(parts.scene, {});
  ASSERT_TRUE(mixed.sizes);
  EXPECT_EQ(mixed.sizes->b, 3u);
}

}  // namespace
}  // namespace farcull
