// Which of two objects lies inside the other.
#include "experiments/method/distances.h"

#include "tests/lab/test.h"

namespace farcull {
namespace {

/// A box as 12 triangles; without its lid where `open`.
void add_box(Scene& scene, const Vec3& middle, double half, bool open = false) {
  const auto first = static_cast<std::uint32_t>(scene.vertices.size());
  for (int k = 0; k < 8; ++k)
    scene.vertices.push_back(middle + half * Vec3((k & 1) * 2 - 1, (k & 2) - 1, (k & 4) / 2 - 1));
  for (const auto& [a, b, c, d] :
       {std::array{0u, 1u, 3u, 2u}, std::array{4u, 5u, 7u, 6u}, std::array{0u, 1u, 5u, 4u},
        std::array{2u, 3u, 7u, 6u}, std::array{0u, 2u, 6u, 4u}, std::array{1u, 3u, 7u, 5u}}) {
    scene.triangles.push_back({first + a, first + b, first + c});
    if (!open || a != 1) scene.triangles.push_back({first + a, first + c, first + d});
  }
}

/// What was added since the last object is one.
void end_object(Scene& scene) {
  std::uint32_t first = 0;
  if (!scene.objects.empty())
    first = scene.objects.back().first_triangle + scene.objects.back().triangle_count;
  const auto count = static_cast<std::uint32_t>(scene.triangles.size()) - first;
  scene.objects.push_back({.name = "", .first_triangle = first, .triangle_count = count});
  scene.source_face.resize(scene.triangles.size());
}

TEST(WhichInside, IsWhereAllPartsAre) {
  Scene scene;
  add_box(scene, {0, 0, 0}, 10);
  end_object(scene);  // 0: a large box
  add_box(scene, {1, 2, 3}, 1);
  end_object(scene);  // 1: inside it
  add_box(scene, {1, 2, 3}, 0.5);
  add_box(scene, {-5, -5, -5}, 1);
  end_object(scene);  // 2: two parts inside 0, one of them inside 1
  add_box(scene, {1, 2, 3}, 0.5);
  add_box(scene, {50, 0, 0}, 1);
  end_object(scene);  // 3: a part inside 0, the other not
  add_box(scene, {0, 0, 0}, 20);
  add_box(scene, {0, 0, 0}, 15);
  end_object(scene);  // 4: a shell around 0, which lies in its hollow
  add_box(scene, {0, 0, 0}, 30, true);
  end_object(scene);  // 5: open
  const Insides insides(scene);
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
  Scene scene;
  add_box(scene, {0, 0, 0}, 1);
  add_box(scene, {10, 10, 10}, 1);
  end_object(scene);
  add_box(scene, {5, 5, 5}, 1);
  end_object(scene);
  add_box(scene, {0, 0, 0}, 0.5);
  add_box(scene, {5, 5, 5}, 0.5);
  end_object(scene);  // a part inside the first box, a part between the two
  add_box(scene, {0, 0, 0}, 0.5);
  add_box(scene, {10, 10, 10}, 0.5);
  end_object(scene);  // a part inside either
  EXPECT_EQ(Insides(scene).which(0, 1), WhichInside::none);
  EXPECT_EQ(Insides(scene).which(0, 2), WhichInside::none);
  EXPECT_EQ(Insides(scene).which(0, 3), WhichInside::b);
}

TEST(WhichInside, PartsAreHeldTogetherByPositions) {
  // The outer box twice: each edge has an even number of triangles, no point is inside.
  Scene scene;
  add_box(scene, {0, 0, 0}, 10);
  add_box(scene, {0, 0, 0}, 10);
  end_object(scene);
  add_box(scene, {0, 0, 0}, 1);
  end_object(scene);
  EXPECT_EQ(Insides(scene).which(0, 1), WhichInside::none);
  // Every triangle with vertices of its own, zeros of either sign: one part all the same.
  Scene soup;
  add_box(soup, {5, 5, 5}, 5);
  end_object(soup);
  add_box(soup, {5, 5, 5}, 1);
  end_object(soup);
  Scene apart = soup;
  apart.vertices.clear();
  bool negative = false;
  for (auto& t : apart.triangles) {
    for (auto& v : t) {
      Vec3 p = soup.vertices[v];
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
