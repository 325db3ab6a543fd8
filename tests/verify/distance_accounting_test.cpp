// The accounting of distances: its bounds against rational numbers, and wrong answers that it has
// to find.
#include "verify/distance_accounting.h"

#include "tests/lab/distances.h"
#include "tests/lab/hard_pairs.h"
#include "tests/lab/test.h"
#include "verify/exact.h"
#include "verify/separation.h"

namespace farcull {
namespace {

using distance_lab::Q;
using Kind = DistanceQuestion::Kind;

Fraction fraction(const Q& x) { return {x.get_num(), x.get_den()}; }
double root_above(const Q& squared) { return root_above(fraction(squared)); }

/// Two triangles some way from each other, of a size and at a place of any magnitude.
std::array<std::array<Vec3, 3>, 2> random_pair(rational::Draws& random) {
  const double unit = std::exp2(random.below(3) == 0 ? random.uniform(-1060, 1000) : 0);
  const Vec3 apart = random.cube(std::exp2(random.uniform(-10, 10)) * unit);
  std::array<std::array<Vec3, 3>, 2> out;
  for (Vec3& p : out[0]) p = random.cube(unit);
  for (Vec3& p : out[1]) p = random.cube(unit) + apart;
  if (random.below(5) == 0) out[1][1] = out[1][0];
  return out;
}

BoundsTree::Bounds bounds_of(const std::array<Vec3, 3>& t) {
  BoundsTree::Bounds out;
  for (int k = 0; k < 3; ++k)
    std::tie(out.lo[k], out.hi[k]) = std::minmax({t[0][k], t[1][k], t[2][k]});
  return out;
}

double moved_by_ulps(double x, int ulps) {
  for (; ulps > 0; --ulps) x = std::nextafter(x, HUGE_VAL);
  for (; ulps < 0; ++ulps) x = std::nextafter(x, 0);
  return x;
}

TEST(Separation, IsProvedOnlyWhereTrianglesAreFartherApart) {
  rational::Draws random(1);
  int wrong = 0, by_planes = 0, by_boxes = 0, farther = 0, twin_wrong = 0;
  for (int k = 0; more_cases(k, trials(4'000), twin_wrong > 0 && by_boxes > 12); ++k) {
    const auto [a, b] = random_pair(random);
    const Q squared = distance_lab::squared_distance(a, b);
    // Around the distance, by ulps or by a part of it.
    const double root = root_above(squared);
    const double limit = random.coin() ? moved_by_ulps(root, random.below(40) - 30)
                                       : std::min(root * random.uniform(0.8, 1.1), 1e308);
    const bool is_farther = squared > Q(limit) * Q(limit);
    farther += is_farther;
    const auto boxes = separation::farther(bounds_of(a), bounds_of(b), limit);
    const bool planes = separation::farther_by_planes(a, b, limit);
    by_boxes += boxes;
    by_planes += planes;
    wrong += (boxes || planes) && !is_farther;
    twin_wrong += separation::farther_by_planes(a, b, limit * (1 - 0x1p-40)) && !is_farther;
  }
  EXPECT_EQ(wrong, 0);
  EXPECT_GT(by_planes, farther / 3);
}

TEST(Separation, OfBoxesKeepsWhatMayBeAsNear) {
  const double big = 1.5e308;
  const BoundsTree::Bounds a = {{0, 0, 0}, {1, 1, 1}}, b = {{4, 5, 0}, {6, 6, 6}};
  EXPECT_TRUE(separation::farther(a, b, 4.999));
  EXPECT_FALSE(separation::farther(a, b, 5));
  const BoundsTree::Bounds far = {{big, big, 0}, {big, big, 0}};
  EXPECT_TRUE(separation::farther(a, far, 1e308));
  EXPECT_FALSE(separation::farther(a, far, 1.7e308));  // whose squares overflow
  const double tiny = std::numeric_limits<double>::denorm_min();
  const BoundsTree::Bounds near = {{1 + 0x1p-52, 0, 0}, {2, 2, 2}};
  EXPECT_TRUE(separation::farther(a, near, tiny));
}

TEST(DistanceClaims, RootsAreRoundedOnce) {
  rational::Draws random(2);
  for (int k = 0; k < trials(20'000); ++k) {
    const double x = std::abs(random.scaled(-1070, 1020));
    const Q square = Q(x) * Q(x);
    EXPECT_TRUE(is_rounded_root(x, fraction(square)));
    EXPECT_FALSE(is_rounded_root(moved_by_ulps(x, 1), fraction(square)));
    EXPECT_FALSE(is_rounded_root(moved_by_ulps(x, -1), fraction(square)));
    // Halfway to the next double: the even one.
    const Q middle = (Q(x) + Q(std::nextafter(x, HUGE_VAL))) / 2;
    const Fraction tie = fraction(middle * middle);
    EXPECT_NE(is_rounded_root(x, tie), is_rounded_root(std::nextafter(x, HUGE_VAL), tie));
    const Q other = square * Q(random.uniform(0.5, 2));
    EXPECT_EQ(is_rounded_root(x, fraction(other)), closest_reference::is_rounded_root(x, other));
  }
  EXPECT_TRUE(is_rounded_root(0.0, {}));
  EXPECT_FALSE(is_rounded_root(std::numeric_limits<double>::denorm_min(), {}));
  EXPECT_FALSE(is_rounded_root(HUGE_VAL, square_of(1e308)));
  EXPECT_TRUE(is_rounded_root(HUGE_VAL, fraction(4 * Q(1e308) * Q(1e308))));
}

struct Case {
  Scene scene;
  DistanceOptions options;
  std::vector<ClaimedDistance> claims;

  DistanceAccounting account(const std::vector<ClaimedDistance>& of) const {
    return account_distances(scene, of,
                             {.kind = options.pairs, .k = options.k, .within = options.within});
  }
};

double rounded(const Q& x) {
  double out = x.get_d() + 0.0;  // cut off; never -0.0
  while (!closest_reference::is_rounded(out, x))
    out = std::nextafter(out, x > 0 ? HUGE_VAL : -HUGE_VAL) + 0.0;
  return out;
}

ClaimedDistance claim_of(const Scene& scene, std::uint32_t a, std::uint32_t b,
                         const TrianglePair& pair) {
  const auto closest =
      closest_reference::closest_points(scene.corners(pair.a), scene.corners(pair.b));
  const Q& squared = closest.squared;
  double root = root_above(squared);
  while (!closest_reference::is_rounded_root(root, squared)) root = std::nextafter(root, 0);
  ClaimedDistance out{
      a, b, pair, root, squared.get_num().get_str() + "/" + squared.get_den().get_str(), {}, {}};
  for (std::size_t side = 0; side < 2; ++side) {
    out.features[side] = number_of(closest.features[side]);
    for (int k = 0; k < 3; ++k)
      out.points[side][k] = rounded(closest.points[side][static_cast<std::size_t>(k)]);
  }
  return out;
}

std::vector<ClaimedDistance> right_answers(const Scene& scene, const DistanceOptions& options) {
  std::vector<ClaimedDistance> out;
  for (const auto& [objects, pair, squared] : distance_lab::Truth(scene).answers(options)) {
    out.push_back(claim_of(scene, objects.a, objects.b, pair));
    EXPECT_EQ(Q(out.back().squared), squared);
  }
  return out;
}

std::vector<Case> cases(Kind kind, int count) {
  rational::Draws random(3 + static_cast<int>(kind));
  std::vector<Case> out;
  while (static_cast<int>(out.size()) < count) {
    Case one{distance_lab::random_scene(random, 3 + random.below(3), 10), {}, {}};
    double most = 0;
    for (const Vec3& p : one.scene.vertices) most = std::max(most, p.cwiseAbs().maxCoeff());
    one.options.pairs = kind;
    one.options.k = 1 + random.below(2u);
    if (kind == Kind::all || random.coin()) one.options.within = std::min(most, 1e300) / 8;
    one.claims = right_answers(one.scene, one.options);
    if (one.claims.size() > 1) out.push_back(std::move(one));
  }
  return out;
}

TEST(DistanceAccounting, AcceptsRightAnswers) {
  for (const Kind kind : {Kind::objects, Kind::nearest, Kind::all}) {
    for (const Case& one : cases(kind, trials(40))) {
      const DistanceAccounting found = one.account(one.claims);
      EXPECT_TRUE(found.holds());
      EXPECT_TRUE(found.adds_up());
      EXPECT_EQ(found.answers, one.claims.size());
    }
  }
}

/// The last pair of two objects that is as near as this one.
TrianglePair last_as_near(const Scene& scene, const ClaimedDistance& claim) {
  const Object &x = scene.objects[claim.a], &y = scene.objects[claim.b];
  for (std::uint32_t i = x.first_triangle + x.triangle_count; i-- > x.first_triangle;) {
    for (std::uint32_t j = y.first_triangle + y.triangle_count; j-- > y.first_triangle;)
      if (distance_lab::squared_distance(scene.corners(i), scene.corners(j)) == Q(claim.squared))
        return {i, j};
  }
  return claim.pair;
}

/// Pairs of triangles of the objects that are nearer than the claim, by rational numbers; or as
/// near, before it and behind it. Neighbours do not count.
struct Counted {
  std::uint64_t nearer = 0, before = 0, behind = 0;
};
Counted counted(const Scene& scene, const ClaimedDistance& claim) {
  const auto& [a, b] = std::pair(claim.a, claim.b);
  const Q squared(claim.squared);
  Counted out;
  const Object &x = scene.objects[a], &y = scene.objects[b];
  for (std::uint32_t i = x.first_triangle; i < x.first_triangle + x.triangle_count; ++i) {
    const std::uint32_t first = a == b ? i + 1 : y.first_triangle;
    for (std::uint32_t j = first; j < y.first_triangle + y.triangle_count; ++j) {
      const std::array<Vec3, 3> s = scene.corners(i), t = scene.corners(j);
      if (a == b && share_position(s, t)) continue;
      const Q of = distance_lab::squared_distance(s, t);
      out.nearer += of < squared;
      out.before += of == squared && TrianglePair{i, j} < claim.pair;
      out.behind += of == squared && claim.pair < TrianglePair{i, j};
    }
  }
  return out;
}

// Scenes on a grid of any scale: pairs that tie, that touch and that are degenerate.
TEST(DistanceAccounting, MissedPairsAreThoseOfRationalNumbers) {
  rational::Draws random(17);
  std::uint64_t nearer = 0, before = 0, behind = 0;
  // Few scenes have ties, so that all of them are needed under sanitizers too.
  for (const Case& one : cases(Kind::objects, 16)) {
    // Each answer names any pair of its objects, with its own distance; or the last of the nearest.
    std::vector<ClaimedDistance> claims = right_answers(one.scene, {.pairs = Kind::objects});
    Counted expected;
    for (ClaimedDistance& claim : claims) {
      const Object &a = one.scene.objects[claim.a], &b = one.scene.objects[claim.b];
      if (claim.a != claim.b) {
        const TrianglePair any = {a.first_triangle + random.below(a.triangle_count),
                                  b.first_triangle + random.below(b.triangle_count)};
        claim = claim_of(one.scene, claim.a, claim.b,
                         random.coin() ? any : last_as_near(one.scene, claim));
      }
      const Counted found = counted(one.scene, claim);
      expected.nearer += found.nearer;
      expected.before += found.before;
      behind += found.behind;
    }
    const DistanceAccounting found = account_distances(one.scene, claims, {});
    ASSERT_EQ(found.nearer, expected.nearer);
    ASSERT_EQ(found.earlier, expected.before);
    ASSERT_EQ(found.wrong, 0u);
    ASSERT_EQ(found.holds(), expected.nearer + expected.before == 0);
    nearer += expected.nearer;
    before += expected.before;
  }
  EXPECT_GT(nearer, 50u);
  EXPECT_GT(before, 10u);
  // The twin: to count pairs behind the answer as well would be noticed.
  EXPECT_GT(behind, 10u);
}

// Slivers, points, huge and tiny ones: a triangle, one that is all but as near, and one that ties.
TEST(DistanceAccounting, HardPairsAreDecidedAsByRationalNumbers) {
  std::uint64_t nearer = 0, farther = 0, ties = 0;
  RandomDraws random(21);
  rational::Draws draws(22);
  const auto expect_decided = [&](const DrawnPair& pair) {
    std::array<Vec3, 3> other = {pair.b[1], pair.b[2], pair.b[0]};
    if (draws.coin()) {
      double& x = other[draws.below(3u)][draws.below(3u)];
      x = std::nextafter(x, draws.coin() ? 1e300 : -1e300);
    }
    const Scene scene = reference::scene_of({{pair.a}, {pair.b, other}});
    const ClaimedDistance claim = claim_of(scene, 0, 1, {0, 1});
    const Q beside = distance_lab::squared_distance(pair.a, other);
    const int order = cmp(beside, Q(claim.squared));
    (order < 0 ? nearer : order > 0 ? farther : ties) += 1;
    const DistanceAccounting found = account_distances(scene, std::array{claim}, {.threads = 1});
    ASSERT_EQ(found.nearer, order < 0 ? 1u : 0u);
    ASSERT_EQ(found.wrong, 0u);
  };
  for (const auto& [name, make] : hard_pairs::generators()) {
    SCOPED_TRACE(name);
    for (int k = 0; k < trials(60); ++k) {
      const DrawnPair pair = make(random);
      if (hard_pairs::finite(pair)) expect_decided(pair);
    }
  }
  for (const PairGenerator& generator : pair_generators()) {
    SCOPED_TRACE(generator.name);
    for (int k = 0; k < trials(60); ++k) expect_decided(generator.make(random));
  }
  EXPECT_GT(nearer, static_cast<std::uint64_t>(trials(30)));
  EXPECT_GT(farther, static_cast<std::uint64_t>(trials(30)));
  EXPECT_GT(ties, static_cast<std::uint64_t>(trials(30)));
}

TEST(DistanceAccounting, FindsAnAnswerThatIsMissing) {
  for (const Kind kind : {Kind::objects, Kind::nearest, Kind::all}) {
    for (const Case& one : cases(kind, trials(16))) {
      for (std::size_t k = 0; k < one.claims.size(); k += 1 + one.claims.size() / 8) {
        auto claims = one.claims;
        claims.erase(claims.begin() + static_cast<std::ptrdiff_t>(k));
        const DistanceAccounting found = one.account(claims);
        EXPECT_GT(found.nearer, 0u) << static_cast<int>(kind);
        EXPECT_TRUE(std::ranges::binary_search(found.examples, one.claims[k].pair) ||
                    found.nearer > found.examples.size() || kind != Kind::all);
      }
    }
  }
}

TEST(DistanceAccounting, FindsADistanceThatIsOneBitOff) {
  for (const Kind kind : {Kind::objects, Kind::nearest, Kind::all}) {
    for (const Case& one : cases(kind, trials(16))) {
      for (const int ulps : {-1, 1}) {
        auto claims = one.claims;
        if (claims.back().distance == 0 && ulps < 0) continue;
        claims.back().distance = moved_by_ulps(claims.back().distance, ulps);
        EXPECT_EQ(one.account(claims).wrong, 1u);
      }
      auto claims = one.claims;
      claims.front().squared = "1" + claims.front().squared;
      EXPECT_GE(one.account(claims).wrong, 1u);
    }
  }
}

TEST(DistanceAccounting, FindsPointsAndFeaturesThatAreNotTheFirstNearest) {
  rational::Draws random(23);
  for (const Kind kind : {Kind::objects, Kind::nearest, Kind::all}) {
    for (const Case& one : cases(kind, trials(8))) {
      const auto wrong = [&](const std::function<void(ClaimedDistance&)>& change) {
        auto claims = one.claims;
        change(claims[random.below(claims.size())]);
        return one.account(claims).wrong;
      };
      const std::size_t side = random.below(2u);
      const int axis = static_cast<int>(random.below(3u));
      EXPECT_EQ(wrong([&](ClaimedDistance& c) {
                  double& x = c.points[side][axis];
                  x = std::nextafter(x, random.coin() ? HUGE_VAL : -HUGE_VAL);
                }),
                1u);
      EXPECT_EQ(wrong([&](ClaimedDistance& c) { c.points[side][axis] = std::nan(""); }), 1u);
      EXPECT_EQ(wrong([&](ClaimedDistance& c) {
                  c.features[side] = static_cast<std::uint8_t>((c.features[side] + 1) % 7);
                }),
                1u);
      EXPECT_EQ(wrong([](ClaimedDistance&) {}), 0u);
    }
  }
}

/// Points on a line, an object each.
Scene points(std::initializer_list<double> places) {
  std::vector<std::vector<reference::Triangle>> objects;
  for (const double x : places) objects.push_back({{Vec3(x, 0, 0), Vec3(x, 0, 0), Vec3(x, 0, 0)}});
  return reference::scene_of(objects);
}

TEST(DistanceAccounting, OfObjectsAsFarTheLowerOneIsTheNeighbour) {
  const Scene scene = points({0, 1, 2});  // of 1 both others are as near: 0 is its neighbour
  const DistanceQuestion nearest = {.kind = Kind::nearest};
  const std::vector<ClaimedDistance> right = {claim_of(scene, 0, 1, {0, 1}),
                                              claim_of(scene, 1, 2, {1, 2})};
  EXPECT_TRUE(account_distances(scene, right, nearest).holds());
  const Scene wide = points({0, 2, 4, 5});  // 2's neighbour is 3, so that 1 and 2 are none
  const std::vector<ClaimedDistance> first = {claim_of(wide, 0, 1, {0, 1}),
                                              claim_of(wide, 2, 3, {2, 3})};
  const std::vector<ClaimedDistance> second = {
      claim_of(wide, 0, 1, {0, 1}), claim_of(wide, 1, 2, {1, 2}), claim_of(wide, 2, 3, {2, 3})};
  EXPECT_TRUE(account_distances(wide, first, nearest).holds());
  EXPECT_EQ(account_distances(wide, second, nearest).wrong, 1u);  // nobody's neighbour
  const Scene tie = points({2, 0, 4, 5, -1});  // of 0 the neighbour is 1, as far as 2
  const std::vector<ClaimedDistance> later = {
      claim_of(tie, 0, 2, {0, 2}), claim_of(tie, 1, 4, {1, 4}), claim_of(tie, 2, 3, {2, 3})};
  EXPECT_EQ(account_distances(tie, later, nearest).nearer, 1u);
}

TEST(DistanceAccounting, ZerosHaveNoSign) {
  const Scene scene = points({0, 1});
  ClaimedDistance claim = claim_of(scene, 0, 1, {0, 1});
  EXPECT_TRUE(account_distances(scene, std::array{claim}, {}).holds());
  claim.points[0].y() = -0.0;
  EXPECT_EQ(account_distances(scene, std::array{claim}, {}).wrong, 1u);
}

/// A tetrahedron and a small one in it, of which one face may be missing.
Scene nested(bool closed) {
  Scene scene;
  for (const double at : {0.0, 1.0}) {
    const auto v = static_cast<std::uint32_t>(scene.vertices.size());
    const double size = at == 0 ? 9 : 1;
    const Vec3 corner(at, at, at);
    for (const Vec3& p : {Vec3(0, 0, 0), Vec3(size, 0, 0), Vec3(0, size, 0), Vec3(0, 0, size)})
      scene.vertices.push_back(p + corner);
    const auto first = static_cast<std::uint32_t>(scene.triangles.size());
    scene.triangles.insert(scene.triangles.end(), {{v, v + 1, v + 2}, {v, v + 3, v + 1}});
    scene.triangles.insert(scene.triangles.end(), {{v, v + 2, v + 3}, {v + 1, v + 3, v + 2}});
    if (!closed && at == 0) scene.triangles.back() = {v, v, v};
    scene.objects.push_back({.name = "", .first_triangle = first, .triangle_count = 4});
  }
  scene.source_face.resize(scene.triangles.size());
  return scene;
}

TEST(DistanceAccounting, FindsAnInsideThatIsNotSo) {
  for (const bool closed : {true, false}) {
    const Scene scene = nested(closed);
    const InsideClaim right = closed ? InsideClaim::b : InsideClaim::not_closed;
    std::vector<ClaimedDistance> claims = right_answers(scene, {.pairs = Kind::objects});
    ASSERT_EQ(claims.size(), 1u);
    for (const InsideClaim inside : {InsideClaim::unknown, InsideClaim::none, InsideClaim::a,
                                     InsideClaim::b, InsideClaim::not_closed}) {
      claims[0].inside = inside;
      EXPECT_EQ(account_distances(scene, claims, {.inside = true}).wrong, inside != right);
      EXPECT_EQ(account_distances(scene, claims, {}).wrong, inside != InsideClaim::unknown);
    }
  }
}

// Of objects that meet all pairs behind the first one that meets are settled.
TEST(DistanceAccounting, OfObjectsThatMeetTheAnswerIsTheFirstPairThatMeets) {
  Scene scene = points({0, 5, 5, 5, 7, 5});
  scene.objects = {{.name = "a", .first_triangle = 0, .triangle_count = 3},
                   {.name = "b", .first_triangle = 3, .triangle_count = 3}};
  const auto account = [&](const TrianglePair& pair) {
    return account_distances(scene, std::array{claim_of(scene, 0, 1, pair)}, {});
  };
  const DistanceAccounting right = account({1, 3});
  EXPECT_TRUE(right.holds());
  EXPECT_EQ(right.objects_meet, 5u);  // all of the last two triangles but the answer
  EXPECT_EQ(right.farther_by_boxes, 3u);
  EXPECT_EQ(account({1, 5}).earlier, 1u);
  EXPECT_EQ(account({2, 5}).earlier, 3u);
  EXPECT_EQ(account({2, 5}).nearer, 0u);
  EXPECT_FALSE(account({2, 5}).holds());
}

TEST(DistanceAccounting, RefusesAnswersThatNameNothing) {
  const Scene scene = points({0, 1, 2});
  const ClaimedDistance good = claim_of(scene, 0, 1, {0, 1});
  EXPECT_THROW(account_distances(scene, std::array{good, good}, {}), std::logic_error);
  const auto changed = [&](std::uint32_t a, std::uint32_t b, const TrianglePair& pair) {
    ClaimedDistance out = good;
    out.a = a;
    out.b = b;
    out.pair = pair;
    return out;
  };
  for (const ClaimedDistance& bad :
       {changed(1, 0, {0, 1}), changed(0, 3, {0, 1}), changed(0, 1, {0, 2}), changed(0, 1, {1, 1})})
    EXPECT_THROW(account_distances(scene, std::array{bad}, {}), std::logic_error);
  EXPECT_THROW(account_distances(scene, {}, {.kind = Kind::all}), std::logic_error);
  EXPECT_THROW(account_distances(scene, {}, {.within = -1}), std::logic_error);
}

}  // namespace
}  // namespace farcull
