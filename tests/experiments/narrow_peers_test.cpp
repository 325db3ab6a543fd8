#include <gtest/gtest.h>

#include "experiments/builtin_scenes.h"
#include "experiments/peer.h"
#include "experiments/studies/lab.h"
#include "verify/exact.h"

namespace farcull {
namespace {

using Corners = std::array<Vec3, 3>;

Scene scene_of(const std::vector<std::vector<Corners>>& objects) {
  Scene scene;
  scene.name = "made";
  for (const std::vector<Corners>& object : objects) {
    scene.objects.push_back({"object", static_cast<std::uint32_t>(scene.triangles.size()),
                             static_cast<std::uint32_t>(object.size())});
    for (const Corners& corners : object) {
      const auto first = static_cast<std::uint32_t>(scene.vertices.size());
      scene.vertices.insert(scene.vertices.end(), corners.begin(), corners.end());
      scene.triangles.push_back({first, first + 1, first + 2});
      scene.source_face.push_back(0);
    }
  }
  validate(scene, scene.name);
  return scene;
}

std::vector<TrianglePair> truth_of(const Scene& scene) { return all_colliding_pairs(scene).pairs; }

class NarrowPeers : public testing::Test {
 protected:
  void SetUp() override {
    for (const Peer& peer : narrow_peers()) {
      if (!peer.missing.empty()) GTEST_SKIP() << peer.missing;
    }
  }
  static std::vector<TrianglePair> found(const std::string& name, const Scene& scene,
                                         unsigned threads = 2) {
    for (const Peer& peer : narrow_peers()) {
      if (peer.name == name) return peer.set_up(threads)(scene).pairs;
    }
    ADD_FAILURE() << name << " is not there";
    return {};
  }
};

TEST_F(NarrowPeers, FindTheObviousPairAndNothingElse) {
  const Scene scene =
      scene_of({{{{{0, 0, 0}, {4, 0, 0}, {0, 4, 0}}}, {{{9, 9, 9}, {9, 8, 9}, {8, 9, 9}}}},
                {{{{1, 1, -1}, {1, 1, 1}, {2, 2, 1}}}}});
  ASSERT_EQ(truth_of(scene), (std::vector<TrianglePair>{{0, 2}}));
  for (const char* name : {"fcl-float", "fcl-double"}) {
    EXPECT_EQ(found(name, scene), truth_of(scene)) << name;
  }
}

TEST_F(NarrowPeers, AreRightWhereNothingIsClose) {
  for (const char* name : {"two-spheres", "crowd"}) {
    const Scene scene = make_builtin_scene(name);
    ASSERT_FALSE(truth_of(scene).empty());
    EXPECT_EQ(found("fcl-double", scene), truth_of(scene)) << name;
    EXPECT_EQ(found("fcl-double", scene, 1), truth_of(scene)) << name;
  }
}

// A triangle in the plane 4 (x - 1024) = 3 z, and one that reaches it from smaller x with the
// corner (1024.75 + x, 0, 1 + z). Floats are 2^-13 apart there, so that any |x| < 2^-14 is lost.
Scene close_pair(double x, double z) {
  return scene_of({{{{{1024, -5, 0}, {1027, -5, 4}, {1024, 5, 0}}}},
                   {{{{1024.75 + x, 0, 1 + z}, {1020, -1, 2}, {1020, 1, 2}}}}});
}

TEST_F(NarrowPeers, FloatMissesWhatItsRoundingTakesApart) {
  const Scene scene = close_pair(0x1p-15, 0x1p-17);
  ASSERT_EQ(truth_of(scene).size(), 1u);
  EXPECT_EQ(found("fcl-double", scene), truth_of(scene));
  EXPECT_TRUE(found("fcl-float", scene).empty());
}

TEST_F(NarrowPeers, FloatReportsWhatItsRoundingBringsTogether) {
  const Scene scene = close_pair(-0x1p-15, -0x1p-17);
  ASSERT_TRUE(truth_of(scene).empty());
  EXPECT_TRUE(found("fcl-double", scene).empty());
  EXPECT_EQ(found("fcl-float", scene).size(), 1u);
}

// The twin of the two before: without rounding there is no difference, so it is the float.
TEST_F(NarrowPeers, FloatIsRightWhereCoordinatesAreFloats) {
  for (const double side : {-1.0, 1.0}) {
    const Scene scene = close_pair(side * 0x1p-13, 0);
    EXPECT_EQ(truth_of(scene).size(), side > 0 ? 1u : 0u);
    EXPECT_EQ(found("fcl-float", scene), truth_of(scene));
  }
}

TEST_F(NarrowPeers, LeaveNeighboursOutInsideAnObject) {
  Scene scene = scene_of({{{{{0, 0, 0}, {4, 0, 0}, {0, 4, 0}}},
                           {{{4, 0, 0}, {0, 4, 0}, {4, 4, 1}}},
                           {{{1, 1, -1}, {1, 1, 1}, {2, 2, 1}}}}});
  EXPECT_TRUE(found("fcl-double", scene).empty()) << "not self";
  scene.objects[0].self = true;
  ASSERT_EQ(truth_of(scene), (std::vector<TrianglePair>{{0, 2}}));
  EXPECT_EQ(found("fcl-double", scene), truth_of(scene));
  EXPECT_EQ(found("fcl-float", scene), truth_of(scene));
}

TEST_F(NarrowPeers, EndOnDegenerateTrianglesAndWhatOnlyFloatsMakeDegenerate) {
  for (const char* name : {"degenerate", "needles", "crowd@far", "crowd@tiny", "crowd@huge"}) {
    const Scene scene = make_builtin_scene(name);
    const Truth truth{truth_of(scene), 0, 0};
    for (const char* peer : {"fcl-float", "fcl-double"}) {
      const std::vector<TrianglePair> pairs = found(peer, scene);
      const Errors errors = errors_of(truth, pairs);
      EXPECT_EQ(truth.pairs.size() - errors.missed, pairs.size() - errors.wrong) << peer;
    }
  }
}

}  // namespace
}  // namespace farcull
