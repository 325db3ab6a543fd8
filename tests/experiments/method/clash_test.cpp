// Which parts clash: assemblies whose answer is known, and solids of unit cubes, of which integers
// tell.
#include "experiments/method/clash.h"

#include <Eigen/Geometry>

#include "experiments/scenes/builtin/scenes.h"
#include "tests/lab/assembly.h"

namespace farcull {
namespace {

using lab::Assembly, lab::Parts;
using enum ClashVerdict;

/// The verdict of each pair that is not clear.
std::map<ObjectPair, ClashVerdict> verdicts(const ClashRecord& record) {
  std::map<ObjectPair, ClashVerdict> out;
  for (const ClashRow& row : record.rows) out[row.objects] = row.verdict;
  return out;
}

const ClashRow& row_of(const ClashRecord& record, std::uint32_t a, std::uint32_t b) {
  const auto at = std::ranges::find(record.rows, ObjectPair{a, b}, &ClashRow::objects);
  if (at == record.rows.end()) throw std::logic_error("no such row");
  return *at;
}

TEST(Clash, OfAnAssemblyIsKnown) {
  const Assembly assembly;
  const Scene& scene = assembly.parts.scene;
  ASSERT_EQ(scene.objects.size(), 31u);
  const ClashRecord record = clashes(scene, {.clearance = 2, .depth = true});
  EXPECT_EQ(verdicts(record), assembly.expected);
  EXPECT_EQ(record.asked, 465u);
  EXPECT_EQ(record.examined, 465u);
  EXPECT_EQ(record.count(clash), 17u);
  EXPECT_EQ(record.count(contained), 1u);
  EXPECT_EQ(record.count(unknown), 2u);
  EXPECT_EQ(record.count(touch), 10u);
  EXPECT_EQ(record.count(near), 10u);
  EXPECT_EQ(record.count(clear), 425u);
  for (const auto& [objects, distance] : assembly.distances)
    EXPECT_EQ(row_of(record, objects.a, objects.b).distance, distance);
  for (const auto& [objects, depth] : assembly.depths) {
    const ClashRow& row = row_of(record, objects.a, objects.b);
    ASSERT_TRUE(row.depth) << objects.a << " " << objects.b;
    EXPECT_LE(row.depth->lo, depth);
    EXPECT_GE(row.depth->hi, depth);
    EXPECT_LT(row.depth->hi, row.depth->lo * 1.1);
  }
  // A bolt of 4 x 4 crosses two faces of a plate, in 16 each.
  EXPECT_NEAR(row_of(record, 0, 2).curve, 32, 1e-9);
  EXPECT_EQ(row_of(record, 18, 19).inner, 19u);
  for (std::size_t k = 1; k < record.rows.size(); ++k)
    EXPECT_LE(record.rows[k - 1].verdict, record.rows[k].verdict);
  // The twins: the clearance decides about the gap of 2, and the last gap is beyond it.
  EXPECT_EQ(clashes(scene, {.clearance = std::nextafter(2.0, 0)}).count(near), 9u);
  EXPECT_EQ(clashes(scene, {.clearance = 2.0000002}).count(near), 11u);
  EXPECT_EQ(clashes(scene, {}).count(near), 0u);
}

// Solids of unit cubes. Inside, touching and distances are those of the cubes.
TEST(Clash, OfSolidsOfCubesIsKnown) {
  RandomNumbers random(test_seed(6));
  std::set<ClashVerdict> seen;  // clash, contained, touch, near and clear
  for (int k = 0; more_cases(k, trials(80), seen.size() == 5); ++k) {
    std::array<std::set<std::array<int, 3>>, 2> cubes;
    const int first = 1 + random.below(8), second = 1 + random.below(8);
    if (random.below(4) == 0) {  // all of a block but its middle, or the block
      for (int i = 0; i < 27; ++i) cubes[0].insert({i % 3, i / 3 % 3, i / 9});
      if (random.below(2) == 0) cubes[0].erase({1, 1, 1});
      cubes[1].insert({1, 1, 1});
      if (random.below(2) == 0) cubes[1].insert({random.below(9), random.below(3), 1});
    } else {
      for (int i = 0; i < first; ++i)
        cubes[0].insert({random.below(3), random.below(3), random.below(3)});
      const int shift = random.below(5);
      for (int i = 0; i < second; ++i)
        cubes[1].insert({shift + random.below(3), random.below(3), random.below(3)});
    }
    bool common = false;
    long least = LONG_MAX;
    for (const auto& p : cubes[0]) {
      for (const auto& q : cubes[1]) {
        long squared = 0;
        for (int axis = 0; axis < 3; ++axis) {
          const long gap = std::max(std::abs(p[axis] - q[axis]) - 1, 0);
          squared += gap * gap;
        }
        least = std::min(least, squared);
        common = common || p == q;
      }
    }
    Parts parts;
    parts.add_cubes("a", cubes[0], random);
    parts.add_cubes("b", cubes[1], random);
    const ClashRecord record = clashes(parts.scene, {.clearance = 1});
    const ClashVerdict verdict = record.rows.empty() ? clear : record.rows[0].verdict;
    seen.insert(verdict);
    if (common) {
      ASSERT_LE(verdict, contained) << k;
    } else if (least == 0) {
      ASSERT_EQ(verdict, touch) << k;
    } else if (least == 1) {
      ASSERT_EQ(verdict, near) << k;
      EXPECT_EQ(record.rows[0].distance, 1);
    } else {
      ASSERT_EQ(verdict, clear) << k;
    }
  }
}

// A peg in the wall of a box with a cavity, and through it. The middle of what they share has the
// diagonals of faces in front of it, where rays meet edges. Some are turned, so that planes are
// planes but for rounding.
TEST(Clash, DepthOfAPegInAWallIsFound) {
  for (const double depth : {0.01, 1.0, 10.0}) {
    for (const Vec3& axis : {Vec3(0, 0, 0), Vec3(0, 0, 1), Vec3(1, 2, 3)}) {
      Parts parts;
      parts.box({0, 0, 0}, {100, 60, 40});
      parts.box({5, 5, 5}, {95, 55, 35}, true);
      parts.end("wall");
      parts.add_box("peg", {100 - depth, 20, 10}, {135, 30, 20});
      const Eigen::AngleAxisd turn(M_PI / 6, axis.normalized());
      for (Vec3& p : parts.scene.vertices) p = axis.isZero() ? p : turn * p;
      EXPECT_FALSE(clashes(parts.scene, {}).rows.at(0).depth) << "not asked for";
      const ClashRecord record = clashes(parts.scene, {.depth = true});
      ASSERT_EQ(record.trace.back().kind, StageKind::depth);
      ASSERT_EQ(record.rows.size(), 1u);
      ASSERT_TRUE(record.rows[0].depth);
      EXPECT_GT(record.rows[0].depth->lo, 0.99 * depth);
      EXPECT_LT(record.rows[0].depth->hi, 1.01 * depth);
    }
  }
}

TEST(Clash, PiecesOfAPartInsideAnotherAreFound) {
  Parts parts;
  parts.add_box("a", {0, 0, 0}, {10, 10, 10});
  parts.box({20, 0, 0}, {30, 10, 10});
  parts.box({4, 4, 4}, {5, 5, 5});
  parts.end("b");  // one of its two pieces is inside a
  const ClashRecord record = clashes(parts.scene, {});
  EXPECT_EQ(verdicts(record), (std::map<ObjectPair, ClashVerdict>{{{0, 1}, contained}}));
  EXPECT_EQ(record.rows[0].inner, 1u);
}

TEST(Clash, WhatIsNotExaminedIsNamed) {
  Parts parts;
  parts.add_box("a", {0, 0, 0}, {1, 1, 1});
  parts.end("empty");
  parts.add_box("b", {5, 0, 0}, {6, 1, 1});
  const ClashRecord record = clashes(parts.scene, {});
  EXPECT_EQ(record.asked, 3u);
  EXPECT_EQ(record.examined, 1u);
  EXPECT_EQ(record.empty, std::vector<std::uint32_t>{1});
  parts.scene.objects.pop_back();
  parts.scene.objects.pop_back();
  parts.scene.triangles.resize(12);
  parts.scene.source_face.resize(12);
  EXPECT_THROW(clashes(parts.scene, {}), Error);  // one part
}

TEST(Clash, IgnoredPairsThatMeetAreListedApart) {
  Parts parts;
  parts.add_box("a", {0, 0, 0}, {2, 2, 2});
  parts.add_box("b", {1, 1, 1}, {3, 3, 3});
  parts.add_box("c", {9, 9, 9}, {10, 10, 10});
  const ClashRecord record = clashes(parts.scene, {.ignored = {{0, 1}, {0, 2}}});
  EXPECT_EQ(record.asked, 1u);
  EXPECT_EQ(record.examined, 1u);
  EXPECT_EQ(record.ignored, 2u);
  EXPECT_EQ(record.ignored_meet, 1u);
  EXPECT_EQ(record.count(clash), 0u);
  ASSERT_EQ(record.rows.size(), 1u);
  EXPECT_TRUE(record.rows[0].ignored);
  EXPECT_EQ(record.rows[0].verdict, clash);
}

// A file may have both sides of each face. Then no winding number tells what is inside.
TEST(Clash, WhatIsInABoxWithBothSidesOfEachFaceIsUnknown) {
  const auto boxes = [](bool both_sides, const Vec3& lo, bool turned = true) {
    Parts parts;
    parts.box({0, 0, 0}, {10, 10, 10});
    for (std::uint32_t t = 0; both_sides && t < 12; ++t) {
      const auto [a, b, c] = parts.scene.triangles[t];
      turned ? parts.triangle(a, c, b) : parts.triangle(a, b, c);
    }
    parts.end("outer");
    parts.add_box("inner", lo, lo + Vec3(2, 2, 2));
    return clashes(parts.scene, {});
  };
  EXPECT_EQ(boxes(false, {4, 4, 4}).count(contained), 1u);  // the twin
  EXPECT_EQ(boxes(true, {4, 4, 4}).count(unknown), 1u);
  EXPECT_EQ(boxes(true, {4, 4, 4}, false).count(unknown), 1u);
  EXPECT_EQ(boxes(true, {40, 4, 4}).count(clear), 1u);
  const ClashRecord standing = boxes(true, {4, 4, 0});
  EXPECT_EQ(standing.count(clash), 1u);
  EXPECT_FALSE(standing.rows[0].proved);
}

// The other side of each face has the other diagonal, so that no triangle is there twice.
TEST(Clash, BothSidesOfAFaceMayBeCutOtherwise) {
  for (const double z : {4, 0}) {
    Parts parts;
    parts.box({0, 0, 0}, {10, 10, 10});
    for (std::uint32_t t = 0; t < 12; t += 2) {
      const auto [a, b, c] = parts.scene.triangles[t];
      parts.quad(0, {parts.scene.triangles[t + 1][2], c, b, a});
    }
    parts.end("outer");
    parts.add_box("inner", {4, 4, z}, {6, 6, z + 2});
    const ClashRecord record = clashes(parts.scene, {});
    EXPECT_EQ(record.count(z > 0 ? unknown : clash), 1u);
    EXPECT_EQ(record.rows[0].proved, z > 0);  // nothing is to be proved of "unknown"
  }
}

// An inner wall divides a part into two chambers; it is there for both of them.
TEST(Clash, WhatIsInAChamberBesideAnInnerWallIsContained) {
  Parts parts;
  parts.box({0, 0, 0}, {10, 10, 10});
  parts.box({10, 0, 0}, {20, 10, 10});
  parts.end("chambers");
  parts.add_box("inner", {4, 4, 4}, {6, 6, 6});
  EXPECT_EQ(clashes(parts.scene, {}).count(contained), 1u);
}

/// The same triangles, but each two of a quadrilateral have the other diagonal.
void turn_diagonals(Parts& parts, std::uint32_t first) {
  for (std::uint32_t t = first; t < parts.scene.triangles.size(); t += 2) {
    const auto [a, b, c] = parts.scene.triangles[t];
    const std::uint32_t d = parts.scene.triangles[t + 1][2];
    parts.scene.triangles[t] = {b, c, d};
    parts.scene.triangles[t + 1] = {b, d, a};
  }
}

// A diagonal of a flat face is no edge of the surface, also where both parts have it.
TEST(Clash, CurveDoesNotDependOnDiagonalsOfFlatFaces) {
  for (const bool first : {false, true}) {
    for (const bool second : {false, true}) {
      Parts wall;
      wall.add_box("peg", {0, 0, 3}, {1, 1, 4});
      if (first) turn_diagonals(wall, 0);
      wall.add_box("wall", {-5, -5, 0}, {5, 5, 4});
      if (second) turn_diagonals(wall, 12);
      EXPECT_EQ(clashes(wall.scene, {}).rows.at(0).curve, 4) << first << second;
      for (const double up : {0.0, 1.0}) {  // the twin: a bent face, whose diagonal is an edge
        if (up > 0 && first != second) continue;  // then the two are different solids
        Parts same;
        for (const bool turned : {first, second}) {
          same.add_box("box", {0, 0, 0}, {10, 10, 15});
          same.scene.vertices.back().z() += up;
          if (turned) turn_diagonals(same, same.scene.objects.back().first_triangle);
        }
        const double bent =
            6 * 10 + 2 * std::sqrt(101) + 3 * 15 + 16 + std::sqrt(first ? 200 : 201);
        EXPECT_NEAR(clashes(same.scene, {}).rows.at(0).curve, up > 0 ? bent : 140, 1e-12);
      }
    }
  }
}

// The square of 1e-170 is no double.
TEST(Clash, DepthsOfTinyPartsAreBounded) {
  for (const double unit : {1e-170, 0x1p-1074, 1e-300, 1e100}) {
    Parts parts;
    parts.add_box("a", Vec3(0, 0, 0), Vec3(20, 20, 20) * unit);
    parts.add_box("b", Vec3(10, 10, 10) * unit, Vec3(30, 30, 30) * unit);
    const ClashRecord record = clashes(parts.scene, {.depth = true});
    ASSERT_EQ(record.count(clash), 1u);
    ASSERT_TRUE(record.rows[0].depth) << unit;
    EXPECT_LE(record.rows[0].depth->lo, 10 * unit);
    EXPECT_GE(record.rows[0].depth->hi, 10 * unit) << unit;
    EXPECT_GT(record.rows[0].curve, 0);
  }
}

// Squares of products of such lengths are subnormal, so that normals would not have the length 1.
TEST(Clash, DepthsAreNotAboveTheTruthWhereSquaresAreSubnormal) {
  const Eigen::Matrix3d turn =
      Eigen::AngleAxisd(0.7, Vec3(1, 2, 3).normalized()).toRotationMatrix();
  for (const double unit : {1e-79, 1e-80, 3e-81, 1.0}) {
    Parts parts;
    parts.add_box("a", Vec3(0, 0, 0), Vec3(1, 1, 1));
    parts.add_box("b", Vec3(0.7, -0.2, -0.3), Vec3(2, 1.2, 1.5));
    for (Vec3& p : parts.scene.vertices) p = unit * (turn * p);
    const ClashRecord record = clashes(parts.scene, {.depth = true});
    ASSERT_TRUE(record.rows.at(0).depth) << unit;
    EXPECT_LE(record.rows[0].depth->lo, 0.3 * unit * (1 + 1e-14)) << unit;
    EXPECT_GE(record.rows[0].depth->hi, 0.3 * unit * (1 - 1e-14)) << unit;
    EXPECT_EQ(record.rows[0].depth->lo > 0, unit == 1) << unit;
  }
}

// Open surfaces have no inside: they touch only where a plane shows it.
TEST(Clash, ATouchThatIsNotProvedCountsAsAClash) {
  Parts lid;
  lid.box({0, 0, 0}, {1, 1, 1}, false, true);
  lid.end("open");
  lid.add_box("b", {0, 0, 1}, {1, 1, 2});
  EXPECT_EQ(clashes(lid.scene, {}).rows[0].verdict, touch);
  Parts through;  // its surface passes through the other one's along an edge
  through.box({0, 0, 0}, {1, 1, 1}, false, true);
  through.end("open");
  through.add_box("b", {0, 0, -1}, {1, 1, 2});
  const ClashRow row = clashes(through.scene, {}).rows[0];
  EXPECT_EQ(row.verdict, clash);
  EXPECT_EQ(row.kinds[static_cast<std::size_t>(ContactKind::crossing)] > 0, row.proved);
}

}  // namespace
}  // namespace farcull
