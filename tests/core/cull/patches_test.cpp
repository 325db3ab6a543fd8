// FAR inside objects: patches as owners. On the canvas with the largest errors that the assumptions
// allow nothing is missed; without one of the parts of the argument pairs are lost.
#include "core/cull/patches.h"

#include "core/boxes/meetings.h"
#include "tests/lab/far.h"
#include "verify/worst_canvas.h"

namespace farcull {
namespace {

enum class Twin {
  none,
  inside_not_joined,  // pairs inside a patch are left out
  other_division,     // bits of one division are used for another
  order_reversed,     // bits are read as if the owners were in the opposite order
  not_drawn           // every second triangle of a drawn pair is not drawn, so none hides another
};

struct Asked {
  std::string views = "x,y,z";
  int resolution = 16;
  std::uint32_t patch = 4;
  bool boxes_first = false;  // boxes of triangles say what is drawn
  double factor = 1;         // on the radius of the budget
  Twin twin = Twin::none;
};

struct Found {
  std::uint64_t missed = 0, colliding = 0;
  std::uint64_t culled = 0;   // triangles
  std::uint64_t avoided = 0;  // pairs with overlapping boxes that are not left to test
};

Found far_self_on(Canvas& canvas, const Scene& scene, const Fattener& fattener,
                  const Asked& asked) {
  std::vector<std::uint32_t> all(scene.triangles.size());
  std::iota(all.begin(), all.end(), 0u);
  const std::vector<Box> boxes = triangle_boxes(scene);
  const std::vector<TrianglePair> box_pairs = box_join(boxes, join_owners(scene), all);
  Regions regions = asked.boxes_first
                        ? regions_of(scene, split_pairs(scene, box_pairs, join_owners(scene)).drawn)
                        : find_regions(scene, {.self = true});
  std::vector<std::uint32_t> marked;
  std::ranges::set_intersection(regions.triangles, triangles_of_marked(scene),
                                std::back_inserter(marked));
  Patches patches = cut_patches(scene, boxes, marked, asked.patch);
  PairsToDraw pairs;
  if (asked.boxes_first) {
    pairs = split_pairs(scene, box_pairs, patches.owner);
    regions = regions_of(scene, pairs.drawn);
  }
  if (asked.twin == Twin::not_drawn)
    std::erase_if(regions.triangles, [](std::uint32_t t) { return t % 2 == 0; });
  const CullSettings settings{.views = parse_views(asked.views),
                              .resolution = asked.resolution,
                              .fattener = fattener,
                              .radius = {.published = false, .factor = asked.factor},
                              .owners = patches.owner};
  CullResult result = cull(scene, regions, settings, canvas);
  if (asked.twin == Twin::not_drawn) {  // only the bits of what was drawn lose pairs
    for (std::uint32_t t = 0; t < result.bits.size(); t += 2) result.bits[t] = 0;
  }
  if (asked.twin == Twin::other_division) {
    patches = cut_patches(scene, boxes, marked, asked.patch + 1);
    pairs = split_pairs(scene, box_pairs, patches.owner);
  }
  if (asked.twin == Twin::order_reversed) {
    const auto owners = static_cast<std::uint32_t>(scene.triangles.size());
    for (std::uint32_t& owner : patches.owner) owner = owners - owner;
  }
  std::vector<TrianglePair> left;
  if (asked.boxes_first) {
    remove_cleared(result.bits, patches.owner, pairs.drawn);
    std::ranges::merge(pairs.drawn, pairs.other, std::back_inserter(left));
  } else {
    left = join_patches(scene, boxes, patches, result.live, result.bits);
  }
  if (asked.twin == Twin::inside_not_joined) {
    std::erase_if(left, [&](const TrianglePair& pair) {
      return patches.owner[pair.a] == patches.owner[pair.b];
    });
  }
  const Accounting accounting = account(scene, left);
  return {.missed = accounting.false_negatives,
          .colliding = all_colliding_pairs(scene, {.threads = 1}).pairs.size(),
          .culled = regions.triangles.size() - result.live.size(),
          .avoided = box_pairs.size() - left.size()};
}

// Sheets of n x n squares with common vertices, rolled and crumpled so that they pierce themselves
// and each other; coordinates are multiples of 2^-10. Some of two or three objects are marked.
Scene crumpled(std::uint64_t seed) {
  lab::Random random(seed);
  Scene scene;
  scene.name = "crumpled";
  const int objects = 1 + random.below(3);
  for (int o = 0; o < objects; ++o) {
    const int n = 3 + random.below(8);
    const double noise = std::exp2(-3 - random.below(7)), turns = 1 + random.below(3);
    const auto from = static_cast<std::uint32_t>(scene.vertices.size());
    const auto first = static_cast<std::uint32_t>(scene.triangles.size());
    for (int j = 0; j <= n; ++j) {
      for (int i = 0; i <= n; ++i) {
        const double angle = turns * 6.28 * i / n, radius = 0.25 + 0.5 * i / n;
        Vec3 at(radius * std::cos(angle), 2.0 * j / n - 1, radius * std::sin(angle));
        for (int k = 0; k < 3; ++k)
          at[k] = std::round(1024 * at[k]) / 1024 + random.grid(-noise, noise, 0x1p-10);
        scene.vertices.push_back(at);
      }
    }
    for (int j = 0; j < n; ++j) {
      for (int i = 0; i < n; ++i) {
        const auto v = from + static_cast<std::uint32_t>(j * (n + 1) + i), w = v + n + 1;
        scene.triangles.push_back({v, v + 1, w + 1});
        scene.triangles.push_back({v, w + 1, w});
      }
    }
    const auto count = static_cast<std::uint32_t>(scene.triangles.size()) - first;
    scene.objects.push_back({"o" + std::to_string(o), first, count, o == 0 || random.below(2)});
  }
  for (std::uint32_t t = 0; t < scene.triangles.size(); ++t) scene.source_face.push_back(t);
  validate(scene, scene.name);
  return scene;
}

Asked asked_of(std::uint64_t seed) {
  lab::Random random(seed + 1000);
  const auto any = [&](const auto& of) { return of[random.below(static_cast<int>(of.size()))]; };
  return {.views = any(lab::property_views()),
          .resolution = random.below(3) ? 64 : any(lab::property_resolutions()),
          .patch = static_cast<std::uint32_t>(1 + random.below(40)),
          .boxes_first = random.below(2) == 1};
}

// The sums over scenes, of the same seeds for every twin, which ends where it has lost a pair.
Found crumpled_sum(const Fattener& fattener, int scenes, Twin twin = Twin::none,
                   double factor = 1) {
  WorstCanvas canvas(fattener.solid);
  Found sum;
  for (int n = 0; n < scenes && (twin == Twin::none || sum.missed == 0); ++n) {
    // What loses pairs does so by fixed seeds.
    const bool promises = twin == Twin::none && factor == 1;
    const auto number = static_cast<std::uint64_t>(n);
    const std::uint64_t seed = promises ? test_seed(number) : number;
    Asked asked = asked_of(seed);
    asked.twin = twin;
    asked.boxes_first |= twin == Twin::not_drawn;
    asked.factor = factor;
    const Found found = far_self_on(canvas, crumpled(seed), fattener, asked);
    if (promises) {
      EXPECT_EQ(found.missed, 0u) << "seed " << seed;
    }
    sum.missed += found.missed;
    sum.colliding += found.colliding;
    sum.culled += found.culled;
    sum.avoided += found.avoided;
  }
  return sum;
}

constexpr int kFewScenes = 12;

TEST(FarSelf, MissesNothingOnSheetsThatPierceThemselves) {
  for (const Fattener& fattener : {obb_fattener(), minkowski_fattener()}) {
    const Found sum = crumpled_sum(fattener, trials(6, 2));
    const std::uint64_t at_risk = crumpled_sum(fattener, 2, Twin::none, 0).missed;
    EXPECT_GT(at_risk, 0u) << "no pair is lost without a radius: this proves nothing";
    std::printf(
        "%s: %llu pairs collide, %llu triangles culled, %llu box pairs avoided; %llu pairs at risk "
        "at 0\n",
        fattener.name.c_str(), static_cast<unsigned long long>(sum.colliding),
        static_cast<unsigned long long>(sum.culled), static_cast<unsigned long long>(sum.avoided),
        static_cast<unsigned long long>(at_risk));
  }
}

TEST(FarSelfTwin, PairsInsideAPatchAreLostWhereTheyAreNotJoined) {
  EXPECT_GT(crumpled_sum(obb_fattener(), kFewScenes, Twin::inside_not_joined).missed, 0u);
}

TEST(FarSelfTwin, BitsOfAnotherDivisionLosePairs) {
  EXPECT_GT(crumpled_sum(obb_fattener(), kFewScenes, Twin::other_division).missed, 0u);
}

TEST(FarSelfTwin, BitsReadInTheOppositeOrderLosePairs) {
  EXPECT_GT(crumpled_sum(obb_fattener(), kFewScenes, Twin::order_reversed).missed, 0u);
}

TEST(FarSelfTwin, TrianglesOfDrawnPairsThatAreNotDrawnLosePairs) {
  EXPECT_GT(crumpled_sum(obb_fattener(), kFewScenes, Twin::not_drawn).missed, 0u);
}

// Scene `seed` of a family of extreme scenes, its objects marked, and how it is asked about: in
// small patches, since few pairs are to be inside one, which needs no radius.
std::pair<Scene, Asked> extreme(const lab::Family& family, const Fattener& fattener,
                                std::uint64_t seed) {
  rc::Random random(lab::family_seed(family, fattener) + seed);
  const lab::Given given = lab::given(24)(random, 40).value();
  Scene scene = lab::scene_of(given, family);
  for (Object& object : scene.objects) object.self = true;
  return {scene,
          {.views = given.views,
           .resolution = given.resolution,
           .patch = 1 + static_cast<std::uint32_t>(seed) % 3,
           .boxes_first = seed % 2 == 1}};
}

TEST(FarSelf, MissesNothingInTheFamiliesOfExtremeScenes) {
  for (const Fattener& fattener : {obb_fattener(), minkowski_fattener()}) {
    WorstCanvas canvas(fattener.solid);
    for (const lab::Family& family : lab::families()) {
      SCOPED_TRACE(std::string(family.name) + ", " + fattener.name);
      lab::AtRisk at_risk = {};
      for (std::uint64_t n = 0; more_cases(n, 7, std::ranges::min(at_risk) > 0, 1000); ++n) {
        auto [scene, asked] = extreme(family, fattener, test_seed(0) + n);
        lab::expect_not(
            [&](const Scene& of) { return far_self_on(canvas, of, fattener, asked).missed > 0; },
            scene, std::string("self-") + family.name + "-" + fattener.name,
            "views " + asked.views + " resolution " + std::to_string(asked.resolution) +
                " : against itself, patches of " + std::to_string(asked.patch));
        for (std::size_t i = 0; i < lab::kSmaller.size(); ++i) {
          if (at_risk[i] > 0) continue;
          asked.factor = lab::kSmaller[i];
          at_risk[i] += far_self_on(canvas, scene, fattener, asked).missed;
        }
      }
    }
  }
}

TEST(Patches, AreOwnersOfAtMostTheirSizeInsideTheirObjects) {
  for (int seed = 0; seed < 40; ++seed) {
    const Scene scene = crumpled(seed);
    const std::uint32_t size = asked_of(seed).patch;
    const Patches patches =
        cut_patches(scene, triangle_boxes(scene), triangles_of_marked(scene), size);
    ASSERT_EQ(patches.owner.size(), scene.triangles.size());
    std::map<std::uint32_t, std::uint32_t> members;
    std::uint32_t beyond = 0, count = 0;  // owners of the objects before
    bool cut = false;
    for (const Object& object : scene.objects) {
      std::set<std::uint32_t> own;
      for (std::uint32_t i = 0; i < object.triangle_count; ++i) {
        const std::uint32_t owner = patches.owner[object.first_triangle + i];
        EXPECT_GE(owner, beyond);
        own.insert(owner);
        ++members[owner];
      }
      const std::uint32_t expected =
          object.self ? (object.triangle_count + size - 1) / size : object.triangle_count > 0;
      EXPECT_EQ(own.size(), expected);
      for (const std::uint32_t owner : own)
        if (object.self) {
          EXPECT_LE(members[owner], size);
        }
      if (object.self) count += expected;
      cut |= object.self && expected > 1;
      beyond = *own.rbegin() + 1;
    }
    EXPECT_EQ(patches.count, count);
    EXPECT_EQ(patches.cut, cut);
  }
  EXPECT_THROW(cut_patches(crumpled(0), triangle_boxes(crumpled(0)), {}, 0), std::logic_error);
}

TEST(Patches, LeaveToTestWhatTheContractSays) {
  for (int seed = 0; seed < 40; ++seed) {
    const Scene scene = crumpled(seed);
    const std::vector<Box> boxes = triangle_boxes(scene);
    const std::vector<std::uint32_t> object = owners(scene);
    const Patches patches =
        cut_patches(scene, boxes, triangles_of_marked(scene), asked_of(seed).patch);
    lab::Random random(seed);
    std::vector<std::uint8_t> bits;
    std::vector<std::uint32_t> live;
    for (std::uint32_t t = 0; t < scene.triangles.size(); ++t) {
      bits.push_back(static_cast<std::uint8_t>(random.below(4)));
      if (bits[t] != kCulled) live.push_back(t);
    }
    for (const bool neighbours : {true, false}) {
      std::vector<TrianglePair> expected;
      for (std::uint32_t a = 0; a < boxes.size(); ++a) {
        for (std::uint32_t b = a + 1; b < boxes.size(); ++b) {
          if (!overlap(boxes[a], boxes[b])) continue;
          const std::uint32_t of_a = patches.owner[a], of_b = patches.owner[b];
          const bool proved =
              of_a < of_b ? (bits[a] & kL) || (bits[b] & kF) : (bits[b] & kL) || (bits[a] & kF);
          if (of_a == of_b ? !scene.objects[object[a]].self : proved) continue;
          std::set<std::uint32_t> corners(scene.triangles[a].begin(), scene.triangles[a].end());
          corners.insert(scene.triangles[b].begin(), scene.triangles[b].end());
          if (!neighbours && object[a] == object[b] && corners.size() < 6) continue;
          expected.push_back({a, b});
        }
      }
      EXPECT_EQ(join_patches(scene, boxes, patches, live, bits, neighbours), expected) << seed;
    }
  }
}

// Objects may name the same vertices, as those of one file do. Triangles of two objects that share
// a vertex are a pair that may collide, and no neighbours.
TEST(Patches, TrianglesOfTwoObjectsAreNoNeighboursWhateverTheyShare) {
  Scene scene;
  scene.vertices = {Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(0, 1, 0),
                    Vec3(0, 0, 1), Vec3(1, 1, 1), Vec3(1, 0, 1)};
  scene.triangles = {{0, 1, 2}, {0, 1, 5}, {0, 3, 4}};
  scene.objects = {{"a", 0, 2, true}, {"b", 2, 1, true}};
  const std::vector<Box> boxes = triangle_boxes(scene);
  const std::vector<std::uint32_t> live = {0, 1, 2};
  for (const std::uint32_t size : {1u, 4u}) {
    const Patches patches = cut_patches(scene, boxes, triangles_of_marked(scene), size);
    const auto pairs = [&](bool neighbours) {
      return join_patches(scene, boxes, patches, live, {}, neighbours);
    };
    EXPECT_EQ(pairs(true), (std::vector<TrianglePair>{{0, 1}, {0, 2}, {1, 2}}));
    EXPECT_EQ(pairs(false), (std::vector<TrianglePair>{{0, 2}, {1, 2}}));
  }
}

TEST(Patches, HaveASixteenthOfTheLargestMarkedObjectWithinBounds) {
  const auto size = [](std::uint32_t marked, std::uint32_t other) {
    Scene scene;
    scene.objects = {{"marked", 0, marked, true}, {"other", marked, other, false}};
    return usual_patch_size(scene, triangles_of_marked(scene));
  };
  EXPECT_EQ(size(32000, 1000000), 2000u);
  EXPECT_EQ(size(100, 1000000), 256u);
  EXPECT_EQ(size(1000000, 0), 4096u);
}

}  // namespace
}  // namespace farcull
