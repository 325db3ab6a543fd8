// Clearance: squared distances against the square of the clearance, exactly.
#include "tests/lab/hard_pairs.h"
#include "tests/lab/test.h"
#include "verify/exact.h"
#include "verify/filter_scalars.h"
#include "verify/within.h"

namespace farcull {
namespace {

using reference::Triangle;

double up(double x) { return std::nextafter(x, std::numeric_limits<double>::infinity()); }
double down(double x) { return std::nextafter(x, 0.0); }

void expect_distance_is(double distance, const Triangle& a, const Triangle& b) {
  for (const auto& [s, t] : {std::pair(a, b), std::pair(b, a)}) {
    EXPECT_TRUE(within(s, t, distance));
    EXPECT_TRUE(within(s, t, up(distance)));
    EXPECT_FALSE(within(s, t, down(distance)));
    EXPECT_TRUE(within_unfiltered(s, t, distance));
    EXPECT_FALSE(within_unfiltered(s, t, down(distance)));
  }
}

const Triangle kUnit = {Vec3(0, 0, 0), Vec3(4, 0, 0), Vec3(0, 4, 0)};

Triangle single_point(const Vec3& p) { return {p, p, p}; }

TEST(Clearance, BetweenEveryKindOfFeatures) {
  for (const auto& [name, a, b, distance] : hard_pairs::known_distances()) {
    SCOPED_TRACE(name);
    expect_distance_is(distance, a, b);
  }
}

TEST(Clearance, CrossingTrianglesAreWithinAny) {
  const Triangle through = {Vec3(1, 1, -100), Vec3(1, 1, 100), Vec3(1.5, 1, 100)};
  EXPECT_TRUE(within(kUnit, through, 0));
  EXPECT_TRUE(within(kUnit, through, 1e-300));
  EXPECT_TRUE(within(kUnit, {Vec3(1, 1, 0), Vec3(1, 1, 9), Vec3(2, 1, 9)}, 1e-300));  // touching
}

TEST(Clearance, WhoseSquareUnderflowsOrOverflows) {
  const double tiny = std::numeric_limits<double>::denorm_min();
  expect_distance_is(tiny, kUnit, {Vec3(1, 1, tiny), Vec3(1, 1, 9), Vec3(2, 1, 9)});
  expect_distance_is(0x1p-700, kUnit, {Vec3(1, 1, 0x1p-700), Vec3(1, 1, 9), Vec3(2, 1, 9)});
  expect_distance_is(0x1p1020, single_point({0, 0, 0}), single_point({0, 0x1p1020, 0}));
  const double most = std::numeric_limits<double>::max();
  EXPECT_TRUE(within(single_point({-most / 2, 0, 0}), single_point({most / 2, 0, 0}), most));
  EXPECT_FALSE(within(single_point({-most, 0, 0}), single_point({most, 0, 0}), most));
}

/// The least clearance that a disjoint pair is within, by the reference, by bisection of doubles.
double least_clearance(const Triangle& a, const Triangle& b) {
  std::uint64_t no = 0, yes = std::bit_cast<std::uint64_t>(0x1p1000);
  while (yes - no > 1) {
    const std::uint64_t middle = no + (yes - no) / 2;
    (reference::within(a, b, std::bit_cast<double>(middle)) ? yes : no) = middle;
  }
  return std::bit_cast<double>(yes);
}

// Where the answer changes from one double to the next the filter has to stand aside.
TEST(Clearance, AsTheReferenceAtTheThreshold) {
  int disjoint = 0;
  for (const PairGenerator& generator : pair_generators()) {
    RandomDraws random(3);
    for (int n = 0; n < 8; ++n) {
      const auto [a, b] = generator.make(random);
      if (reference::intersects(a, b) || !reference::within(a, b, 0x1p1000)) continue;
      ++disjoint;
      const double least = least_clearance(a, b);
      EXPECT_TRUE(within(a, b, least)) << generator.name;
      EXPECT_TRUE(within(a, b, up(least))) << generator.name;
      if (least > std::numeric_limits<double>::denorm_min()) {
        EXPECT_FALSE(within(a, b, down(least))) << generator.name;
      }
    }
  }
  EXPECT_GT(disjoint, 30);
}

/// Corners of a and b much closer than they are to the other corners, the clearance their distance.
void put_corners_close(RandomDraws& random, DrawnPair& pair, double& clearance) {
  const auto point = [&] {
    const double x = random.between(-1, 1), y = random.between(-1, 1);
    return Vec3(x, y, random.between(-1, 1));
  };
  const Vec3 corner = point(), towards = point();
  const auto away = [&](double side) {
    const Vec3 p = point();
    return Vec3((p.dot(towards) > 0 ? side : -side) * p);
  };
  pair.b[0] = corner + std::ldexp(1, -random.whole(10, 40)) * towards;
  pair.a = {corner + away(-1), corner, corner + away(-1)};
  pair.b = {pair.b[0], pair.b[0] + away(1), pair.b[0] + away(1)};
  clearance = up((pair.b[0] - corner).norm());
}

/// The filters at and around clearances that a pair of points of the triangles is apart by, and
/// around the distance itself. A twin ends where it is wrong.
template <class Bounds>
int wrong(bool twin = false) {
  RandomDraws random(test_seed(1));
  int wrong = 0, decided = 0;
  for (int n = 0; more_cases(n, twin ? 0 : 1500, twin ? wrong > 0 : decided > 300, 30'000); ++n) {
    DrawnPair pair =
        pair_generators()[random.below(static_cast<int>(pair_generators().size()))].make(random);
    double clearance = (pair.a[random.below(3)] - pair.b[random.below(3)]).norm();
    if (random.chance(2)) clearance *= random.between(0, 1.5);
    if (random.chance(4)) {  // near a corner pair's distance, with nothing nearer
      const Vec3 far = pair.b[0];
      pair.b = {far, far + (far - pair.a[0]), far + 2 * (far - pair.a[0])};
      clearance = (pair.a[0] - far).norm();
      pair.a = {pair.a[0], pair.a[0] - (far - pair.a[0]), pair.a[0]};
    }
    if (random.chance(4)) put_corners_close(random, pair, clearance);
    if (random.chance(3)) clearance = random.chance(2) ? up(clearance) : down(clearance);
    if (!(clearance > 0) || !std::isfinite(clearance)) continue;
    const auto check = [&](Triage triage) {
      if (triage == Triage::unknown) return;
      ++decided;
      wrong += (triage == Triage::yes) != reference::within(pair.a, pair.b, clearance);
    };
    check(filters::filter_planes<Bounds>(pair.a, pair.b, clearance));
    check(filters::filter_within<Bounds>(pair.a, pair.b, clearance));
  }
  return wrong;
}

TEST(ClearanceFilter, NeverContradictsExactArithmetic) { EXPECT_EQ(wrong<FilterBounds>(), 0); }

TEST(ClearanceFilterTwin, WithoutItsBoundsItIsWrong) {
  wrong<hard_pairs::NoPoint>(true);
  wrong<hard_pairs::NoGap>(true);
}

TEST(ClearanceFilter, DecidesWhatIsNotClose) {
  const Triangle above = {Vec3(1, 1, 3), Vec3(2, 1, 9), Vec3(1, 2, 9)};
  EXPECT_EQ(filter_planes(kUnit, above, 2.9), Triage::no);
  EXPECT_EQ(filter_within(kUnit, above, 2.9), Triage::no);
  EXPECT_EQ(filter_within(kUnit, above, 3.1), Triage::yes);
  EXPECT_EQ(filter_within(kUnit, above, 3), Triage::unknown);
  const Triangle beside = {Vec3(-3, 1, 0), Vec3(-9, 1, 1), Vec3(-9, 3, -1)};
  EXPECT_EQ(filter_planes(kUnit, beside, 2.9), Triage::unknown);
  EXPECT_EQ(filter_within(kUnit, beside, 2.9), Triage::no);
  EXPECT_EQ(filter_within(kUnit, beside, 3.1), Triage::yes);
}

}  // namespace
}  // namespace farcull
