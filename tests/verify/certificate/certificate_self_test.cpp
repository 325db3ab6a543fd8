// Certificates of scenes whose objects are tested against themselves: neighbours.
#include "tests/lab/certificates.h"

namespace farcull {
namespace {

/// Every object against itself; with neighbours that meet and others.
const Case& folded() {
  static const Case folded = [] {
    std::mt19937 random(4);
    std::vector<std::vector<reference::Triangle>> objects(3);
    for (auto& triangles : objects) {
      triangles.resize(60);
      for (reference::Triangle& t : triangles) {
        const Vec3 corner(random() % 4, random() % 4, random() % 4);
        for (Vec3& p : t) p = corner + Vec3(random() % 3, random() % 3, random() % 3);
      }
    }
    Scene scene = reference::welded(reference::scene_of(objects), true);
    for (Object& object : scene.objects) object.self = true;
    return Case(std::move(scene));
  }();
  return folded;
}

TEST(CertificateSelf, CountsNeighboursApart) {
  const Case& c = folded();
  const CheckResult result = c.check(c.certificate);
  EXPECT_EQ(result.verdict, Verdict::proved) << result.reason;
  EXPECT_EQ(result.found, c.certificate.claims);
  EXPECT_EQ(result.found.neighbours, c.neighbours);
  EXPECT_EQ(result.found.meeting, c.meeting.size());
  EXPECT_EQ(result.found.separated, c.pairs.size() - c.meeting.size() - c.neighbours);
  EXPECT_GT(c.neighbours, 100u);
}

TEST(CertificateSelf, EveryFalseByteOfNeighboursIsCaught) {
  const Case& c = folded();
  int meeting = 0, apart = 0;
  for (std::size_t i = 0; i < c.pairs.size() && meeting + apart < 40; ++i) {
    if (!reference::neighbours(c.scene, c.pairs[i])) continue;
    const bool meets = c.meets(i);
    ++(meets ? meeting : apart);
    for (const int claim : {0, 37, static_cast<int>(kMeets), static_cast<int>(kNeighbours), 40}) {
      if (claim == (meets ? kMeets : kNeighbours)) continue;
      Certificate changed = c.certificate;
      changed.evidence[i] = static_cast<std::uint8_t>(kKept | claim);
      recount(changed);
      const CheckResult result = c.check(changed);
      const bool refuted = meets ? claim != 40 : claim == kMeets;
      EXPECT_EQ(result.verdict, refuted ? Verdict::refuted : Verdict::not_proved) << claim;
      EXPECT_EQ(result.pair, c.pairs[i]);
    }
    if (!meets) continue;
    Certificate culled = c.certificate;  // a culled pair of neighbours that meets
    culled.evidence[i] = kNeighbours;
    recount(culled);
    EXPECT_EQ(c.check(culled).verdict, Verdict::refuted);
    EXPECT_EQ(c.check(culled).culled_meeting, 1u);
  }
  EXPECT_GT(meeting, 2);
  EXPECT_GT(apart, 10);
}

// For all others the byte means nothing, and a run that lost a pair of neighbours says so itself.
TEST(CertificateSelf, NeighboursAreOfOneObjectAndALostPairRefutes) {
  Scene scene = folded().scene;
  for (Object& object : scene.objects) object.self = false;
  const Case other(scene);
  EXPECT_EQ(other.certificate.claims.neighbours, 0u);
  EXPECT_EQ(other.check(folded().certificate).verdict, Verdict::not_proved);  // another scene
  const auto apart = std::ranges::find_if(other.pairs, [&](const auto& pair) {
    return !std::ranges::binary_search(other.meeting, pair);
  });
  ASSERT_NE(apart, other.pairs.end());
  Certificate changed = other.certificate;
  changed.evidence[static_cast<std::size_t>(apart - other.pairs.begin())] = kNeighbours;
  recount(changed);
  EXPECT_EQ(other.check(changed).verdict, Verdict::not_proved);

  const Case& c = folded();
  std::vector<TrianglePair> kept, colliding;
  std::optional<TrianglePair> lost;
  for (const TrianglePair& pair : c.meeting)
    if (!lost && reference::neighbours(c.scene, pair))
      lost = pair;
    else
      kept.push_back(pair);
  const CheckResult culled = c.check(make_certificate(c.scene, kept, kept, {}));
  EXPECT_EQ(culled.verdict, Verdict::refuted);
  EXPECT_EQ(culled.pair, lost);
  const CheckResult wrong = c.check(make_certificate(c.scene, c.meeting, kept, {}));
  EXPECT_EQ(wrong.verdict, Verdict::refuted);
  EXPECT_EQ(wrong.pair, lost);
}

}  // namespace
}  // namespace farcull
