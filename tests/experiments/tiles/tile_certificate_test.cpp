// Certificates of tiles: each proves the pairs of its tile, and together they are about each pair
// of the scene once.
#include "experiments/tiles/run_tile.h"
#include "tests/lab/certificates.h"

namespace farcull {
namespace {

/// Objects on whole numbers from 0 to 4, so that boxes begin and end on the cuts.
Scene grid_scene(RandomNumbers& random) {
  Scene scene;
  scene.name = "grid";
  for (std::uint32_t o = 0; o < 3; ++o) {
    const auto first = static_cast<std::uint32_t>(scene.triangles.size());
    for (int t = 0; t < 6; ++t) {
      std::array<Vec3, 3> corners;
      for (Vec3& p : corners) {
        for (int i = 0; i < 3; ++i) p[i] = random.below(5);
      }
      add_triangle(scene, corners);
    }
    scene.objects.push_back({"o" + std::to_string(o), first, 6, random.below(2) == 0});
  }
  return scene;
}

SceneSource whole_source(const Scene& scene) {
  return [&scene](const TakePart& take) {
    Scene part = scene;
    take(part);
    return scene.ignored;
  };
}

/// The tiles of a scene and their certificates, by way of their texts.
struct Tiles {
  const Scene& scene;
  Session session{"native"};
  std::vector<TileRun> runs;
  std::vector<Certificate> certificates;

  Tiles(const Scene& of, std::size_t n, double clearance) : scene(of) {
    RunOptions options;
    options.device = "native";
    options.clearance = clearance;
    for (std::size_t k = 1; k <= n; ++k) {
      runs.push_back(
          run_tile(whole_source(scene), {.options = options, .number = {k, n}}, session));
      const WholeScene whole = whole_of(k - 1);
      const Certificate made = certificate_of(runs.back().part.scene, runs.back().record, &whole);
      certificates.push_back(parse_certificate(to_text(made), "tile"));
      EXPECT_EQ(certificates.back(), made);
    }
  }
  WholeScene whole_of(std::size_t k) const {
    return whole_scene(runs[k].census, runs[k].tile, runs[k].part);
  }
  CheckResult check(std::size_t k, const Certificate& certificate) const {
    const WholeScene whole = whole_of(k);
    return check_certificate(certificate, runs[k].part.scene, &whole);
  }
};

TEST(TileCertificates, AreProvedAndAreAboutEachPairOnce) {
  RandomNumbers random(11);
  std::uint64_t pairs = 0, meeting = 0;
  for (int trial = 0; trial < 150; ++trial) {
    SCOPED_TRACE(trial);
    const Scene scene = grid_scene(random);
    const double clearance = trial % 2 == 0 ? 0 : 0.5 * random.below(5);
    const std::size_t n = 1 + random.below(std::size_t{4});
    const Tiles tiles(scene, n, clearance);
    const Case whole(scene, clearance);
    std::uint64_t about = 0, found = 0;
    for (std::size_t k = 0; k < n; ++k) {
      const CheckResult result = tiles.check(k, tiles.certificates[k]);
      EXPECT_EQ(result.verdict, Verdict::proved) << result.reason;
      EXPECT_EQ(result.list_sha256, sha256(tile_list(tiles.runs[k], {})));
      EXPECT_EQ(tiles.certificates[k].not_asked, unasked_of(scene));
      about += result.found.box_pairs;
      found += result.found.meeting;
    }
    EXPECT_EQ(about, whole.pairs.size());
    EXPECT_EQ(found, whole.meeting.size());
    pairs += about;
    meeting += found;
  }
  EXPECT_GT(pairs, 10'000);
  EXPECT_GT(meeting, 1'000);
}

// Twins: whatever is changed, no certificate is proved.
TEST(TileCertificates, ForgedOnesAreNotProved) {
  RandomNumbers random(12);
  int borders = 0;
  for (int trial = 0; trial < 40; ++trial) {
    SCOPED_TRACE(trial);
    const Scene scene = grid_scene(random);
    const Tiles tiles(scene, 2, trial % 2 == 0 ? 0 : 0.5);
    for (std::size_t k = 0; k < 2; ++k) {
      const Certificate& honest = tiles.certificates[k];
      // Another tile's, and with another border: pairs at the border are left out or repeated.
      EXPECT_EQ(tiles.check(1 - k, honest).verdict, Verdict::not_proved);
      Certificate forged = honest;
      double& border = k == 0 ? forged.tile->to : forged.tile->from;
      border += k == 0 ? -1 : 1;
      const TileScene part = gather_tile(whole_source(scene), tiles.runs[k].census, *forged.tile);
      const WholeScene other = whole_scene(tiles.runs[k].census, *forged.tile, part);
      const CheckResult moved = check_certificate(forged, part.scene, &other);
      const bool same_pairs = moved.found.box_pairs == honest.claims.box_pairs;
      EXPECT_TRUE(same_pairs || moved.verdict != Verdict::proved);
      borders += !same_pairs;
      // A pair is left out.
      if (honest.evidence.empty()) continue;
      forged = honest;
      forged.evidence.pop_back();
      recount(forged);
      EXPECT_EQ(tiles.check(k, forged).verdict, Verdict::not_proved);
      // As if it were about the whole scene, and of another one.
      EXPECT_EQ(check_certificate(honest, scene).reason, "the certificate is of a tile alone");
      Scene moved_scene = scene;
      moved_scene.vertices[0].x() += 1;
      const Tiles of_other(moved_scene, 2, honest.clearance);
      EXPECT_EQ(of_other.check(k, honest).verdict, Verdict::not_proved);
    }
  }
  EXPECT_GT(borders, 10);
}

TEST(TileCertificates, AreReadAsWritten) {
  RandomNumbers random(13);
  const Scene scene = grid_scene(random);
  const Tiles tiles(scene, 2, 0);
  const std::string text = to_text(tiles.certificates[1]);
  const auto refused = [&](const std::string& from, const std::string& to) {
    std::string other = text;
    const std::size_t at = other.find(from);
    ASSERT_NE(at, other.npos) << from;
    other.replace(at, from.size(), to);
    EXPECT_THROW(parse_certificate(other, "changed"), Error) << to;
  };
  refused("\"axis\": \"", "\"axis\": \"w");
  refused("\"to\": null", "\"to\": \"inf\"");
  refused("\"to\": null", "\"to\": 1e999");
  refused("\"to\": null", "\"two\": null");
  // Of three tiles of which the middle one runs backwards, two may hold the same pair.
  refused("\"to\": null", "\"to\": -1e9");
  refused("\"version\": 5", "\"version\": 3");
  refused("\"version\": 5", "\"version\": 6");
}

}  // namespace
}  // namespace farcull
