// What lies inside what, in integers: against tetrahedra of small whole numbers, whose rays meet
// edges and corners all the time, and against the answer of the program.
#include "verify/certificate/integer_inside.h"

#include "experiments/method/distances.h"
#include "tests/lab/reference.h"
#include "tests/lab/test.h"
#include "verify/certificate/integer_distance.h"
#include "verify/rational.h"

namespace farcull {
namespace {

using Whole = std::array<long, 3>;
using Tetrahedron = std::array<Whole, 4>;
constexpr std::array<std::array<int, 3>, 4> kFaces = {{{0, 1, 2}, {0, 3, 1}, {0, 2, 3}, {1, 3, 2}}};

long determinant(const Whole& o, const Whole& p, const Whole& q, const Whole& r) {
  std::array<Whole, 3> m{};
  for (int k = 0; k < 3; ++k) m[0][k] = p[k] - o[k], m[1][k] = q[k] - o[k], m[2][k] = r[k] - o[k];
  return m[0][0] * (m[1][1] * m[2][2] - m[1][2] * m[2][1]) -
         m[0][1] * (m[1][0] * m[2][2] - m[1][2] * m[2][0]) +
         m[0][2] * (m[1][0] * m[2][1] - m[1][1] * m[2][0]);
}

/// Strictly: on the same side of each face as the corner across.
bool holds(const Tetrahedron& t, const Whole& x) {
  for (const auto& [i, j, k] : kFaces) {
    const int across = 6 - i - j - k;
    const long of_x = determinant(t[i], t[j], t[k], x);
    const long of_t = determinant(t[i], t[j], t[k], t[across]);
    if (of_x == 0 || (of_x > 0) != (of_t > 0)) return false;
  }
  return true;
}

/// The number of faces that the ray along the first axis crosses, where an edge or a corner that it
/// meets counts as crossed: what happens without the shift of the ray.
bool odd_without_shift(const Tetrahedron& t, const Whole& x) {
  bool odd = false;
  for (const auto& [i, j, k] : kFaces) {
    const auto side = [&](const Whole& p, const Whole& q) {
      return (p[1] - x[1]) * (q[2] - x[2]) - (p[2] - x[2]) * (q[1] - x[1]);
    };
    const std::array<long, 3> s = {side(t[i], t[j]), side(t[j], t[k]), side(t[k], t[i])};
    const bool left = s[0] >= 0 && s[1] >= 0 && s[2] >= 0;
    const bool right = s[0] <= 0 && s[1] <= 0 && s[2] <= 0;
    if (!left && !right) continue;
    const long ahead = determinant(x, t[i], t[j], t[k]);
    if (left ? ahead > 0 : ahead < 0) odd = !odd;
  }
  return odd;
}

Tetrahedron random_tetrahedron(rational::Draws& random, long from, long below) {
  Tetrahedron t{};
  do {
    for (Whole& p : t)
      for (long& x : p) x = from + random.below(static_cast<unsigned>(below));
  } while (determinant(t[0], t[1], t[2], t[3]) == 0);
  return t;
}

void add(Scene& scene, const Tetrahedron& t, double unit) {
  const auto first = static_cast<std::uint32_t>(scene.vertices.size());
  for (const Whole& p : t) {
    scene.vertices.emplace_back(static_cast<double>(p[0]) * unit, static_cast<double>(p[1]) * unit,
                                static_cast<double>(p[2]) * unit);
  }
  for (const auto& [i, j, k] : kFaces) {
    scene.triangles.push_back({first + static_cast<std::uint32_t>(i),
                               first + static_cast<std::uint32_t>(j),
                               first + static_cast<std::uint32_t>(k)});
    scene.source_face.push_back(0);
  }
}

/// An object of some tetrahedra, then another one.
Scene scene_of(const std::vector<Tetrahedron>& a, const std::vector<Tetrahedron>& b, double unit) {
  Scene scene;
  for (const auto* object : {&a, &b}) {
    const auto first = static_cast<std::uint32_t>(scene.triangles.size());
    for (const Tetrahedron& t : *object) add(scene, t, unit);
    scene.objects.push_back(
        {.name = "",
         .first_triangle = first,
         .triangle_count = static_cast<std::uint32_t>(scene.triangles.size()) - first});
  }
  return scene;
}

bool meet(const Scene& scene) {
  for (std::uint32_t s = 0; s < scene.objects[0].triangle_count; ++s) {
    for (std::uint32_t t = scene.objects[1].first_triangle; t < scene.triangles.size(); ++t)
      if (integer_distance(scene.corners(s), scene.corners(t)).squared.over == 0) return true;
  }
  return false;
}

// The outer object has one or two tetrahedra, which may overlap: then what is in both is outside.
TEST(IntegerInside, IsThatOfTetrahedraOfWholeNumbers) {
  rational::Draws random(31);
  int in = 0, out = 0, twin_wrong = 0;
  for (int n = 0; n < trials(1'200); ++n) {
    std::vector<Tetrahedron> outer = {random_tetrahedron(random, 0, 13)};
    if (random.below(3) == 0) outer.push_back(random_tetrahedron(random, 0, 13));
    Tetrahedron inner{};
    const Whole at = {4 + random.below(5), 4 + random.below(5), 4 + random.below(5)};
    for (std::size_t i = 0; i < 4; ++i) {
      inner[i] = at;
      if (i > 0) ++inner[i][i - 1];
    }
    const double unit = std::exp2(random.below(4) == 0 ? random.uniform(-1060, 1000) : 0);
    const bool swapped = random.coin();
    const Scene scene = swapped ? scene_of({inner}, outer, unit) : scene_of(outer, {inner}, unit);
    if (meet(scene)) continue;
    bool expected = false, naive = false;
    for (const Tetrahedron& t : outer) {
      expected = expected != holds(t, at);
      naive = naive != odd_without_shift(t, at);
    }
    const InsideClaim yes = swapped ? InsideClaim::a : InsideClaim::b;
    const auto found = IntegerInside(scene).which(0, 1);
    ASSERT_EQ(found, expected ? yes : InsideClaim::none) << n;
    ASSERT_EQ(found, Insides(scene).which(0, 1)) << n;
    (expected ? in : out) += 1;
    twin_wrong += naive != expected;
  }
  EXPECT_GT(in, trials(20));
  EXPECT_GT(out, trials(20));
  EXPECT_GT(twin_wrong, trials(4));
}

Scene of_boxes(double unit) {
  return scene_of({{{{0, 0, 0}, {9, 0, 0}, {0, 9, 0}, {0, 0, 9}}}},
                  {{{{1, 1, 1}, {2, 1, 1}, {1, 2, 1}, {1, 1, 2}}}}, unit);
}

TEST(IntegerInside, AMeshThatIsNotClosedHasNoInside) {
  Scene scene = of_boxes(1);
  EXPECT_EQ(IntegerInside(scene).which(0, 1), InsideClaim::b);
  EXPECT_EQ(IntegerInside(scene).which(1, 0), InsideClaim::a);
  scene.triangles[3] = scene.triangles[0];  // a face twice, another one not at all
  EXPECT_EQ(IntegerInside(scene).which(0, 1), InsideClaim::not_closed);
  EXPECT_EQ(IntegerInside(scene).which(1, 0), InsideClaim::not_closed);
  // Of degenerate triangles those with two equal corners do not count.
  scene = of_boxes(1);
  scene.triangles[3] = {1, 1, 2};
  EXPECT_EQ(IntegerInside(scene).which(0, 1), InsideClaim::not_closed);
  // Not closed, but not around the other box either.
  for (std::size_t v = 4; v < 8; ++v) scene.vertices[v].x() += 100;
  EXPECT_EQ(IntegerInside(scene).which(0, 1), InsideClaim::none);
}

// An object of two parts of which one is outside is not inside.
TEST(IntegerInside, AllPartsHaveToBeInside) {
  const Tetrahedron large = {{{0, 0, 0}, {9, 0, 0}, {0, 9, 0}, {0, 0, 9}}};
  const Tetrahedron inside = {{{1, 1, 1}, {2, 1, 1}, {1, 2, 1}, {1, 1, 2}}};
  const Tetrahedron outside = {{{7, 7, 7}, {8, 7, 7}, {7, 8, 7}, {7, 7, 8}}};
  const auto which = [](const Scene& scene) { return IntegerInside(scene).which(0, 1); };
  EXPECT_EQ(which(scene_of({large}, {inside, inside}, 1)), InsideClaim::b);
  EXPECT_EQ(which(scene_of({large}, {inside, outside}, 1)), InsideClaim::none);
  EXPECT_EQ(which(scene_of({large}, {outside, inside}, 1)), InsideClaim::none);
  // Positions decide what is closed, with zeros of either sign.
  Scene scene = scene_of({large}, {inside}, 1);
  for (auto& t : scene.triangles) {
    for (std::uint32_t& v : t) {
      scene.vertices.push_back(scene.vertices[v]);
      for (double& x : scene.vertices.back())
        if (x == 0 && v % 2 == 0) x = -0.0;
      v = static_cast<std::uint32_t>(scene.vertices.size() - 1);
    }
  }
  EXPECT_EQ(which(scene), InsideClaim::b);
  EXPECT_THROW(IntegerInside(scene).which(0, 0), std::logic_error);
  EXPECT_THROW(IntegerInside(scene).which(0, 2), std::logic_error);
}

}  // namespace
}  // namespace farcull
