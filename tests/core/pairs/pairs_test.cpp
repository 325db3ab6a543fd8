// FAR pairs on the CPU: no intersecting pair is ever missed, and the answer depends on nothing that
// it should not depend on. Each property has a twin that must fail.
#include "core/pairs/pairs.h"
#include "core/boxes/block.h"

#include "core/boxes/join.h"
#include "core/pairs/backend.h"
#include "core/scene/pair_sort.h"
#include "experiments/scenes/builtin/scenes.h"
#include "tests/lab/pairs.h"

namespace farcull {
namespace {

using lab::Changed;
using lab::missed;
using lab::random_scene;
using lab::truth_of;
using lab::with_self;

std::vector<PairSettings> all_settings() {
  std::vector<PairSettings> out(1);  // all chosen by the scene
  out.push_back({.blocks = false});  // and decided by views
  for (const char* views : {"x", "1:1:0.5", "x,y,z", "z,1:-2:0.5,0:1:1"})
    for (const int resolution : {32, 200, 1024})
      out.push_back({.views = parse_views(views), .resolution = resolution});
  out.push_back({.resolution = 4096});
  return out;
}

void expect_none_missed(const Scene& scene, const PairSettings& settings, PairBackend& backend,
                        std::uint64_t seed) {
  lab::expect_not([&](const Scene& of) { return missed(of, settings, backend) > 0; }, scene,
                  "pairs-" + std::to_string(seed),
                  "far-pairs, resolution " + std::to_string(settings.resolution));
}

TEST(Pairs, MissNothingOnRandomScenes) {
  const auto backend = cpu_pair_backend(2);
  std::size_t pairs = 0;
  for (std::uint64_t n = 0; more_cases(n, trials(150), pairs > 100); ++n) {
    const std::uint64_t seed = test_seed(n);
    const Scene scene = random_scene(seed);
    if (pairs <= 100) pairs += truth_of(scene).size();
    for (const PairSettings& settings : all_settings())
      expect_none_missed(scene, settings, *backend, seed);
  }
}

TEST(Pairs, MissNothingInsideObjects) {
  const auto backend = cpu_pair_backend(2);
  for (std::uint64_t n = 0; std::cmp_less(n, trials(100)); ++n) {
    const std::uint64_t seed = test_seed(n);
    Scene scene = with_self(random_scene(seed));
    if (seed % 3 == 0) scene.objects[0].self = false;
    for (const PairSettings& settings : all_settings())
      expect_none_missed(scene, settings, *backend, seed);
  }
}

TEST(Pairs, MissNothingWithinAClearance) {
  const auto backend = cpu_pair_backend(2);
  for (std::uint64_t n = 0; std::cmp_less(n, trials(60)); ++n) {
    const std::uint64_t seed = test_seed(n);
    Scene scene = random_scene(seed);
    if (n % 2 == 0) scene = with_self(std::move(scene));
    for (const double clearance : {0x1p-10, 0.01, 0.3}) {
      for (const int resolution : {0, 64, 512}) {
        PairSettings settings{.resolution = resolution, .clearance = clearance};
        expect_none_missed(scene, settings, *backend, seed);
        settings.views = parse_views("x,y,z");
        expect_none_missed(scene, settings, *backend, seed);
      }
    }
  }
}

// The clearance in pixels is that of the scene in a unit of its own, whatever the world's unit is.
TEST(Pairs, MissNothingWithinAClearanceAtAnyScale) {
  const auto backend = cpu_pair_backend(1);
  for (const double scale : {1e-300, 1e-160, 1e-20, 1.0, 1e100, 1e158, 1e200, 1e290}) {
    std::vector<std::vector<std::array<Vec3, 3>>> objects(2);
    objects[0].push_back({Vec3(0, 0, 0), Vec3(40, 0, 0), Vec3(0, 40, 0)});
    objects[1].push_back({Vec3(100, 100, 0), Vec3(60, 100, 0), Vec3(100, 60, 0)});
    for (auto& object : objects)
      for (Vec3& corner : object[0]) corner *= scale;
    const Scene scene = lab::scene_of(objects);
    for (const int resolution : {0, 64, 4096}) {
      const PairSettings settings{
          .views = parse_views("z,x"), .resolution = resolution, .clearance = 86 * scale};
      ASSERT_EQ(truth_of(scene, settings.clearance).size(), 1u);
      EXPECT_EQ(missed(scene, settings, *backend), 0u) << scale << " at " << resolution;
    }
  }
}

TEST(Pairs, MissNothingOnBuiltInScenes) {
  const auto backend = cpu_pair_backend(2);
  for (const char* name :
       {"two-spheres", "random-soup", "needles", "degenerate", "ground", "crowd", "needles@far",
        "needles@tiny", "two-spheres@ground", "degenerate@huge"}) {
    const Scene scene = make_builtin_scene(name);
    const std::vector<TrianglePair> truth = truth_of(scene);
    for (const PairSettings& settings : all_settings()) {
      EXPECT_EQ(missed(truth, find_pairs(scene, settings, *backend).candidates), 0u)
          << name << " at " << settings.resolution;
    }
  }
}

TEST(Pairs, MissNothingOfWhatAViewCannotShow) {
  const auto backend = cpu_pair_backend(2);
  for (const Scene& scene : {lab::undrawable_scene(), with_self(lab::undrawable_scene())})
    for (const PairSettings& settings : all_settings())
      EXPECT_EQ(missed(scene, settings, *backend), 0u);
  const Scene scene = lab::undrawable_scene();
  EXPECT_GT(truth_of(scene).size(), 0u);
  const PairResult result =
      find_pairs(scene, {.views = parse_views("z"), .resolution = 64}, *backend);
  EXPECT_GT(result.views[0].counts.undrawable, 0u);
}

TEST(Pairs, DependOnNeitherThreadsNorMemoryNorEarlierCalls) {
  const auto one = cpu_pair_backend(1), five = cpu_pair_backend(5),
             tight = cpu_pair_backend(2, 4096), tiny = cpu_pair_backend(3, 1);
  for (std::uint64_t seed = 0; seed < 60; ++seed) {
    const Scene scene = seed % 2 == 0 ? random_scene(seed) : with_self(random_scene(seed));
    for (const PairSettings& settings :
         {PairSettings{}, PairSettings{.resolution = 100},
          PairSettings{.views = parse_views("x,y,z"), .resolution = 40}}) {
      const PairResult expected = find_pairs(scene, settings, *one);
      for (PairBackend* backend : {one.get(), five.get(), tight.get(), tiny.get()}) {
        const PairResult result = find_pairs(scene, settings, *backend);
        ASSERT_EQ(result.candidates, expected.candidates) << "seed " << seed;
        for (std::size_t v = 0; v < result.views.size(); ++v) {
          ASSERT_EQ(result.views[v].counts.entries, expected.views[v].counts.entries);
          ASSERT_EQ(result.views[v].counts.crowded, expected.views[v].counts.crowded);
        }
      }
      if (!expected.views.empty() && expected.views[0].counts.entries > 1000) {
        EXPECT_GT(find_pairs(scene, settings, *tight).views[0].counts.bands,
                  expected.views[0].counts.bands);
      }
    }
  }
}

// Many layers in few pixels: crowded ones are cut, which changes the work and loses nothing.
TEST(Pairs, CutCrowdedPixels) {
  lab::Random random(5);
  std::vector<std::vector<std::array<Vec3, 3>>> objects(2);
  for (int n = 0; n < 20000; ++n) {
    std::array<Vec3, 3> t;
    const Vec3 at(random.grid(0, 1, 0x1p-12), random.grid(0, 1, 0x1p-12),
                  random.grid(0, 1, 0x1p-12));
    for (Vec3& c : t) {
      c = at + Vec3(random.grid(-0x1p-6, 0x1p-6, 0x1p-14), random.grid(-0x1p-6, 0x1p-6, 0x1p-14),
                    random.grid(-1, 1, 0x1p-12));
    }
    objects[n % 2].push_back(t);
  }
  const auto backend = cpu_pair_backend(2);
  for (const Scene& scene : {lab::scene_of(objects), with_self(lab::scene_of(objects))}) {
    const PairSettings settings{.views = parse_views("z"), .resolution = 2};
    const PairResult result = find_pairs(scene, settings, *backend);
    EXPECT_GT(result.views[0].counts.crowded, 0u);
    EXPECT_LT(result.views[0].counts.tests, std::uint64_t{20000} * 20000 / 8);
    EXPECT_EQ(missed(truth_of(scene), result.candidates), 0u);
  }
}

// A ground of two triangles under a thousand small ones is compared, not listed.
TEST(Pairs, CompareLargeTrianglesDirectly) {
  const Scene scene = make_builtin_scene("crowd@ground");
  const auto backend = cpu_pair_backend(2);
  const PairSettings settings{.views = parse_views("z"), .resolution = 1024};
  const PairResult result = find_pairs(scene, settings, *backend);
  EXPECT_GE(result.views[0].counts.large, 2u);
  EXPECT_LT(result.views[0].counts.entries, 400000u);
  EXPECT_EQ(missed(truth_of(scene), result.candidates), 0u);
}

TEST(Pairs, LeaveOutWhatCannotMeet) {
  const auto backend = cpu_pair_backend(2);
  const PairResult apart = find_pairs(make_builtin_scene("far-apart"), {}, *backend);
  EXPECT_TRUE(apart.candidates.empty());
  EXPECT_TRUE(apart.views.empty());
  for (const PairResult& result : {find_pairs(make_builtin_scene("crowd"), {}, *backend)}) {
    const Scene scene = make_builtin_scene("crowd");
    for (const TrianglePair& pair : result.candidates)
      ASSERT_TRUE(overlap(grown_box(scene, pair.a, 0), grown_box(scene, pair.b, 0)));
  }
}

TEST(Pairs, LeaveOutNeighboursByIndexOnly) {
  const Scene scene = with_self(make_builtin_scene("two-spheres"));
  const auto backend = cpu_pair_backend(2);
  const std::vector<std::uint32_t> owner = owners(scene);
  for (const bool runs : {true, false}) {
    const PairResult all = find_pairs(scene, {.blocks = runs}, *backend);
    EXPECT_EQ(all.views.empty(), runs);
    const PairResult fewer = find_pairs(scene, {.blocks = runs, .neighbours = false}, *backend);
    std::vector<TrianglePair> expected = all.candidates;
    std::erase_if(expected, [&](const TrianglePair& pair) {
      if (owner[pair.a] != owner[pair.b]) return false;
      for (const std::uint32_t v : scene.triangles[pair.a]) {
        const auto& other = scene.triangles[pair.b];
        if (std::ranges::find(other, v) != other.end()) return true;
      }
      return false;
    });
    EXPECT_EQ(fewer.candidates, expected);
    EXPECT_LT(fewer.candidates.size(), all.candidates.size() / 4);
  }
}

// The objects of both scenes, those of the second one moved.
Scene joined(Scene scene, const Scene& other, const Vec3& by) {
  const auto vertices = static_cast<std::uint32_t>(scene.vertices.size());
  const auto triangles = static_cast<std::uint32_t>(scene.triangles.size());
  for (const Vec3& v : other.vertices) scene.vertices.push_back(v + by);
  for (const auto& [p, q, r] : other.triangles)
    scene.triangles.push_back({p + vertices, q + vertices, r + vertices});
  scene.source_face.insert(scene.source_face.end(), other.source_face.begin(),
                           other.source_face.end());
  for (Object object : other.objects) {
    object.first_triangle += triangles;
    scene.objects.push_back(object);
  }
  return scene;
}

// Two heaps of needles in all directions: the boxes of all runs overlap, oriented ones too.
Scene heaps(lab::Random& random) {
  const auto coordinate = [&] { return random.between(-1, 1); };
  std::vector<std::vector<std::array<Vec3, 3>>> objects(2);
  for (auto& object : objects) {
    for (int k = 0; k < 1500; ++k) {
      const Vec3 p(coordinate(), coordinate(), coordinate());
      const Vec3 along = Vec3(coordinate(), coordinate(), coordinate()).normalized();
      const Vec3 tip = 0.02 * Vec3(coordinate(), coordinate(), coordinate());
      object.push_back({p - 3 * along, p + 3 * along + 0.1 * tip, p + tip});
    }
  }
  return lab::scene_of(objects);
}

// Where runs decide some meetings and views others, the pairs of both are found.
TEST(Pairs, OfRunsAndOfViewsAreFoundTogether) {
  lab::Random random(3);
  const Scene scene = joined(heaps(random), make_builtin_scene("two-spheres"), Vec3(50, 0, 0));
  const auto backend = cpu_pair_backend(2);
  const PairPlan plan = plan_pairs(scene, {}, 2);
  ASSERT_FALSE(plan.blocks.empty());
  ASSERT_FALSE(plan.regions.triangles.empty());
  PairWorkspace workspace;
  const std::vector<TrianglePair> truth = lab::truth_of(scene);
  EXPECT_EQ(lab::missed(truth, find_pairs(scene, plan, *backend, workspace).candidates), 0u);
  EXPECT_EQ(plan.trace.front().out, plan.blocks.triangles + plan.regions.triangles.size());
  // Twins: without either half pairs are lost.
  PairPlan views = plan, runs = plan;
  views.blocks = {};
  runs.choices.clear();
  runs.regions.triangles.clear();
  EXPECT_GT(lab::missed(truth, find_pairs(scene, views, *backend, workspace).candidates), 0u);
  EXPECT_GT(lab::missed(truth, find_pairs(scene, runs, *backend, workspace).candidates), 0u);
}

// Objects whose boxes all overlap: their pairs are not listed, which would take memory that grows
// with the square of the objects.
TEST(Pairs, OfManyObjectsThatAllOverlapAreFound) {
  lab::Random random(5);
  const auto coordinate = [&] { return random.between(-1, 1); };
  std::vector<std::vector<std::array<Vec3, 3>>> objects(300);
  for (auto& object : objects) {
    for (int k = 0; k < 20; ++k) {
      const auto point = [&](double size) {
        return Vec3(size * coordinate(), size * coordinate(), size * coordinate());
      };
      const Vec3 p = point(1);
      object.push_back({p, p + point(0.3), p + point(0.3)});
    }
  }
  const Scene scene = lab::scene_of(objects);
  const PairPlan plan = plan_pairs(scene, {}, 2);
  EXPECT_TRUE(plan.regions.crowded);
  EXPECT_TRUE(plan.blocks.empty());
  const auto backend = cpu_pair_backend(2);
  for (const bool runs : {true, false}) {
    EXPECT_EQ(lab::missed(scene, {.blocks = runs}, *backend), 0u);
    EXPECT_EQ(lab::missed(with_self(scene), {.blocks = runs}, *backend), 0u);
  }
  EXPECT_GT(lab::truth_of(scene).size(), 1000u);
}

TEST(Pairs, LookAlongTheNeedles) {
  const Scene scene = make_builtin_scene("needles-layers");
  const auto backend = cpu_pair_backend(2);
  const PairResult chosen = find_pairs(scene, {.blocks = false}, *backend);
  ASSERT_EQ(chosen.views.size(), 1u);
  const PairResult again = find_pairs(scene, {.blocks = false}, *backend);
  EXPECT_EQ(chosen.views[0].name, again.views[0].name);
  EXPECT_EQ(chosen.candidates, again.candidates);
  EXPECT_LT(chosen.candidates.size(), 10000u);
  // Twin: across them every pixel is crowded.
  const PairRegions regions = pair_regions(scene, 0);
  EXPECT_EQ(choose_pair_views(scene, regions, 0)[0].view.name, chosen.views[0].name);
  EXPECT_NE(chosen.views[0].name, "x");
}

// Twins: what each ingredient is there for.
std::size_t missed_by(Changed::Change change, double clearance = 0) {
  Changed backend(change);
  std::size_t count = 0;
  for (std::uint64_t seed = 0; seed < 60; ++seed) {
    const Scene scene = random_scene(seed);
    const std::vector<TrianglePair> truth = truth_of(scene, clearance);
    for (const int resolution : {64, 512}) {
      const PairSettings settings{
          .views = parse_views("z"), .resolution = resolution, .clearance = clearance};
      count += missed(truth, find_pairs(scene, settings, backend).candidates);
    }
  }
  return count;
}

TEST(PairsTwin, IntervalsThatAreTooShortMiss) {
  EXPECT_EQ(missed_by([](PairTask&) {}), 0u);
  EXPECT_GT(missed_by([](PairTask& task) { task.widening = {-0.05f, -0.05f, -0.05f, 0}; }), 0u);
}

TEST(PairsTwin, AClearanceOfNineTenthsMisses) {
  EXPECT_EQ(missed_by([](PairTask&) {}, 0.05), 0u);
  EXPECT_GT(missed_by([](PairTask& task) { task.widening = 0.9f * task.widening; }, 0.05), 0u);
}

TEST(PairsTwin, LimitsThatAreTooTightMiss) {
  EXPECT_GT(missed_by([](PairTask& task) {
              static std::vector<PixelBox> limits;
              limits.assign(task.limits.begin(), task.limits.end());
              for (PixelBox& box : limits) box.hi.x -= 2.5f;
              task.limits = limits;
            }),
            0u);
}

TEST(PairsTwin, ADroppedTriangleMisses) {
  EXPECT_GT(missed_by([](PairTask& task) { task.active = task.active.subspan(1); }), 0u);
}

TEST(PairsTwin, VerticesMovedByATenthOfAPixelMiss) {
  EXPECT_GT(missed_by([](PairTask& task) {
              static std::vector<PixelVertex> moved;
              moved.assign(task.vertices.begin(), task.vertices.end());
              for (std::size_t v = 0; v < moved.size(); ++v) moved[v].z += v % 2 ? 0.1f : -0.1f;
              task.vertices = moved;
            }),
            0u);
}

TEST(PairSort, SortsAndDropsDuplicates) {
  lab::Random random(9);
  for (int round = 0; round < 200; ++round) {
    const int range = 1 + random.below(1000);
    std::vector<std::vector<TrianglePair>> parts(1 + random.below(5));
    std::set<TrianglePair> expected;
    for (auto& part : parts) {
      for (int n = random.below(round % 2 ? 20 : 9000); n > 0; --n) {
        const auto a = static_cast<std::uint32_t>(random.below(range));
        const auto b = static_cast<std::uint32_t>(random.below(5000));
        part.push_back({a, b});
        expected.insert({a, b});
      }
    }
    for (const unsigned threads : {1u, 3u}) {
      const std::vector<TrianglePair> sorted = sorted_unique(parts, threads);
      ASSERT_TRUE(std::equal(sorted.begin(), sorted.end(), expected.begin(), expected.end()));
    }
    const std::vector<TrianglePair> sorted = sorted_unique(std::move(parts), 2);
    ASSERT_TRUE(std::equal(sorted.begin(), sorted.end(), expected.begin(), expected.end()));
  }
  EXPECT_TRUE(sorted_unique(std::span<const std::vector<TrianglePair>>(), 1).empty());
}

}  // namespace
}  // namespace farcull
