// Kinds of contact and common segments: examples of each kind, CGAL's intersection of triangles in
// rational numbers, and what other functions say of the same pairs. tests/oracles/kinds.py has
// another reference.
#include "verify/contact.h"

#include <CGAL/Simple_cartesian.h>
#include <CGAL/intersections.h>
#include <CGAL/mpq_class.h>

#include "tests/lab/closest.h"
#include "tests/lab/hard_pairs.h"
#include "tests/lab/rational.h"
#include "tests/lab/test.h"
#include "verify/exact.h"

namespace farcull {
namespace {

using rational::Random, reference::kMax, reference::kPermutations, reference::kTiny,
    reference::reordered, reference::Triangle;

/// The kind and the shape under every order of arguments and corners; the shape of the first.
ContactShape expect_kind(const std::string& expected, int dimension, const Triangle& a,
                         const Triangle& b) {
  const ContactShape first = contact_shape(a, b);
  EXPECT_EQ(name_of(first.kind), expected);
  EXPECT_EQ(first.dimension, dimension) << expected;
  EXPECT_EQ(intersects(a, b), first.kind != ContactKind::apart);
  for (const auto& i : kPermutations) {
    for (const auto& j : kPermutations) {
      EXPECT_EQ(contact_shape(reordered(a, i), reordered(b, j)), first);
      EXPECT_EQ(contact_shape(reordered(b, j), reordered(a, i)), first);
      EXPECT_EQ(contact_kind(reordered(a, i), reordered(b, j)), first.kind);
      EXPECT_EQ(contact_kind(reordered(b, j), reordered(a, i)), first.kind);
      EXPECT_EQ(penetrate(reordered(a, i), reordered(b, j)), first.kind == ContactKind::crossing);
    }
  }
  return first;
}

Triangle segment(const Vec3& p, const Vec3& q) { return {p, (p + q) / 2, q}; }

const Triangle kPlate = {Vec3(0, 0, 0), Vec3(8, 0, 0), Vec3(0, 8, 0)};
const Triangle kPoint = {Vec3(2, 2, 0), Vec3(2, 2, -0.0), Vec3(2, 2, 0)};

TEST(ContactKind, OnePointInCommon) {
  expect_kind("touch-vertex", 0, kPlate, {Vec3(2, 2, 0), Vec3(2, 3, 4), Vec3(3, 2, 4)});
  expect_kind("touch-vertex", 0, kPlate, {Vec3(4, 4, 0), Vec3(9, 9, 4), Vec3(9, 9, 5)});
  expect_kind("touch-vertex", 0, kPlate, {Vec3(0, 0, 0), Vec3(-1, 0, 4), Vec3(0, -1, 4)});
  expect_kind("touch-vertex", 0, kPlate, {Vec3(8, 0, 0), Vec3(9, 0, 0), Vec3(9, 1, 0)});
  const Triangle across = {Vec3(2, 0, -3), Vec3(2, 0, 3), Vec3(2, -4, 1)};
  const ContactShape edges = expect_kind("touch-edge", 0, kPlate, across);
  EXPECT_EQ(edges.ends[0], Vec3(2, 0, 0));
  EXPECT_EQ(edges.ends[1], Vec3(2, 0, 0));
}

TEST(ContactKind, MoreThanOnePointInCommon) {
  expect_kind("touch-face", 1, kPlate, {Vec3(1, 1, 0), Vec3(3, 3, 0), Vec3(2, 2, 5)});
  expect_kind("touch-face", 1, kPlate, {Vec3(0, 0, 0), Vec3(8, 0, 0), Vec3(4, 0, 5)});
  expect_kind("coplanar", 2, kPlate, {Vec3(1, 1, 0), Vec3(2, 1, 0), Vec3(1, 2, 0)});
  expect_kind("coplanar", 1, kPlate, {Vec3(2, 0, 0), Vec3(6, 0, 0), Vec3(4, -4, 0)});
  expect_kind("equal", 2, kPlate, kPlate);
  const ContactShape through =
      expect_kind("crossing", 1, kPlate, {Vec3(2, 1, -1), Vec3(2, 1, 1), Vec3(2, 3, 0)});
  EXPECT_EQ(through.ends[0], Vec3(2, 1, 0));
  EXPECT_EQ(through.ends[1], Vec3(2, 3, 0));
  expect_kind("crossing", 1, kPlate, {Vec3(0, 0, 0), Vec3(5, 5, 2), Vec3(5, 5, -2)});
}

TEST(ContactKind, OneUlpDecides) {
  const auto spike = [](double z) { return Triangle{Vec3(2, 2, z), Vec3(2, 3, 4), Vec3(3, 2, 4)}; };
  expect_kind("touch-vertex", 0, kPlate, spike(0));
  expect_kind("crossing", 1, kPlate, spike(-kTiny));
  expect_kind("apart", -1, kPlate, spike(kTiny));
}

TEST(ContactKind, DegenerateTrianglesAreSegmentsAndPoints) {
  expect_kind("crossing", 0, kPlate, segment({2, 2, -1}, {2, 2, 1}));
  expect_kind("touch-vertex", 0, kPlate, segment({2, 2, 0}, {2, 2, 2}));
  expect_kind("touch-edge", 0, kPlate, segment({2, 0, -1}, {2, 0, 1}));
  expect_kind("touch-vertex", 0, kPlate, segment({0, 0, -1}, {0, 0, 1}));
  expect_kind("coplanar", 1, kPlate, segment({1, 1, 0}, {3, 2, 0}));
  expect_kind("touch-edge", 0, segment({-1, 0, 0}, {1, 0, 0}), segment({0, -1, 0}, {0, 1, 0}));
  expect_kind("touch-vertex", 0, segment({-1, 0, 0}, {1, 0, 0}), segment({1, 0, 0}, {2, 1, 0}));
  expect_kind("coplanar", 1, segment({-1, 0, 0}, {1, 0, 0}), segment({0, 0, 0}, {4, 0, 0}));
  expect_kind("equal", 1, segment({-1, 2, 0}, {1, 4, 2}), segment({1, 4, 2}, {-1, 2, 0}));
  expect_kind("apart", -1, segment({-1, 0, 0}, {1, 0, 0}), segment({2, 0, 0}, {4, 0, 0}));
  expect_kind("touch-vertex", 0, kPlate, kPoint);
  expect_kind("touch-vertex", 0, segment({2, 2, -2}, {2, 2, 2}), kPoint);
  expect_kind("equal", 0, kPoint, kPoint);
  const Triangle beside = {Vec3(2, 2, kTiny), Vec3(2, 2, kTiny), Vec3(2, 2, kTiny)};
  expect_kind("apart", -1, kPoint, beside);
}

TEST(ContactKind, TheEndsOfTheDoubles) {
  const Triangle wide = {Vec3(-kMax, -kMax, 0), Vec3(kMax, -kMax, 0), Vec3(0, kMax, 0)};
  expect_kind("crossing", 1, wide, {Vec3(0, 0, -kTiny), Vec3(kTiny, 0, kTiny), Vec3(0, 0, kTiny)});
  const ContactShape tall =
      expect_kind("crossing", 1, wide, {Vec3(0, 0, -kMax), Vec3(kMax, 1, kMax), Vec3(0, 3, kMax)});
  EXPECT_EQ(tall.ends[1], Vec3(kMax / 2, 0.5, 0));
}

TEST(ContactShape, EndsAreRoundedOnceToTheNearestDouble) {
  // The plane z = 0 is met a third of the way from the first corner to each of the others.
  const Triangle tilted = {Vec3(1, 1, -1), Vec3(2, 1, 2), Vec3(1, 2, 2)};
  const ContactShape shape = contact_shape(kPlate, tilted);
  EXPECT_EQ(shape.ends[0], Vec3(1, 1 + 1.0 / 3, 0));
  EXPECT_EQ(shape.ends[1], Vec3(1 + 1.0 / 3, 1, 0));
  // Halfway between two subnormal numbers: to the even one, and never -0.0.
  const Triangle flat = {Vec3(-1, -1, 0), Vec3(1, -1, 0), Vec3(0, 2, 0)};
  const Triangle small = {Vec3(0, 0, -1), Vec3(-kTiny, 0, 1), Vec3(3 * kTiny, 0, 1)};
  const ContactShape tiny = contact_shape(flat, small);
  EXPECT_EQ(tiny.ends[0].x(), 0.0);
  EXPECT_FALSE(std::signbit(tiny.ends[0].x()));
  EXPECT_EQ(tiny.ends[1].x(), 2 * kTiny);
}

using Kernel = CGAL::Simple_cartesian<mpq_class>;
using Rational = mpq_class;

Kernel::Triangle_3 in_cgal(const Triangle& t) {
  const auto point = [](const Vec3& p) {
    return Kernel::Point_3(Rational(p.x()), Rational(p.y()), Rational(p.z()));
  };
  return {point(t[0]), point(t[1]), point(t[2])};
}

/// Whether CGAL finds the same common points. Precondition: no degenerate triangle.
bool as_cgal_says(const ContactShape& shape, const Triangle& a, const Triangle& b) {
  const auto near = [](const Vec3& end, const Kernel::Point_3& p) {
    return closest_reference::is_rounded(end.x(), p.x()) &&
           closest_reference::is_rounded(end.y(), p.y()) &&
           closest_reference::is_rounded(end.z(), p.z());
  };
  const auto found = CGAL::intersection(in_cgal(a), in_cgal(b));
  if (!found) return shape.dimension == -1;
  if (const auto* p = boost::get<Kernel::Point_3>(&*found))
    return shape.dimension == 0 && near(shape.ends[0], *p) && near(shape.ends[1], *p);
  if (const auto* s = boost::get<Kernel::Segment_3>(&*found))
    return shape.dimension == 1 && near(shape.ends[0], s->min()) && near(shape.ends[1], s->max());
  std::vector<Kernel::Point_3> corners;
  if (const auto* t = boost::get<Kernel::Triangle_3>(&*found))
    corners = {t->vertex(0), t->vertex(1), t->vertex(2)};
  else
    corners = boost::get<std::vector<Kernel::Point_3>>(*found);
  const std::vector<Vec3> polygon = contact_polygon(a, b);
  return shape.dimension == 2 && polygon.size() >= 3 && polygon.size() <= corners.size() &&
         std::ranges::all_of(polygon, [&](const Vec3& end) {
           return std::ranges::any_of(corners, [&](const auto& p) { return near(end, p); });
         });
}

/// Triangles with corners of few values, so that corners, edges and planes often coincide.
struct Drawn {
  Triangle a, b;
};
Drawn draw(Random& random, int n) {
  std::array<double, 5> values{};
  for (double& value : values) {
    value = n % 3 == 0   ? random.below(4)
            : n % 3 == 1 ? random.uniform(-1, 1)
                         : random.scaled(-40, 40);
  }
  const auto triangle = [&] {
    Triangle t;
    for (Vec3& p : t)
      for (int axis = 0; axis < 3; ++axis) p[axis] = values[random.below(5)];
    return t;
  };
  Drawn out = {triangle(), triangle()};
  if (n % 4 == 0) {  // in one plane
    for (Triangle* t : {&out.a, &out.b})
      for (Vec3& p : *t) p.z() = values[0];
  }
  return out;
}

TEST(ContactShape, AsCgalsIntersectionInRationalNumbers) {
  Random random(601);
  std::array<int, 4> of_dimension{};
  int noticed = 0;
  for (int n = 0; n < 3000; ++n) {
    const auto [a, b] = draw(random, n);
    if (shape(a) != Shape::triangle || shape(b) != Shape::triangle) continue;
    ContactShape found = contact_shape(a, b);
    ASSERT_TRUE(as_cgal_says(found, a, b)) << "pair " << n;
    ++of_dimension[found.dimension + 1];
    if (found.dimension != 1) continue;
    // The twin: an end that is moved by two units in the last place is noticed.
    double& x = found.ends[1].y();
    for (int step = 0; step < 2; ++step) x = std::nextafter(x, kMax);
    noticed += !as_cgal_says(found, a, b);
  }
  for (const int count : of_dimension) EXPECT_GT(count, 30);
  EXPECT_EQ(noticed, of_dimension[2]);
}

/// Pairs of which the kind does not fit what verify/exact and verify/contact say of them. `kind` is
/// replaced by the twin.
template <class Kind>
int misfits(const Triangle& a, const Triangle& b, const Kind& kind) {
  const ContactKind found = kind(a, b);
  return (found == ContactKind::apart) == intersects(a, b) ||
         (found == ContactKind::crossing) != penetrate(a, b);
}

TEST(ContactKind, FitsTheOtherPredicatesAmongPairsThatAreHard) {
  const auto by_shape = [](const Triangle& a, const Triangle& b) {
    return contact_shape(a, b).kind;
  };
  // The twin: coordinates that are rounded to float first.
  const auto rounded = [](const Triangle& a, const Triangle& b) {
    const auto cut = [](Triangle t) {
      for (Vec3& p : t) p = p.cast<float>().cast<double>();
      return t;
    };
    return contact_shape(cut(a), cut(b)).kind;
  };
  int wrong = 0, caught = 0;
  RandomDraws random(602);
  for (const auto& [name, make] : hard_pairs::generators()) {
    for (int n = 0; n < 60; ++n) {
      DrawnPair pair = make(random);
      if (!hard_pairs::finite(pair)) continue;
      hard_pairs::share(static_cast<hard_pairs::Sharing>(n % 3), pair.a, pair.b);
      wrong += misfits(pair.a, pair.b, by_shape);
      wrong += contact_kind(pair.a, pair.b) != by_shape(pair.a, pair.b);
      const bool small = std::max(pair.a[0].cwiseAbs().maxCoeff(), pair.b[0].norm()) < 1e30;
      if (small) caught += misfits(pair.a, pair.b, rounded);
    }
  }
  EXPECT_EQ(wrong, 0);
  EXPECT_GT(caught, 0);
}

TEST(ContactKind, EveryPairOnAGridHasOneKind) {
  std::vector<Triangle> all;
  const auto corner = [](int i) { return Vec3(i % 2, i / 2 % 2, i / 4); };
  for (int i = 0; i < 8; ++i) {
    for (int j = i; j < 8; ++j)
      for (int k = j; k < 8; ++k) all.push_back({corner(i), corner(j), corner(k)});
  }
  std::array<int, kContactKinds.size()> of_kind{};
  int wrong = 0;
  for (std::size_t i = 0; i < all.size(); ++i) {
    for (std::size_t j = i; j < all.size(); ++j) {
      const ContactKind kind = contact_shape(all[i], all[j]).kind;
      ++of_kind[static_cast<std::size_t>(kind)];
      wrong += kind != contact_kind(all[j], all[i]);
      wrong += misfits(all[i], all[j], contact_kind);
    }
  }
  EXPECT_EQ(wrong, 0);
  for (const ContactKind kind : kContactKinds)
    EXPECT_GT(of_kind[static_cast<std::size_t>(kind)], 0) << name_of(kind);
}

TEST(ContactShape, ThePolygonOfTrianglesInOnePlane) {
  const Triangle a = {Vec3(0, 0, 1), Vec3(6, 0, 1), Vec3(0, 6, 1)};
  const Triangle b = {Vec3(1, 1, 1), Vec3(7, 1, 1), Vec3(1, 7, 1)};
  const std::vector<Vec3> common = {Vec3(1, 1, 1), Vec3(1, 5, 1), Vec3(5, 1, 1)};
  const Triangle star = {Vec3(4, 4, 1), Vec3(-2, 4, 1), Vec3(4, -2, 1)};
  const std::vector<Vec3> six = {Vec3(0, 2, 1), Vec3(0, 4, 1), Vec3(2, 4, 1),
                                 Vec3(4, 2, 1), Vec3(4, 0, 1), Vec3(2, 0, 1)};
  for (const auto& i : kPermutations) {
    for (const auto& j : kPermutations) {
      EXPECT_EQ(contact_polygon(reordered(a, i), reordered(b, j)), common);
      EXPECT_EQ(contact_polygon(reordered(b, j), reordered(a, i)), common);
      EXPECT_EQ(contact_polygon(reordered(star, j), reordered(a, i)), six);
    }
  }
  EXPECT_EQ(contact_polygon(a, a),
            (std::vector<Vec3>{Vec3(0, 0, 1), Vec3(0, 6, 1), Vec3(6, 0, 1)}));
  // No polygon: a segment of an edge, a point, and nothing.
  EXPECT_TRUE(contact_polygon(a, {Vec3(1, 0, 1), Vec3(2, 0, 1), Vec3(1, -1, 1)}).empty());
  EXPECT_TRUE(contact_polygon(a, {Vec3(0, 0, 1), Vec3(-2, 0, 1), Vec3(0, -1, 1)}).empty());
  EXPECT_TRUE(contact_polygon(a, {Vec3(0, 0, 2), Vec3(6, 0, 2), Vec3(0, 6, 2)}).empty());
}

// Kinds and shapes of all pairs; counts of those that meet.
TEST(ContactKinds, AndCountsAreThoseOfEachPairWhateverTheThreads) {
  Random random(502);
  const Scene scene = reference::soup(random, 100, 5);
  std::vector<TrianglePair> pairs, meeting;
  std::vector<ContactKind> kinds;
  std::vector<ContactShape> shapes;
  ContactCounts counts;
  for (std::uint32_t a = 0; a < 100; ++a) {
    for (std::uint32_t b = a + 1; b < 100; ++b) {
      pairs.push_back({a, b});
      shapes.push_back(contact_shape(scene.corners(a), scene.corners(b)));
      kinds.push_back(shapes.back().kind);
      if (kinds.back() == ContactKind::apart) continue;
      meeting.insert(meeting.end(), 2, {a, b});  // a pair that is given twice counts twice
      (kinds.back() == ContactKind::crossing ? counts.penetrating : counts.touching) += 2;
    }
  }
  EXPECT_GT(meeting.size(), 2048u);  // enough for more than one thread
  EXPECT_GT(counts.touching, 0u);
  EXPECT_GT(counts.penetrating, 0u);
  for (const unsigned threads : {0u, 1u, 2u, 7u}) {
    EXPECT_EQ(contact_kinds(scene, pairs, threads), kinds);
    EXPECT_EQ(contact_shapes(scene, pairs, threads), shapes);
    EXPECT_EQ(count_contacts(scene, meeting, threads), counts);
  }
  EXPECT_TRUE(contact_kinds(scene, {}).empty());
  EXPECT_EQ(count_contacts(scene, {}), ContactCounts{});
  const std::vector<TrianglePair> beyond = {{0, 100}}, twice = {{1, 1}};
  EXPECT_THROW(contact_kinds(scene, beyond), std::logic_error);
  EXPECT_THROW(count_contacts(scene, beyond), std::logic_error);
  EXPECT_THROW(count_contacts(scene, twice), std::logic_error);
}

TEST(ContactKinds, HaveNamesThatAreReadBack) {
  for (const ContactKind kind : kContactKinds) EXPECT_EQ(parse_contact_kind(name_of(kind)), kind);
  EXPECT_FALSE(parse_contact_kind("touch"));
  EXPECT_FALSE(parse_contact_kind(""));
}

}  // namespace
}  // namespace farcull
