// Which parts clash: assemblies whose answer is known, and solids of unit cubes, of which integers
// tell.
#include "experiments/method/clash.h"

#include "experiments/peers/peer.h"
#include "tests/lab/parts.h"

namespace farcull {
namespace {

using lab::Parts;
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

/// 31 parts, and what is to be said about each pair that is not clear at a clearance of 2.
struct Assembly {
  Parts parts;
  std::map<ObjectPair, ClashVerdict> expected;
  std::map<ObjectPair, double> distances, depths;

  Assembly() {
    const std::uint32_t lower = parts.add_box("lower", {0, 0, 0}, {100, 60, 5});
    const std::uint32_t upper = parts.add_box("upper", {0, 0, 5}, {100, 60, 10});
    expected[{lower, upper}] = touch;
    for (int k = 0; k < 8; ++k) {
      // A bolt goes through both plates, and has a washer around it.
      const double x = 15 + 22 * (k % 4), y = 15 + 30 * (k / 4);
      const std::string number = std::to_string(k);
      const std::uint32_t bolt =
          parts.add_box("bolt" + number, {x - 2, y - 2, -7}, {x + 2, y + 2, 17});
      const std::uint32_t washer =
          parts.add_ring("washer" + number, {x - 4, y - 4, 10}, {x + 4, y + 4, 11},
                         {x - 2.125, y - 2.125, 10}, {x + 2.125, y + 2.125, 11});
      expected[{lower, bolt}] = expected[{upper, bolt}] = clash;
      depths[{lower, bolt}] = depths[{upper, bolt}] = 12;
      expected[{upper, washer}] = touch;
      expected[{bolt, washer}] = near;
      distances[{bolt, washer}] = 0.125;
    }
    const std::uint32_t block = parts.add_box("block", {200, 0, 0}, {240, 40, 40});
    const std::uint32_t buried = parts.add_box("buried", {210, 10, 10}, {220, 20, 20});
    expected[{block, buried}] = contained;
    depths[{block, buried}] = 20;
    parts.box({300, 0, 0}, {340, 40, 40});
    parts.box({305, 5, 5}, {335, 35, 35}, true);
    parts.end("housing");
    parts.add_box("housed", {310, 10, 10}, {320, 20, 20});
    const std::uint32_t row = parts.add_box("row0", {400, 0, 0}, {410, 10, 10});
    parts.add_box("row1", {410.1, 0, 0}, {420, 10, 10});
    parts.add_box("row2", {422, 0, 0}, {430, 10, 10});
    parts.add_box("row3", {432.0000001, 0, 0}, {440, 10, 10});
    expected[{row, row + 1}] = expected[{row + 1, row + 2}] = near;
    distances[{row, row + 1}] = 410.1 - 410;
    distances[{row + 1, row + 2}] = 2;
    const std::uint32_t flush = parts.add_box("flush0", {500, 0, 0}, {520, 10, 10});
    parts.add_box("flush1", {510, 0, 0}, {530, 10, 10});
    expected[{flush, flush + 1}] = clash;
    depths[{flush, flush + 1}] = 10;
    const std::uint32_t tip = parts.add_tetrahedron(
        "tip0", {Vec3(600, 10, 10), Vec3(604, 10, 10), Vec3(600, 14, 10), Vec3(600, 10, 14)});
    parts.add_tetrahedron(
        "tip1", {Vec3(600, 10, 10), Vec3(596, 10, 10), Vec3(600, 6, 10), Vec3(600, 10, 6)});
    expected[{tip, tip + 1}] = touch;
    parts.box({570, -20, -20}, {630, 40, 40}, false, true);
    const std::uint32_t cover = parts.end("cover");
    expected[{tip, cover}] = expected[{tip + 1, cover}] = unknown;
  }
};

TEST(Clash, OfAnAssemblyIsKnown) {
  const Assembly assembly;
  const Scene& scene = assembly.parts.scene;
  ASSERT_EQ(scene.objects.size(), 31u);
  const ClashRecord record = clashes(scene, {.clearance = 2});
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
  // The most serious first.
  for (std::size_t k = 1; k < record.rows.size(); ++k)
    EXPECT_LE(record.rows[k - 1].verdict, record.rows[k].verdict);
  // The twins: the clearance decides about the gap of 2, and the last gap is beyond it.
  EXPECT_EQ(clashes(scene, {.clearance = std::nextafter(2.0, 0)}).count(near), 9u);
  EXPECT_EQ(clashes(scene, {.clearance = 2.0000002}).count(near), 11u);
  EXPECT_EQ(clashes(scene, {}).count(near), 0u);
}

TEST(Clash, DoesNotDependOnThreads) {
  const Scene scene = Assembly().parts.scene;
  const auto text = [&](unsigned threads) {
    std::ostringstream out;
    for (const ClashRow& row : clashes(scene, {.clearance = 2, .threads = threads}).rows) {
      out << row.objects.a << ' ' << row.objects.b << ' ' << to_string(row.verdict) << ' '
          << row.witness[0].transpose() << ' ' << row.curve << ' '
          << (row.depth ? row.depth->lo : 0) << '\n';
    }
    return out.str();
  };
  EXPECT_EQ(text(1), text(3));
}

// FCL says whether surfaces meet, and how far apart they are. It knows no touching, and nothing of
// what is inside.
TEST(Clash, AgreesWithFclOnWhatFclCanDo) {
  const std::vector<DistancePeer> peers = distance_peers();
  const auto fcl = std::ranges::find(peers, "fcl-double", &DistancePeer::name);
  if (fcl == peers.end() || !fcl->missing.empty()) GTEST_SKIP() << "FCL is not in this build";
  const Assembly assembly;
  const Scene& scene = assembly.parts.scene;
  const ClashRecord record = clashes(scene, {.clearance = 2});
  const std::map<ObjectPair, ClashVerdict> ours = verdicts(record);
  for (const PeerDistance& theirs : fcl->run(scene, {}, 1).distances) {
    const auto at = ours.find({theirs.a, theirs.b});
    const ClashVerdict verdict = at == ours.end() ? clear : at->second;
    if (verdict == clash || verdict == touch) {
      EXPECT_LT(theirs.distance, 1e-9);
    } else if (verdict == near) {
      EXPECT_NEAR(theirs.distance, row_of(record, theirs.a, theirs.b).distance, 1e-9);
    } else {
      EXPECT_GT(theirs.distance, 0);
    }
  }
}

// Solids of unit cubes. Inside, touching and distances are those of the cubes.
TEST(Clash, OfSolidsOfCubesIsKnown) {
  RandomNumbers random(seed_of_day(6));
  std::map<ClashVerdict, int> seen;
  for (int k = 0; k < trials(80); ++k) {
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
    ++seen[verdict];
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
    if (verdict == clash && record.rows[0].depth) {
      // Along an axis, the solids have to move by a whole number.
      EXPECT_LE(record.rows[0].depth->lo, record.rows[0].depth->hi);
    }
  }
  for (const ClashVerdict verdict : {clash, contained, touch, near, clear})
    EXPECT_GT(seen[verdict], 0) << to_string(verdict);
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
