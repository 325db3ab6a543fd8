// Searches in which many pairs tie: exact arithmetic settles them, and the planes between the
// settled triangles leave out the others. Each property has a twin that must fail.
#include "core/proximity/near_pairs.h"
#include "tests/lab/closest.h"
#include "tests/lab/rational.h"
#include "tests/lab/test.h"

namespace farcull {
namespace {

using TiedTriangles = std::vector<std::array<Vec3, 3>>;
constexpr double kNoLimit = std::numeric_limits<double>::infinity();

// Exact arithmetic whose reaches are off by `error`.
Settle settle_with(const Scene& scene, double error) {
  return [&scene, error](std::span<const TrianglePair> pairs) {
    const NearestPair nearest = *nearest_pair(scene, pairs);
    SettledPair out;
    out.pair = nearest.pair;
    if (nearest.closest.squared.is_zero()) return out;
    out.distance = std::nextafter(nearest.closest.distance, kNoLimit);
    const PlanesBetween planes(scene.corners(out.pair.a), scene.corners(out.pair.b));
    out.reach = [&scene, planes, error](std::uint32_t t) {
      return planes.reach(scene.corners(t)) + error;
    };
    out.start = [&scene, planes](std::uint32_t t) { return planes.start(scene.corners(t)); };
    return out;
  };
}

// Long strips that lie side by side along x (or y) in the plane z.
TiedTriangles strips(int count, double z, bool along_x) {
  TiedTriangles out;
  for (int k = 0; k < count; ++k) {
    const auto at = [&](double along, double across) {
      return along_x ? Vec3(along, across, z) : Vec3(across, along, z);
    };
    const Vec3 p = at(0, k), q = at(count, k), r = at(count, k + 0.5), s = at(0, k + 0.5);
    out.push_back({p, q, r});
    out.push_back({p, r, s});
  }
  return out;
}

struct TiesFound {
  NearPairs near;
  std::uint64_t looked_at = 0;
};
TiesFound ties_of(const Scene& scene, bool settles, const ObjectPair& question = {0, 1}) {
  const ProximityTrees trees(scene, 1, settles ? settle_with(scene, 0) : Settle());
  TiesFound out;
  out.near = trees.near_pairs({&question, 1}, kNoLimit, {}).front();
  out.looked_at = trees.counts().triangle_pairs;
  return out;
}

TEST(Ties, OfCrossedStripsTakeWorkInProportionToTheTriangles) {
  for (const int count : {100, 400}) {
    const Scene scene = reference::scene_of({strips(count, 0, true), strips(count, 1, false)});
    const TiesFound found = ties_of(scene, true);
    EXPECT_LE(found.looked_at, 1200u + 4 * static_cast<unsigned>(count));
    ASSERT_EQ(found.near.pairs.size(), 1u);
    EXPECT_EQ(found.near.pairs[0].a, 0u);
    EXPECT_EQ(found.near.pairs[0].b, 2u * static_cast<unsigned>(count));
  }
}
// Both layers in one object.
TEST(Ties, WithinOneObject) {
  TiedTriangles both;
  for (const Vec3& p : {Vec3(0, 0, 0), Vec3(0, 0, 1)}) {
    for (int k = 0; k < 100; ++k) {
      const Vec3 by = 3 * k * (p.z() == 0 ? Vec3::UnitY() : Vec3::UnitX());
      both.push_back({p + by, p + by + 300 * (p.z() == 0 ? Vec3::UnitX() : Vec3::UnitY()), p + by});
    }
  }
  Scene scene = reference::scene_of({both});
  scene.objects[0].self = true;
  const TiesFound found = ties_of(scene, true, {0, 0});
  ASSERT_EQ(found.near.pairs.size(), 1u);
  EXPECT_EQ(found.near.pairs[0], (TrianglePair{0, 100}));
  EXPECT_LE(found.looked_at, 3000u);
  EXPECT_EQ(ties_of(scene, false, {0, 0}).near.pairs.size(), 100u * 100u);
}
TEST(TiesTwin, WithoutSettlingAllPairsAreLookedAtAndKept) {
  const Scene scene = reference::scene_of({strips(100, 0, true), strips(100, 1, false)});
  const TiesFound found = ties_of(scene, false);
  EXPECT_GE(found.looked_at, 200u * 200u);
  EXPECT_EQ(found.near.pairs.size(), 200u * 200u);
}

// Flat triangles with few different corners, in two layers whose places along z and whose slopes
// differ a little. Most pairs tie, or differ by less than bounds in doubles show.
// With an error, up to the first one that is wrong.
int wrong_of_layers(double error) {
  rational::Draws random(21);
  int wrong = 0;
  const int least = error == 0 ? trials(240) : 0;
  for (int k = 0; more_cases(k, least, error == 0 || wrong > 0, 1000); ++k) {
    const int slopes = random.below(3), wide = 2 + random.below(3);
    std::vector<TiedTriangles> objects(2);
    for (const int side : {0, 1}) {
      for (int n = 0; n < 60; ++n) {
        std::array<Vec3, 3> t;
        for (Vec3& p : t) {
          const double x = random.below(wide), y = random.below(wide);
          const double bump = random.below(8) == 0 ? 0x1p-52 * random.below(4) : 0;
          p = {x, y, 3 * side + (slopes == 0 ? 0 : x / 4) + (slopes == 2 ? bump : 0)};
        }
        objects[static_cast<std::size_t>(side)].push_back(t);
      }
    }
    const Scene scene = reference::scene_of(objects);
    std::vector<TrianglePair> all;
    for (std::uint32_t a = 0; a < 60; ++a) {
      for (std::uint32_t b = 60; b < 120; ++b) all.push_back({a, b});
    }
    const TrianglePair first = nearest_pair(scene, all)->pair;
    const ProximityTrees trees(scene, 1 + k % 2, settle_with(scene, error));
    const ObjectPair question = {0, 1};
    const NearPairs near = trees.near_pairs({&question, 1}, kNoLimit, {}).front();
    wrong += !std::ranges::binary_search(near.pairs, first);
  }
  return wrong;
}
TEST(Ties, TheFirstNearestPairIsLeft) { EXPECT_EQ(wrong_of_layers(0), 0); }
TEST(TiesTwin, WithReachesThatAreTooSmallItIsLost) { wrong_of_layers(-1); }

}  // namespace
}  // namespace farcull
