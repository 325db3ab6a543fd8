// What the planes between two triangles show of other triangles, against exact distances.

#include "tests/lab/hard_pairs.h"
#include "tests/lab/test.h"
#include "verify/closest.h"

namespace farcull {
namespace {

struct ShownByPlanes {
  int wrong = 0, no_nearer = 0, as_near = 0;
};

// `share` of the corners stay those of the pair that the planes are of, so that many others are as
// near. error: by which reaches are changed; then the first wrong pair is the last one.
ShownByPlanes shown_by_planes(int least, double error) {
  const auto all = hard_pairs::generators();
  RandomDraws random(31);
  ShownByPlanes out;
  const auto seen = [&] {
    return error != 0 ? out.wrong > 0 : out.no_nearer > 100 && out.as_near > 10;
  };
  for (std::size_t n = 0; more_cases(n, least, seen(), 100'000); ++n) {
    DrawnPair one = all[n % all.size()].second(random), two = all[n % all.size()].second(random);
    if (!hard_pairs::finite(one) || !hard_pairs::finite(two)) continue;
    for (int k = 0; k < 3; ++k) {
      if (!random.chance(3)) two.a[k] = one.a[k];
      if (!random.chance(3)) two.b[k] = one.b[k];
    }
    const SquaredDistance distance = squared_distance(one.a, one.b);
    if (distance.is_zero()) continue;
    const PlanesBetween planes(one.a, one.b);
    const double reach = planes.reach(two.a) + error, start = planes.start(two.b);
    EXPECT_TRUE(std::isfinite(reach) && std::isfinite(start));
    if (reach > start) continue;
    const SquaredDistance other = squared_distance(two.a, two.b);
    out.wrong += other < distance || (reach < start && other == distance);
    ++out.no_nearer;
    out.as_near += other == distance;
  }
  return out;
}

TEST(PlanesBetween, ShowWhatIsNoNearer) {
  EXPECT_EQ(shown_by_planes(trials(20000, 2000), 0).wrong, 0);
}
TEST(PlanesBetweenTwin, ReachesThatAreTooSmallShowWhatIsNotSo) { shown_by_planes(0, -0x1p-60); }
TEST(PlanesBetween, AreExactWhereTrianglesTouchThem) {
  const std::array<Vec3, 3> a = {Vec3(0, 0, 0), Vec3(3, 0, 0), Vec3(0, 3, 0)};
  std::array<Vec3, 3> b = a;
  for (Vec3& p : b) p += Vec3(1, 0, 0.1);
  const PlanesBetween planes(a, b);
  EXPECT_EQ(planes.reach(a), 0);
  EXPECT_EQ(planes.start(b), 0);
  EXPECT_GT(planes.reach(b), 0);
  EXPECT_LT(planes.start(a), 0);
  EXPECT_THROW(PlanesBetween(a, a), std::logic_error);
}
// Places of huge and tiny coordinates stay finite. A sign may be lost to the safe side.
TEST(PlanesBetween, OfExtremeCoordinates) {
  for (const double size : {0x1p1023, 0x1p-1073}) {
    const Vec3 x(size, 0, 0), y(0, size, 0), z(0, 0, size);
    const PlanesBetween planes({x, y, Vec3(0, 0, 0)}, {x + z, y + z, z});
    EXPECT_GT(planes.reach({-z, x, z}), 0);
    EXPECT_LT(planes.reach({-z, x - z, y - z}), size > 1 ? 0 : 0x1p-1073);
    EXPECT_TRUE(std::isfinite(planes.reach({z, x, y})));
    EXPECT_TRUE(std::isfinite(planes.start({-z, x, y})));
  }
}

}  // namespace
}  // namespace farcull
