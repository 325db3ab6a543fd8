// Points inside, outside and on meshes. The truth is that of tetrahedra: each point is inside as
// many of them as integers say, and a mesh of their faces is crossed once for each, so its inside
// is where that number is odd. Whole coordinates make rays meet edges and corners.
#include "verify/inside.h"

#include <Eigen/Geometry>

#include "experiments/scenes/scene_file.h"
#include "tests/lab/hard_pairs.h"
#include "tests/lab/parts.h"
#include "verify/certificate/integer_distance.h"

namespace farcull {
namespace {

using reference::Triangle;
using Tetrahedron = std::array<Vec3, 4>;

Scene scene_of(const std::vector<Triangle>& triangles) { return reference::scene_of({triangles}); }

std::int64_t orientation(const Vec3& p, const Vec3& q, const Vec3& r, const Vec3& s) {
  const auto exact = [&](const Vec3& x) {
    const Vec3 d = x - p;
    return reference::Vector<std::int64_t>{std::int64_t(d.x()), std::int64_t(d.y()),
                                           std::int64_t(d.z())};
  };
  return reference::dot(exact(q), reference::cross(exact(r), exact(s)));
}

void add_faces(const Tetrahedron& t, std::vector<Triangle>& triangles) {
  for (int left_out = 0; left_out < 4; ++left_out) {
    Triangle face;
    for (int i = 0, k = 0; i < 4; ++i)
      if (i != left_out) face[k++] = t[i];
    triangles.push_back(face);
  }
}

/// For whole coordinates. `on` is set where the point is on a face.
bool in_tetrahedron(const Tetrahedron& t, const Vec3& x, bool& on) {
  const std::int64_t whole = orientation(t[0], t[1], t[2], t[3]);
  if (whole == 0) return false;
  int at_face = 0;
  for (int i = 0; i < 4; ++i) {
    Tetrahedron part = t;
    part[i] = x;
    const std::int64_t side = orientation(part[0], part[1], part[2], part[3]);
    if ((side < 0) != (whole < 0) && side != 0) return false;
    at_face += side == 0;
  }
  on = on || at_face > 0;
  return at_face == 0;
}

/// The truth about a mesh of the faces of tetrahedra, flat ones left to the reference for `on`.
Inside by_tetrahedra(const std::vector<Tetrahedron>& all, const std::vector<Triangle>& triangles,
                     const Vec3& x) {
  bool on = false, odd = false;
  for (const Tetrahedron& t : all) odd = odd != in_tetrahedron(t, x, on);
  for (const Triangle& t : triangles) on = on || reference::intersects({x, x, x}, t);
  if (on) return Inside::on;
  return odd ? Inside::yes : Inside::no;
}

Vec3 whole_point(RandomDraws& random, int most) {
  Vec3 p;
  for (double& x : p) x = random.whole(0, most);
  return p;
}

/// The answer of one ray along the first axis in doubles, which no ray of another direction
/// replaces where it meets an edge: what the tests must notice.
bool by_one_ray(const std::vector<Triangle>& triangles, const Vec3& x) {
  bool odd = false;
  for (const Triangle& t : triangles) {
    const Vec3 n = (t[1] - t[0]).cross(t[2] - t[0]);
    if (n.x() == 0) continue;
    bool hit = n.dot(t[0] - x) / n.x() > 0;
    for (int i = 0; i < 3; ++i) hit = hit && (t[i] - x).cross(t[(i + 1) % 3] - x).x() * n.x() >= 0;
    odd = odd != hit;
  }
  return odd;
}

TEST(Inside, AsTetrahedraSayOnAGrid) {
  RandomDraws random(1);
  int wrong_by_one_ray = 0;
  std::map<Inside, int> seen;
  // The twin: without rays cast again it would be wrong.
  const auto all_seen = [&] {
    return seen[Inside::no] > 25 && seen[Inside::yes] > 25 && seen[Inside::on] > 25 &&
           wrong_by_one_ray > 10;
  };
  for (int n = 0; more_cases(n, trials(400, 100), all_seen()); ++n) {
    std::vector<Tetrahedron> all(1 + random.below(6));
    std::vector<Triangle> triangles;
    const int most = 2 * random.whole(1, 5);
    for (Tetrahedron& t : all) {
      for (Vec3& p : t) p = whole_point(random, most);
      add_faces(t, triangles);
    }
    const Scene scene = scene_of(triangles);
    EXPECT_TRUE(is_closed(scene, 0));
    for (int k = 0; k < 20; ++k) {
      const Vec3 x = whole_point(random, most);
      const Inside truth = by_tetrahedra(all, triangles, x);
      EXPECT_EQ(inside(scene, 0, x), truth);
      ++seen[truth];
      if (truth != Inside::on)
        wrong_by_one_ray += by_one_ray(triangles, x) != (truth == Inside::yes);
    }
  }
}

/// A cube with all normals outwards, or inwards.
std::vector<Triangle> oriented_cube(const Vec3& lo, const Vec3& hi, bool outwards = true) {
  lab::Parts parts;
  parts.box(lo, hi, !outwards);
  std::vector<Triangle> out;
  for (std::uint32_t t = 0; t < 12; ++t) out.push_back(parts.scene.corners(t));
  return out;
}

/// A cube with some normals outwards, and the others inwards.
std::vector<Triangle> cube(const Vec3& lo, const Vec3& hi) {
  std::vector<Triangle> out = oriented_cube(lo, hi);
  for (std::size_t t = 0; t < 6; ++t) std::swap(out[t][1], out[t][2]);
  return out;
}

Scene shells(const std::vector<std::vector<Triangle>>& all) {
  std::vector<Triangle> triangles;
  for (const auto& shell : all) triangles.insert(triangles.end(), shell.begin(), shell.end());
  return scene_of(triangles);
}

// One file often holds shells that overlap. The checker's own code agrees; parity is the twin,
// which calls the overlap outside.
TEST(Inside, OverlappingShellsAreCountedByTheirWindingNumber) {
  const std::vector<Triangle> first = oriented_cube(Vec3(0, 0, 0), Vec3(2, 2, 2));
  const auto second = [](bool outwards) {
    return oriented_cube(Vec3(1, 0.5, 0.5), Vec3(3, 1.5, 1.5), outwards);
  };
  const Scene both = shells({first, second(true)}), against = shells({first, second(false)});
  std::vector<Triangle> one_turned = second(true);
  std::swap(one_turned[0][1], one_turned[0][2]);
  const Scene mixed = shells({first, one_turned});
  EXPECT_EQ(surface_of(both, 0), Surface::oriented);
  EXPECT_EQ(surface_of(against, 0), Surface::oriented);
  EXPECT_EQ(surface_of(mixed, 0), Surface::closed);
  struct Case {
    Vec3 at;
    Inside both, against, parity;
  };
  for (const Case& c : {Case{{1.5, 1, 1}, Inside::yes, Inside::no, Inside::no},
                        Case{{0.5, 1, 1}, Inside::yes, Inside::yes, Inside::yes},
                        Case{{2.5, 1, 1}, Inside::yes, Inside::yes, Inside::yes},
                        Case{{2.5, 1.75, 1}, Inside::no, Inside::no, Inside::no}}) {
    EXPECT_EQ(inside(both, 0, c.at), c.both);
    EXPECT_EQ(inside(against, 0, c.at), c.against);
    EXPECT_EQ(inside(mixed, 0, c.at), c.parity);
    for (const auto& [outer, expected] :
         {std::pair(&both, c.both), std::pair(&against, c.against), std::pair(&mixed, c.parity)}) {
      Scene scene = *outer;
      const Scene part =
          scene_of(oriented_cube(c.at - Vec3(0.01, 0.01, 0.01), c.at + Vec3(0.01, 0.01, 0.01)));
      append_object("part", part.vertices, part.triangles, part.source_face, scene);
      EXPECT_EQ(IntegerInside(scene).which(0, 1),
                expected == Inside::yes ? InsideClaim::b : InsideClaim::none);
    }
  }
}

TEST(Inside, OneUlpDecides) {
  const Scene scene = scene_of(cube(Vec3(0, 0, 0), Vec3(1, 1, 1)));
  const double least = std::numeric_limits<double>::denorm_min();
  EXPECT_EQ(inside(scene, 0, {least, 0.5, 0.5}), Inside::yes);
  EXPECT_EQ(inside(scene, 0, {-least, 0.5, 0.5}), Inside::no);
  EXPECT_EQ(inside(scene, 0, {-0.0, 0.5, 0.5}), Inside::on);
  EXPECT_EQ(inside(scene, 0, {0.5, std::nextafter(1, 0), 0.5}), Inside::yes);
  EXPECT_EQ(inside(scene, 0, {0.5, std::nextafter(1, 2), 0.5}), Inside::no);
  EXPECT_EQ(inside(scene, 0, {least, least, least}), Inside::yes);
}

TEST(Inside, AnOpenMeshHasNone) {
  std::vector<Triangle> triangles = cube(Vec3(0, 0, 0), Vec3(2, 2, 2));
  const Triangle last = triangles.back();
  triangles.pop_back();
  const Scene open = scene_of(triangles);
  EXPECT_FALSE(is_closed(open, 0));
  EXPECT_EQ(inside(open, 0, {1, 1, 1}), Inside::not_closed);
  EXPECT_EQ(inside(open, 0, {9, 9, 9}), Inside::not_closed);
  EXPECT_EQ(inside(open, 0, {0, 1, 1}), Inside::on);
  // Triangles with two equal corners do not close it, nor do they open what is closed.
  triangles.push_back({last[0], last[1], last[0]});
  EXPECT_FALSE(is_closed(scene_of(triangles), 0));
  triangles.push_back(last);
  EXPECT_TRUE(is_closed(scene_of(triangles), 0));
  EXPECT_EQ(inside(scene_of(triangles), 0, {1, 1, 1}), Inside::yes);
  // A triangle given twice has each edge twice, and no inside.
  const Scene twice = scene_of({last, last});
  EXPECT_TRUE(is_closed(twice, 0));
  EXPECT_EQ(inside(twice, 0, {1, 1, 1}), Inside::no);
}

// Whatever the direction of a ray, it does not tell on which side it passes a segment on whose line
// it begins. No ray in general position crosses a segment.
TEST(Inside, IsDecidedOnTheLineOfATriangleThatIsASegment) {
  for (const Vec3& d : {Vec3(1, 0, 0), Vec3(0, 1, 0), Vec3(1, 1, 1), Vec3(1, 0.5, -0.25)}) {
    std::vector<Triangle> triangles = cube(Vec3(-5, -5, -5), Vec3(5, 5, 5));
    const Triangle segment = {d, 2 * d, 3 * d};
    triangles.insert(triangles.end(), {segment, segment});
    const Scene scene = scene_of(triangles);
    ASSERT_TRUE(is_closed(scene, 0));
    EXPECT_EQ(inside(scene, 0, {0, 0, 0}), Inside::yes);
    EXPECT_EQ(inside(scene, 0, 4 * d), Inside::yes);
    EXPECT_EQ(inside(scene, 0, 2.5 * d), Inside::on);
    EXPECT_EQ(inside(scene, 0, 6 * d), Inside::no);
    EXPECT_EQ(inside(scene, 0, -6 * d), Inside::no);
  }
  const Scene kept =
      load_scene({std::string(FARCULL_TEST_DIR) + "/cases/inside-on-the-line-of-a-segment.json"});
  ASSERT_EQ(kept.objects.size(), 2u);
  EXPECT_TRUE(is_closed(kept, 0));
  EXPECT_EQ(inside(kept, 0, kept.corners(kept.objects[1].first_triangle)[0]), Inside::no);
  EXPECT_EQ(inside(kept, 0, {3.5, 0.25, 0.5}), Inside::yes);
}

TEST(Inside, ZerosOfEitherSignAreOnePosition) {
  std::vector<Triangle> triangles = cube(Vec3(0, 0, 0), Vec3(2, 2, 2));
  for (Vec3& p : triangles[0])
    for (double& x : p) x = x == 0 ? -0.0 : x;
  EXPECT_TRUE(is_closed(scene_of(triangles), 0));
}

TEST(Inside, OfOneObjectOfAScene) {
  const Scene scene = reference::scene_of(
      {cube(Vec3(0, 0, 0), Vec3(2, 2, 2)), {}, cube(Vec3(1, 1, 1), Vec3(5, 5, 5))});
  EXPECT_EQ(inside(scene, 0, {0.5, 0.5, 0.5}), Inside::yes);
  EXPECT_EQ(inside(scene, 1, {0.5, 0.5, 0.5}), Inside::no);
  EXPECT_EQ(inside(scene, 2, {0.5, 0.5, 0.5}), Inside::no);
  EXPECT_EQ(inside(scene, 2, {3, 3, 3}), Inside::yes);
  EXPECT_TRUE(is_closed(scene, 1));
  EXPECT_THROW(inside(scene, 3, {3, 3, 3}), std::logic_error);
  EXPECT_THROW(is_closed(scene, 3), std::logic_error);
}

}  // namespace
}  // namespace farcull
