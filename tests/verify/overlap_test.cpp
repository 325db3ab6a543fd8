// Solids that touch, and solids that overlap although no two of their triangles cross.
#include "verify/overlap.h"

#include "experiments/method/distances.h"
#include "tests/lab/parts.h"
#include "verify/contact.h"
#include "verify/exact.h"

namespace farcull {
namespace {

using lab::Parts;

struct Case {
  std::vector<TrianglePair> contacts;
  bool crossing = false;
};

Case case_of(const Scene& scene) {
  Case out;
  out.contacts = all_colliding_pairs(scene).pairs;
  for (const ContactKind kind : contact_kinds(scene, out.contacts))
    out.crossing = out.crossing || kind == ContactKind::crossing;
  return out;
}

/// The answer about the first two objects, whose triangles meet but do not cross.
Overlap answer(const Scene& scene) {
  validate(scene, "test");
  const Case of = case_of(scene);
  EXPECT_FALSE(of.contacts.empty());
  EXPECT_FALSE(of.crossing);
  return overlap_of_touching(scene, {0, 1}, of.contacts,
                             point_of_each_part(scene, scene.objects[0]),
                             point_of_each_part(scene, scene.objects[1]),
                             {doubted_surface_of(scene, 0), doubted_surface_of(scene, 1)});
}

// Each of these has only kinds of contact that boxes side by side have, too: a rule by kinds says
// that they touch, which is what the proof must not say.
TEST(Overlap, IsFoundWhereNoTrianglesCross) {
  Parts flush;
  flush.add_box("a", {0, 0, 0}, {2, 1, 1});
  flush.add_box("b", {1, 0, 0}, {3, 1, 1});
  EXPECT_EQ(answer(flush.scene), Overlap::yes);
  Parts equal;
  equal.add_box("a", {0, 0, 0}, {1, 1, 1});
  equal.add_box("b", {0, 0, 0}, {1, 1, 1});
  EXPECT_EQ(answer(equal.scene), Overlap::yes);
  Parts within;  // they share one face, on its outer side
  within.add_box("a", {0, 0, 0}, {4, 4, 4});
  within.add_box("b", {1, 1, 2}, {3, 3, 4});
  EXPECT_EQ(answer(within.scene), Overlap::yes);
  Parts hung;  // a part that touches, and a part inside that has no contact
  hung.add_box("a", {0, 0, 0}, {4, 4, 4});
  hung.box({4, 0, 0}, {5, 4, 4});
  hung.box({1, 1, 1}, {2, 2, 2});
  hung.end("b");
  EXPECT_EQ(answer(hung.scene), Overlap::yes);
  // A rod of two cubes on one another, whose common edges lie in the face of a slab: its surface
  // passes through the slab's along these edges.
  RandomNumbers random(1);
  Parts rod;
  rod.add_cubes("rod", {{0, 0, -1}, {0, 0, 0}}, random);
  rod.add_box("slab", {-2, -2, -5}, {3, 3, 0});
  EXPECT_EQ(answer(rod.scene), Overlap::yes);
}

// A cube in the box a hangs on a fold, whose tip is on the wall of a. Only the fold meets a, and it
// has no inside. The two sides of the fold are the same triangle, or are divided differently.
TEST(Overlap, AFoldThatTouchesHidesNoCubeThatHangsOnIt) {
  for (const bool alike : {false, true}) {
    Parts parts;
    parts.add_box("a", {0, 0, 0}, {10, 10, 10});
    const std::uint32_t c = parts.next();
    if (alike) {
      parts.vertex(10, 5, 4), parts.vertex(6, 4, 4), parts.vertex(6, 6, 4);
      parts.triangle(c, c + 1, c + 2);
      parts.triangle(c, c + 2, c + 1);
    } else {
      parts.vertex(10, 4, 4), parts.vertex(10, 6, 4), parts.vertex(6, 6, 4), parts.vertex(6, 4, 4);
      parts.vertex(8, 5, 4);
      for (std::uint32_t k = 0; k < 4; ++k) parts.triangle(c + k, c + (k + 1) % 4, c + 4);
      parts.quad(c, {3, 2, 1, 0});
    }
    parts.box({4, 4, 4}, {6, 6, 6});
    parts.end("b");
    EXPECT_EQ(doubted_surface_of(parts.scene, 1), Surface::doubled);
    EXPECT_EQ(answer(parts.scene), Overlap::unknown) << alike;
  }
}

// A sheet in a box, with a corner on its wall: the plane of the sheet has the box on both sides.
TEST(Overlap, NoPlaneDividesASheetFromTheBoxAroundIt) {
  for (const bool first : {false, true}) {
    Parts parts;
    const auto add_sheet = [&] {
      const std::uint32_t corner = parts.next();
      parts.vertex(0, 2, 2), parts.vertex(3, 1, 2), parts.vertex(3, 3, 2);
      parts.triangle(corner, corner + 1, corner + 2);
      parts.end("sheet");
    };
    if (first) add_sheet();
    parts.add_box("box", {0, 0, 0}, {4, 4, 4});
    if (!first) add_sheet();
    const Case of = case_of(parts.scene);
    ASSERT_FALSE(of.contacts.empty());
    EXPECT_FALSE(plane_divides(parts.scene, {0, 1}, of.contacts));
  }
}

}  // namespace
}  // namespace farcull
