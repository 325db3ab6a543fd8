// Pairs of triangles of ignored objects, against a search through the list.
#include "core/scene/scene.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <stdexcept>

#include "tests/core/base/rational.h"

namespace farcull {
namespace {

Scene scene_of(const std::vector<std::uint32_t>& sizes) {
  Scene scene;
  scene.vertices = {Vec3::Zero()};
  for (const std::uint32_t size : sizes) {
    scene.objects.push_back({"", static_cast<std::uint32_t>(scene.triangles.size()), size, true});
    scene.triangles.resize(scene.triangles.size() + size, {0, 0, 0});
  }
  scene.source_face.resize(scene.triangles.size());
  return scene;
}

TEST(IgnoredObjects, RemoveTheirPairsAndNoOthers) {
  rational::Random random(611);
  const Scene scene = scene_of({3, 0, 2, 4, 1, 2});
  const std::vector<std::uint32_t> owner = owners(scene);
  std::vector<TrianglePair> all;
  for (std::uint32_t a = 0; a < owner.size(); ++a) {
    for (std::uint32_t b = a + 1; b < owner.size(); ++b) all.push_back({a, b});
  }
  for (int n = 0; n < 200; ++n) {
    std::vector<ObjectPair> ignored;
    for (int k = random.below(6); k > 0; --k) {
      const auto a = static_cast<std::uint32_t>(random.below(6));
      const auto b = static_cast<std::uint32_t>(random.below(6));
      if (a != b) ignored.push_back({a, b});
    }
    std::vector<TrianglePair> expected;
    for (const TrianglePair& pair : all) {
      const ObjectPair one{owner[pair.a], owner[pair.b]}, other{one.b, one.a};
      if (std::find(ignored.begin(), ignored.end(), one) == ignored.end() &&
          std::find(ignored.begin(), ignored.end(), other) == ignored.end()) {
        expected.push_back(pair);
      }
    }
    std::vector<TrianglePair> left = all;
    EXPECT_EQ(remove_ignored(scene, in_order(ignored), left), all.size() - expected.size());
    EXPECT_EQ(left, expected);
    // The twin: the check notices a pair of objects that is forgotten.
    if (ignored.size() == 1 && left.size() < all.size()) {
      EXPECT_NE(all, expected);
    }
  }
}

TEST(IgnoredObjects, HaveToBeTwoOfTheScene) {
  const Scene scene = scene_of({1, 1});
  std::vector<TrianglePair> pairs;
  EXPECT_THROW(remove_ignored(scene, std::vector<ObjectPair>{{0, 2}}, pairs), std::logic_error);
  EXPECT_THROW(remove_ignored(scene, std::vector<ObjectPair>{{1, 1}}, pairs), std::logic_error);
  EXPECT_EQ(remove_ignored(scene, {}, pairs), 0u);
}

}  // namespace
}  // namespace farcull
