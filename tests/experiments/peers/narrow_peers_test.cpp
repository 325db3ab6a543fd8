

#include "experiments/measure/harness.h"
#include "experiments/peers/peer.h"
#include "tests/lab/scenes.h"

namespace farcull {
namespace {

using lab::scene_of;

std::vector<TrianglePair> truth_of(const Scene& scene) { return all_colliding_pairs(scene).pairs; }

class NarrowPeers : public testing::Test {
 protected:
  void SetUp() override {
    for (const Peer& peer : narrow_peers())
      if (peer.name.starts_with("fcl") && !peer.missing.empty()) GTEST_SKIP() << peer.missing;
  }
  static std::vector<TrianglePair> found(const std::string& name, const Scene& scene,
                                         unsigned threads = 2) {
    for (const Peer& peer : narrow_peers())
      if (peer.name == name) return peer.set_up(threads)(scene).pairs;
    ADD_FAILURE() << name << " is not there";
    return {};
  }
};

TEST_F(NarrowPeers, FindTheObviousPairAndNothingElse) {
  const Scene scene =
      scene_of({{{{{0, 0, 0}, {4, 0, 0}, {0, 4, 0}}}, {{{9, 9, 9}, {9, 8, 9}, {8, 9, 9}}}},
                {{{{1, 1, -1}, {1, 1, 1}, {2, 2, 1}}}}});
  ASSERT_EQ(truth_of(scene), (std::vector<TrianglePair>{{0, 2}}));
  for (const char* name : {"fcl-float", "fcl-double"})
    EXPECT_EQ(found(name, scene), truth_of(scene)) << name;
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
TEST_F(NarrowPeers, FloatMissesWhatItsRoundingTakesApart) {
  const Scene scene =
      scene_of({{{{{1024, -5, 0}, {1027, -5, 4}, {1024, 5, 0}}}},
                {{{{1024.75 + 0x1p-15, 0, 1 + 0x1p-17}, {1020, -1, 2}, {1020, 1, 2}}}}});
  ASSERT_EQ(truth_of(scene).size(), 1u);
  EXPECT_EQ(found("fcl-double", scene), truth_of(scene));
  EXPECT_TRUE(found("fcl-float", scene).empty());
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

// Empty, or what no answer of a library may be, whatever it misses.
std::string fault_of(const Scene& scene, const std::vector<TrianglePair>& pairs) {
  const std::vector<std::uint32_t> owner = owners(scene);
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    const TrianglePair& pair = pairs[i];
    if (pair.b >= owner.size() || pair.a >= pair.b) return "no pair of triangles";
    if (owner[pair.a] == owner[pair.b]) return "of one object";
    if (i > 0 && !(pairs[i - 1] < pair)) return "not sorted, or twice";
  }
  return "";
}

TEST_F(NarrowPeers, EndOnDegenerateTrianglesAndWhatOnlyFloatsMakeDegenerate) {
  for (const char* name : {"degenerate", "needles", "crowd@far", "crowd@tiny", "crowd@huge"}) {
    const Scene scene = make_builtin_scene(name);
    const TruePairs truth{truth_of(scene), 0, 0};
    for (const char* peer : {"fcl-float", "fcl-double"}) {
      const std::vector<TrianglePair> pairs = found(peer, scene);
      EXPECT_EQ(fault_of(scene, pairs), "") << peer << " on " << name;
      const Errors errors = errors_of(truth, pairs);
      const bool exact = std::string(peer) == "fcl-double" && std::string(name) != "degenerate";
      // Coordinates that are doubles lose nothing; those far away lose all as floats, and no type
      // makes FCL exact where triangles are degenerate.
      if (exact) {
        EXPECT_EQ(errors.missed + errors.wrong, 0u) << peer << " on " << name;
      }
      if (std::string(name) == "degenerate") {
        EXPECT_GT(errors.missed + errors.wrong, 0u) << peer;
      }
      if (std::string(name) == "crowd@far" && !exact) {
        EXPECT_GT(errors.missed, truth.pairs.size() / 2) << peer;
      }
    }
  }
}

class OdeTrimesh : public NarrowPeers {
 protected:
  void SetUp() override {
    const std::vector<Peer> peers = narrow_peers();
    const auto peer = std::ranges::find(peers, "ode-trimesh", &Peer::name);
    ASSERT_NE(peer, peers.end());
    if (!peer->missing.empty()) GTEST_SKIP() << peer->missing;
  }
  static std::vector<TrianglePair> found(const Scene& scene) {
    return NarrowPeers::found("ode-trimesh", scene);
  }
};

// Contacts of two-spheres are merged where triangles share an edge; the pairs of both are there.
TEST_F(OdeTrimesh, FindsPairsWhoseContactsAreMerged) {
  for (const char* name : {"two-spheres", "two-tori"}) {
    const Scene scene = make_builtin_scene(name);
    ASSERT_FALSE(truth_of(scene).empty());
    EXPECT_EQ(found(scene), truth_of(scene)) << name;
  }
}

TEST_F(OdeTrimesh, EndsOnDegenerateTrianglesAndOnScenesOfNothing) {
  for (const char* name : {"degenerate", "needles", "crowd@far", "crowd@tiny", "crowd@huge"}) {
    const Scene scene = make_builtin_scene(name);
    EXPECT_EQ(fault_of(scene, found(scene)), "") << name;
  }
  EXPECT_TRUE(found(Scene{}).empty());
}

// The twin: each fault is seen.
TEST(NarrowAnswers, AreRefusedWithAFault) {
  const Scene scene =
      scene_of({{{{{0, 0, 0}, {4, 0, 0}, {0, 4, 0}}}, {{{9, 9, 9}, {9, 8, 9}, {8, 9, 9}}}},
                {{{{1, 1, -1}, {1, 1, 1}, {2, 2, 1}}}}});
  EXPECT_EQ(fault_of(scene, {{0, 2}, {1, 2}}), "");
  EXPECT_EQ(fault_of(scene, {{0, 3}}), "no pair of triangles");
  EXPECT_EQ(fault_of(scene, {{2, 0}}), "no pair of triangles");
  EXPECT_EQ(fault_of(scene, {{0, 1}}), "of one object");
  EXPECT_EQ(fault_of(scene, {{1, 2}, {0, 2}}), "not sorted, or twice");
  EXPECT_EQ(fault_of(scene, {{0, 2}, {0, 2}}), "not sorted, or twice");
}

}  // namespace
}  // namespace farcull
