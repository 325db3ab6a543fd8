// Which of two objects lies inside the other.
#include "experiments/method/distances.h"

#include "tests/lab/parts.h"

namespace farcull {
namespace {

using lab::Parts;

/// A cube whose sides are twice `half` long; without its lid where `open`. Two of its sides face
/// inward, so that parity decides.
void add_box(Parts& parts, const Vec3& middle, double half, bool open = false) {
  const Vec3 h = Vec3::Constant(half);
  parts.box(middle - h, middle + h, false, open);
  for (auto& t : std::span(parts.scene.triangles).last(4)) std::swap(t[0], t[1]);
}

TEST(WhichInside, IsWhereAllPartsAre) {
  Parts parts;
  add_box(parts, {0, 0, 0}, 10);
  parts.end("");  // 0: a large box
  add_box(parts, {1, 2, 3}, 1);
  parts.end("");  // 1: inside it
  add_box(parts, {1, 2, 3}, 0.5);
  add_box(parts, {-5, -5, -5}, 1);
  parts.end("");  // 2: two parts inside 0, one of them inside 1
  add_box(parts, {1, 2, 3}, 0.5);
  add_box(parts, {50, 0, 0}, 1);
  parts.end("");  // 3: a part inside 0, the other not
  add_box(parts, {0, 0, 0}, 20);
  add_box(parts, {0, 0, 0}, 15);
  parts.end("");  // 4: a shell around 0, which lies in its hollow
  add_box(parts, {0, 0, 0}, 30, true);
  parts.end("");  // 5: open
  const Insides insides(parts.scene);
  EXPECT_EQ(insides.which(0, 1), WhichInside::b);
  EXPECT_EQ(insides.which(1, 0), WhichInside::a);
  EXPECT_EQ(insides.which(0, 2), WhichInside::b);
  EXPECT_EQ(insides.which(1, 2), WhichInside::none);
  EXPECT_EQ(insides.which(0, 3), WhichInside::none);
  EXPECT_EQ(insides.which(0, 4), WhichInside::none);
  EXPECT_EQ(insides.which(1, 4), WhichInside::none);
  EXPECT_EQ(insides.which(0, 5), WhichInside::not_closed);
  EXPECT_EQ(insides.which(5, 4), WhichInside::not_closed);
  EXPECT_EQ(insides.which(3, 5), WhichInside::none);  // it reaches out of the box
}

// A part that is inside by its box alone: between two parts of the outer object.
TEST(WhichInside, IsDecidedByParityNotByBoxes) {
  Parts parts;
  const auto add_two = [&](double half, double first, double second) {
    for (const double at : {first, second}) add_box(parts, Vec3::Constant(at), half);
    parts.end("");
  };
  add_two(1, 0, 10);
  add_box(parts, {5, 5, 5}, 1);
  parts.end("");
  add_two(0.5, 0, 5);   // a part inside the first box, a part between the two
  add_two(0.5, 0, 10);  // a part inside either
  EXPECT_EQ(Insides(parts.scene).which(0, 1), WhichInside::none);
  EXPECT_EQ(Insides(parts.scene).which(0, 2), WhichInside::none);
  EXPECT_EQ(Insides(parts.scene).which(0, 3), WhichInside::b);
}

TEST(WhichInside, PartsAreHeldTogetherByPositions) {
  // The outer box twice: each edge has an even number of triangles, no point is inside.
  Parts parts;
  add_box(parts, {0, 0, 0}, 10);
  add_box(parts, {0, 0, 0}, 10);
  parts.end("");
  add_box(parts, {0, 0, 0}, 1);
  parts.end("");
  EXPECT_EQ(Insides(parts.scene).which(0, 1), WhichInside::none);
  // Every triangle with vertices of its own, zeros of either sign: one part all the same.
  Parts soup;
  add_box(soup, {5, 5, 5}, 5);
  soup.end("");
  add_box(soup, {5, 5, 5}, 1);
  soup.end("");
  Scene apart = soup.scene;
  apart.vertices.clear();
  bool negative = false;
  for (auto& t : apart.triangles) {
    for (auto& v : t) {
      Vec3 p = soup.scene.vertices[v];
      negative = !negative;
      for (double& x : p) x = x == 0 && negative ? -0.0 : x;
      v = static_cast<std::uint32_t>(apart.vertices.size());
      apart.vertices.push_back(p);
    }
  }
  EXPECT_EQ(Insides(apart).which(0, 1), WhichInside::b);
}

}  // namespace
}  // namespace farcull
