// The kinds of contact: an example of each beside one that differs in a single unit, and properties
// that hold for all of them.
#include "experiments/generators/pair_generators.h"
#include "experiments/suite/reader.h"
#include "experiments/suite/writer.h"
#include "tests/lab/test.h"
#include "verify/contact_kind.h"
#include "verify/exact.h"

namespace farcull {
namespace {

using Corners = std::array<Vec3, 3>;

const Corners kFlat = {Vec3(0, 0, 0), Vec3(4, 0, 0), Vec3(0, 4, 0)};  // in the plane z = 0

std::string kind(const Corners& a, const Corners& b) {
  return to_string(decide_kind(a, b, "test"));
}

Corners moved(Corners t, const Vec3& by) {
  for (Vec3& p : t) p += by;
  return t;
}

TEST(SuiteKinds, ACornerOnAFaceIsTouchAndOneUnitAwayIsNot) {
  const Corners above = {Vec3(1, 1, 0), Vec3(1, 2, 1), Vec3(2, 1, 1)};
  EXPECT_EQ(kind(kFlat, above), "touch-vertex");
  EXPECT_EQ(kind(kFlat, moved(above, {0, 0, 0x1p-52})), "apart");
  EXPECT_EQ(kind(kFlat, moved(above, {0, 0, -0x1p-52})), "crossing");
}

TEST(SuiteKinds, CornersOnCornersAndOnEdges) {
  EXPECT_EQ(kind(kFlat, {Vec3(0, 0, 0), Vec3(-1, 0, 1), Vec3(0, -1, 1)}), "touch-vertex");
  EXPECT_EQ(kind(kFlat, {Vec3(2, 0, 0), Vec3(2, -1, 1), Vec3(2, -1, -1)}), "touch-vertex");
  EXPECT_EQ(kind(kFlat, {Vec3(2, -0x1p-52, 0), Vec3(2, -1, 1), Vec3(2, -1, -1)}), "apart");
}

TEST(SuiteKinds, EdgesThatCrossTouchAtAnEdge) {
  const Corners across = {Vec3(2, 0, -1), Vec3(2, 0, 1), Vec3(2, -3, 0)};
  EXPECT_EQ(kind(kFlat, across), "touch-edge");
  EXPECT_EQ(kind(kFlat, moved(across, {0, -0x1p-50, 0})), "apart");
  EXPECT_EQ(kind(kFlat, moved(across, {0, 0x1p-50, 0})), "crossing");
}

TEST(SuiteKinds, AnEdgeInAFaceTouchesAtAFace) {
  const Corners standing = {Vec3(1, 1, 0), Vec3(2, 1, 0), Vec3(1, 1, 3)};
  EXPECT_EQ(kind(kFlat, standing), "touch-face");
  EXPECT_EQ(kind(kFlat, moved(standing, {0, 0, -0x1p-50})), "crossing");
  // A hinge: one edge in common, in two planes.
  EXPECT_EQ(kind(kFlat, {Vec3(0, 0, 0), Vec3(4, 0, 0), Vec3(0, -1, 2)}), "touch-face");
}

TEST(SuiteKinds, InOnePlane) {
  EXPECT_EQ(kind(kFlat, {Vec3(1, 1, 0), Vec3(9, 1, 0), Vec3(1, 9, 0)}), "coplanar");
  EXPECT_EQ(kind(kFlat, {Vec3(0, 0, 0), Vec3(4, 0, 0), Vec3(0, -4, 0)}), "coplanar");
  EXPECT_EQ(kind(kFlat, {Vec3(4, 0, 0), Vec3(9, 0, 0), Vec3(9, 1, 0)}), "touch-vertex");
  EXPECT_EQ(kind(kFlat, {Vec3(5, 0, 0), Vec3(9, 0, 0), Vec3(9, 1, 0)}), "apart");
  EXPECT_EQ(kind(kFlat, {kFlat[2], kFlat[0], kFlat[1]}), "equal");
  EXPECT_EQ(kind(kFlat, {kFlat[2], kFlat[0], Vec3(4, 0x1p-50, 0)}), "coplanar");
}

TEST(SuiteKinds, SegmentsAndPoints) {
  const Corners through = {Vec3(1, 1, -1), Vec3(1, 1, 0), Vec3(1, 1, 1)};  // three on a line
  EXPECT_EQ(kind(kFlat, through), "crossing");
  EXPECT_EQ(kind(kFlat, {Vec3(1, 1, 0), Vec3(1, 1, 1), Vec3(1, 1, 1)}), "touch-vertex");
  EXPECT_EQ(kind(kFlat, {Vec3(2, 0, -1), Vec3(2, 0, 1), Vec3(2, 0, 1)}), "touch-edge");
  EXPECT_EQ(kind(through, {Vec3(0, 1, 0), Vec3(2, 1, 0), Vec3(2, 1, 0)}), "touch-edge");
  EXPECT_EQ(kind(through, {Vec3(1, 1, 0), Vec3(1, 1, 5), Vec3(1, 1, 5)}), "coplanar");
  EXPECT_EQ(kind(through, {Vec3(1, 1, -1), Vec3(1, 1, 1), Vec3(1, 1, 1)}), "equal");
  const Corners point = {Vec3(1, 1, 0), Vec3(1, 1, 0), Vec3(1, 1, 0)};
  EXPECT_EQ(kind(kFlat, point), "touch-vertex");
  EXPECT_EQ(kind(point, point), "equal");
  EXPECT_EQ(kind(kFlat, moved(point, {0, 0, 0x1p-1074})), "apart");
}

TEST(SuiteKinds, NeighboursMeetWhereTheyShareMoreThanTheirEdge) {
  const auto neighbours = [](const Corners& a, const Corners& b) {
    return to_string(decide_neighbours(a, b, "test"));
  };
  const Vec3 p(0, 0, 0), q(4, 0, 0);
  EXPECT_EQ(neighbours(kFlat, {p, q, Vec3(1, 1, 0)}), "neighbours-meet");
  EXPECT_EQ(neighbours(kFlat, {p, q, Vec3(1, 1, 0x1p-1074)}), "neighbours-apart");
  EXPECT_EQ(neighbours(kFlat, {p, q, Vec3(1, -1, 0)}), "neighbours-apart");
  EXPECT_EQ(neighbours(kFlat, kFlat), "neighbours-meet");
}

TEST(SuiteKinds, DoNotDependOnTheOrderOfCornersAndTriangles) {
  for (const PairFamily& family : pair_families()) {
    for (std::uint64_t id = 0; id < 40; ++id) {
      const SuitePair pair = make_suite_pair(family, 7, id);
      if (!pair.shared.empty()) continue;
      const SuiteKind first = decide_kind(pair.a, pair.b, family.name);
      const Corners turned = {pair.a[1], pair.a[2], pair.a[0]};
      const Corners mirrored = {pair.b[0], pair.b[2], pair.b[1]};
      EXPECT_EQ(decide_kind(mirrored, turned, family.name), first) << family.name << " " << id;
    }
  }
}

TEST(SuiteKinds, HaveNamesThatAreReadBack) {
  for (int k = 0; k < 10; ++k) {
    const auto kind = static_cast<SuiteKind>(k);
    EXPECT_EQ(parse_suite_kind(to_string(kind)), kind);
  }
  EXPECT_FALSE(parse_suite_kind("touch"));
  EXPECT_FALSE(collides(SuiteKind::apart));
  EXPECT_TRUE(collides(SuiteKind::touch_vertex));
}

constexpr std::uint64_t kEach = 120;  // pairs of a family

TEST(SuiteContactKinds, AreTheLabelsInEveryFamily) {
  std::array<int, kContactKinds.size()> of_kind{};
  int degenerate = 0;
  for (const PairFamily& family : pair_families()) {
    for (std::uint64_t id = 0; id < kEach; ++id) {
      const SuitePair pair = make_suite_pair(family, 11, id);
      const ContactKind kind = contact_kind(pair.a, pair.b);
      ASSERT_EQ(name_of(kind), to_string(decide_kind(pair.a, pair.b, family.name)))
          << family.name << " " << id;
      ASSERT_EQ(contact_shape(pair.b, pair.a).kind, kind) << family.name << " " << id;
      ++of_kind[static_cast<std::size_t>(kind)];
      degenerate += shape(pair.a) != Shape::triangle || shape(pair.b) != Shape::triangle;
    }
  }
  for (const ContactKind kind : kContactKinds)
    EXPECT_GT(of_kind[static_cast<std::size_t>(kind)], 0) << name_of(kind);
  EXPECT_GT(degenerate, 0);
}

// The twin: corners that are rounded to float before the kind is decided.
TEST(SuiteContactKinds, OfRoundedCornersAreCaught) {
  const auto rounded = [](Corners t) {
    for (Vec3& p : t) p = p.cast<float>().cast<double>();
    return t;
  };
  int caught = 0;
  for (const PairFamily& family : pair_families()) {
    for (std::uint64_t id = 0; id < 20; ++id) {
      const SuitePair pair = make_suite_pair(family, 11, id);
      const Corners a = rounded(pair.a), b = rounded(pair.b);
      if (!a[0].allFinite() || !a[1].allFinite() || !a[2].allFinite()) continue;
      if (!b[0].allFinite() || !b[1].allFinite() || !b[2].allFinite()) continue;
      caught += name_of(contact_kind(a, b)) != to_string(decide_kind(pair.a, pair.b, family.name));
    }
  }
  EXPECT_GT(caught, 20);
}

}  // namespace
}  // namespace farcull
