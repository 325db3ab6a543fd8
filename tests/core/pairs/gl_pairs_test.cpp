// FAR pairs on a GL device against the CPU's: the same candidates, entry for entry, whatever the
// memory; nothing missed; and every fault of assumption A7 noticed.
#include "core/gl/base/driver_fault.h"
#include "core/gl/pairs/pairs.h"

#include <rapidcheck.h>

#include "core/pairs/backend.h"
#include "core/pairs/pairs.h"
#include "experiments/scenes/builtin/scenes.h"
#include "tests/lab/far.h"
#include "tests/lab/gl.h"
#include "tests/lab/pairs.h"
#include "tests/lab/strays.h"
#include "verify/exact.h"

namespace farcull {
namespace {

using lab::crowded_scene;
using lab::missed;
using lab::mixed_scene;
using lab::Random;
using lab::random_scene;
using lab::scene_of;
using lab::settings_of;
using lab::with_self;

GlPairs& shared() {
  static GlPairs backend(lab::context());
  return backend;
}

// Both back ends on each task; counts where they differ.
class Both final : public PairBackend {
 public:
  explicit Both(PairBackend& gl) : gl_(gl), cpu_(cpu_pair_backend(2)) {}
  std::string name() const override { return "both"; }
  // Without a limit of work, which each of them measures in its own way.
  std::vector<TrianglePair> raw_pairs(const PairTask& of, PairCounts& counts) override {
    PairTask task = of;
    task.most_tests = UINT64_MAX;
    PairCounts on_cpu;
    std::vector<TrianglePair> expected = cpu_->raw_pairs(task, on_cpu);
    std::vector<TrianglePair> found = gl_.raw_pairs(task, counts);
    if (task.narrow) task.narrow(expected), task.narrow(found);  // either may have done so
    ++views;
    pairs += expected.size();
    crowded += on_cpu.crowded;
    large += counts.large;
    bands += counts.bands;
    wrong += found != expected;
    missing +=
        static_cast<std::size_t>(std::ranges::count_if(expected, [&](const TrianglePair& pair) {
          return !std::ranges::binary_search(found, pair);
        }));
    wrong_counts += counts.entries != on_cpu.entries || counts.crowded != on_cpu.crowded;
    return found;
  }

  std::size_t views = 0, pairs = 0, crowded = 0, large = 0, bands = 0;
  std::size_t wrong = 0;    // views where the pairs differ
  std::size_t missing = 0;  // pairs of the CPU's that GL has not
  std::size_t wrong_counts = 0;

 private:
  PairBackend& gl_;
  std::unique_ptr<PairBackend> cpu_;
};

void expect_same(const Both& both) {
  EXPECT_EQ(both.wrong, 0u) << both.missing << " pairs are missing";
  EXPECT_EQ(both.wrong_counts, 0u);
}

TEST(GlPairs, EqualTheCpusOnRandomScenes) {
  Both both(shared());
  const auto scenes = static_cast<std::uint64_t>(trials(140));
  for (std::uint64_t seed = 0; seed < scenes; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    Scene scene = random_scene(seed);
    if (seed % 3 == 1) scene = with_self(std::move(scene));
    if (seed % 3 == 2) scene = with_self(std::move(scene), 2);
    find_pairs(scene, settings_of(seed), both);
    ASSERT_EQ(both.wrong, 0u);
  }
  expect_same(both);
  EXPECT_GT(both.pairs, 70 * scenes);
  EXPECT_GT(both.large, 0u);
}

TEST(GlPairs, EqualTheCpusOnBuiltInScenes) {
  Both both(shared());
  for (const char* name :
       {"two-spheres", "random-soup", "needles", "degenerate", "ground", "crowd", "needles@far",
        "needles@tiny", "two-spheres@ground", "degenerate@huge"}) {
    const Scene scene = make_builtin_scene(name);
    for (const int resolution : {0, 32, 256}) {
      SCOPED_TRACE(std::string(name) + " at " + std::to_string(resolution));
      find_pairs(scene, {.resolution = resolution}, both);
      if (resolution <= 32) {
        find_pairs(with_self(scene), {.views = parse_views("x,y,z"), .resolution = resolution},
                   both);
        const Box box = object_boxes(scene, triangle_boxes(scene))[0];
        const double clearance = 0.01 * (box.hi - box.lo).maxCoeff();
        find_pairs(scene, {.resolution = resolution, .clearance = clearance}, both);
      }
      ASSERT_EQ(both.wrong, 0u);
    }
  }
  find_pairs(make_builtin_scene("needles"), {.resolution = 4096}, both);
  expect_same(both);
  EXPECT_GT(both.pairs, 10'000u);
}

TEST(GlPairs, EqualTheCpusInCrowdedPixels) {
  Both both(shared());
  for (std::uint64_t seed = 1; seed <= static_cast<std::uint64_t>(trials(6, 3)); ++seed) {
    const Scene scene = crowded_scene(seed, 600 * static_cast<int>(seed));
    for (const int resolution : {1, 4, 33}) {
      find_pairs(seed % 2 == 0 ? scene : with_self(scene),
                 {.views = parse_views("z,x"), .resolution = resolution}, both);
    }
  }
  expect_same(both);
  EXPECT_GT(both.crowded, 6u);
}

TEST(GlPairs, LeaveOutNeighboursLikeTheCpu) {
  const auto cpu = cpu_pair_backend(2);
  const Scene scene = with_self(make_builtin_scene("two-spheres"));
  for (const bool neighbours : {true, false}) {
    const PairSettings settings{.blocks = false, .neighbours = neighbours};
    const PairResult by_cpu = find_pairs(scene, settings, *cpu);
    ASSERT_FALSE(by_cpu.views.empty());
    const std::vector<TrianglePair>& expected = by_cpu.candidates;
    EXPECT_EQ(find_pairs(scene, settings, shared()).candidates, expected);
    EXPECT_GT(expected.size(), 100u);
    GlPairs gathering(lab::context(), {.storage_limit = 100'000});
    EXPECT_EQ(find_pairs(scene, settings, gathering).candidates, expected);
  }
}

TEST(GlPairs, MissNothing) {
  for (std::uint64_t seed = 200; seed < 200 + static_cast<std::uint64_t>(trials(120)); ++seed) {
    Scene scene = random_scene(seed);
    if (seed % 2 == 0) scene = with_self(std::move(scene));
    ASSERT_EQ(missed(scene, settings_of(seed), shared()), 0u) << "seed " << seed;
  }
}

// Scenes where the error bounds are all that is left: contacts in one point, far from the origin.
Scene touching_scene(std::uint64_t seed) {
  Random random(seed);
  std::vector<std::vector<std::array<Vec3, 3>>> objects(2);
  for (auto& object : objects) {
    object.push_back({Vec3(-1, -1, -1), Vec3(-1, -1, -1), Vec3(-1, -1, -1)});
    object.push_back({Vec3(1, 1, 1), Vec3(1, 1, 1), Vec3(1, 1, 1)});
  }
  for (int i = 0; i < 300; ++i) {
    const Vec3 q(random.between(-0.9, 0.9), random.between(-0.9, 0.9), random.between(-0.9, 0.9));
    const auto away = [&] {
      return Vec3(q + Vec3(random.between(-0.09, 0.09), random.between(-0.09, 0.09), 0));
    };
    Vec3 a = away(), b = away(), c = away(), d = away();
    a.z() += random.between(0.001, 0.05);
    b.z() += random.between(0.001, 0.05);
    c.z() -= random.between(0.001, 0.05);
    d.z() -= random.between(0.001, 0.05);
    objects[0].push_back({q, a, b});
    objects[1].push_back({q, c, d});
  }
  return scene_of(objects);
}

TEST(GlPairs, MissNoContactInOnePoint) {
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    for (const int resolution : {3, 64, 1000}) {
      EXPECT_EQ(missed(touching_scene(seed),
                       {.views = parse_views("1:2:3"), .resolution = resolution}, shared()),
                0u);
    }
  }
}

// A device that sees every triangle a twentieth of a pixel too small.
class Shrunk final : public PairBackend {
 public:
  std::string name() const override { return "shrunk"; }
  std::vector<TrianglePair> raw_pairs(const PairTask& task, PairCounts& counts) override {
    PairTask other = task;
    other.widening = {-0.05f, -0.05f, -0.05f, 0};
    return shared().raw_pairs(other, counts);
  }
};

// The twin: intervals that are too short miss pairs, and the comparison with the CPU notices.
TEST(GlPairs, TwinWithShortIntervalsMisses) {
  Shrunk shrunk;
  Both both(shrunk);
  std::size_t lost = 0;
  for (std::uint64_t seed = 200; seed < 230; ++seed) {
    const PairSettings settings{.views = parse_views("z"), .resolution = 64};
    lost += missed(random_scene(seed), settings, shrunk);
    find_pairs(random_scene(seed), settings, both);
  }
  EXPECT_GT(lost, 0u);
  EXPECT_GT(both.wrong, 0u);
  EXPECT_GT(both.missing, 0u);
}

TEST(GlPairs, DoNotDependOnMemoryOrStorageBlocks) {
  const GlPairOptions few[] = {{.memory = 60'000},
                               {.memory = 4'000},
                               {.storage_limit = 60'000},
                               {.memory = 50'000, .storage_limit = 40'000}};
  std::vector<Scene> scenes = {with_self(random_scene(11)), random_scene(3),
                               make_builtin_scene("two-spheres"), crowded_scene(2, 60)};
  for (const GlPairOptions& options : few) {
    GlPairs tight(lab::context(), options);
    Both both(tight);
    for (const Scene& scene : scenes)
      find_pairs(scene, {.views = parse_views("1:1:0.5,z"), .resolution = 40}, both);
    EXPECT_EQ(both.wrong, 0u);
    EXPECT_GT(both.bands, 2 * both.views) << "the window was never split";
  }
}

TEST(GlPairs, RefusePixelsBeyondAStorageBlock) {
  GlPairs tight(lab::context(), {.storage_limit = 2'000});
  EXPECT_THROW(find_pairs(crowded_scene(1, 100), {.resolution = 1}, tight), Error);
  // And go on afterwards.
  GlPairs& free = shared();
  EXPECT_FALSE(find_pairs(crowded_scene(1, 100), {.resolution = 1}, free).candidates.empty());
}

// Where pairs repeat from pixel to pixel, each is emitted once, and the answer is that of every
// pixel by itself: the CPU's with so little memory that it remembers nothing.
TEST(GlPairs, EqualEveryPixelByItselfWherePairsRepeat) {
  GlPairs tight(lab::context(), {.memory = 200'000});
  std::size_t pairs = 0;
  lab::for_each_task([&](const PairTask& task, const std::string& name) {
    SCOPED_TRACE(name);
    PairCounts counts;
    const std::vector<TrianglePair> expected = cpu_pair_backend(1, 1)->raw_pairs(task, counts);
    pairs += expected.size();
    EXPECT_EQ(shared().raw_pairs(task, counts), expected);
    EXPECT_EQ(tight.raw_pairs(task, counts), expected);
  });
  EXPECT_GT(pairs, 1'000'000u);
}

// The twin: bits of an earlier call make pairs disappear.
TEST(GlPairsTwin, WithStaleBitsPairsAreLost) {
  const Scene scene = lab::coincident(150, 0, 3);
  const PairRegions regions = pair_regions(scene, 0, false, 1);
  PairScene seen;
  look(scene, regions, regions.triangles, pair_window(regions, parse_view("z"), 9, 0).value(), 1,
       seen);
  PairCounts counts;
  GlPairs clean(lab::context());
  EXPECT_EQ(clean.raw_pairs(seen.task, counts).size(), 150u * 150);
  EXPECT_EQ(clean.raw_pairs(seen.task, counts).size(), 150u * 150);
  const DriverFault fault(DriverFaultKind::kept_bits);
  GlPairs stale(lab::context());
  // Each leaves the bits of all pairs; the second one has room for more records, so that its bits
  // lie elsewhere, and the third has the same room.
  stale.raw_pairs(seen.task, counts);
  stale.raw_pairs(seen.task, counts);
  EXPECT_EQ(stale.raw_pairs(seen.task, counts).size(), 0u);
}

TEST(GlPairs, NoticeEveryFault) {
  const Scene scene = mixed_scene();
  const PairSettings settings{.views = parse_views("z"), .resolution = 24};
  GlPairs backend(lab::context());
  const PairResult clean = find_pairs(scene, settings, backend);
  ASSERT_GT(clean.views[0].counts.crowded, 0u);
  ASSERT_GT(clean.views[0].counts.large, 0u);
  const std::size_t dispatches = backend.dispatches();
  ASSERT_GT(dispatches, 20u);
  // Of the first call counts were read, and what did not fit was repeated.
  find_pairs(scene, settings, backend);
  const std::size_t again = backend.dispatches();
  EXPECT_LE(again, dispatches);
  // Each call of a fresh backend is like the first one.
  const auto find_under = [&](DriverFaultKind kind, std::size_t at) {
    DriverFault fault(kind, at);
    GlPairs faulty(lab::context());
    fault.strike(at);
    return find_pairs(scene, settings, faulty).candidates;
  };
  for (const DriverFaultKind kind :
       {DriverFaultKind::lost_dispatch, DriverFaultKind::oversized_dispatch,
        DriverFaultKind::unfinished_item}) {
    // A fault makes the next one compile all programs again, so two kinds strike every fifth time.
    const std::size_t stride = kind == DriverFaultKind::lost_dispatch ? 1 : 5;
    std::size_t noticed = 0, tried = 0;
    for (std::size_t at = 0; at < dispatches; at += stride, ++tried) {
      try {
        // A dispatch may have nothing to do; then none of its items can be lost.
        EXPECT_EQ(find_under(kind, at), clean.candidates)
            << "fault " << static_cast<int>(kind) << " of dispatch " << at;
      } catch (const Error&) {
        ++noticed;
      }
    }
    const bool may_have_none = kind == DriverFaultKind::unfinished_item;
    EXPECT_GE(noticed, may_have_none ? tried / 2 : tried);
  }
  for (std::size_t at = 0; at < 10; ++at)
    EXPECT_THROW(find_under(DriverFaultKind::wrong_count, 37 * at), Error) << "count " << 37 * at;
  // The twin: a fault beyond the last dispatch is none.
  EXPECT_EQ(find_under(DriverFaultKind::lost_dispatch, dispatches), clean.candidates);
  // Nothing of a fault is left after it.
  {
    DriverFault fault(DriverFaultKind::lost_dispatch);
    fault.strike(again / 2);
    EXPECT_THROW(find_pairs(scene, settings, backend), Error);
  }
  EXPECT_EQ(find_pairs(scene, settings, backend).candidates, clean.candidates);
}

// The same faults of a window whose work was foreseen: no count is read before all is done, and
// each dispatch learns on the device how much there is to do.
TEST(GlPairs, NoticeEveryFaultOfAWindowThatWasForeseen) {
  const Scene scene = mixed_scene();
  const PairSettings settings{.views = parse_views("z"), .resolution = 24};
  for (const DriverFaultKind kind :
       {DriverFaultKind::lost_dispatch, DriverFaultKind::oversized_dispatch,
        DriverFaultKind::unfinished_item}) {
    const std::size_t stride = kind == DriverFaultKind::lost_dispatch ? 1 : 7;
    std::size_t noticed = 0, tried = 0, dispatches = 1;
    for (std::size_t at = 0; at <= dispatches; at += stride) {
      DriverFault fault(kind, at);
      GlPairs faulty(lab::context());
      const auto right = find_pairs(scene, settings, faulty).candidates;
      if (at == 0) {
        EXPECT_EQ(find_pairs(scene, settings, faulty).candidates, right);
        dispatches = faulty.dispatches();
      }
      fault.strike(at);
      tried += at < dispatches;
      try {
        EXPECT_EQ(find_pairs(scene, settings, faulty).candidates, right)
            << "fault " << static_cast<int>(kind) << " of dispatch " << at;
      } catch (const Error&) {
        ++noticed;
        EXPECT_LT(at, dispatches);  // the twin: a fault beyond the last dispatch is none
      }
    }
    EXPECT_GE(noticed, kind == DriverFaultKind::unfinished_item ? tried / 2 : tried);
  }
}

// Where what was foreseen is too little, the work is done again; nothing is written beyond a
// buffer, and nothing is believed.
TEST(GlPairs, DoItAgainWhereMoreComesThanWasForeseen) {
  GlPairs backend(lab::context());
  Both both(backend);
  const PairSettings settings{.views = parse_views("z"), .resolution = 24};
  const Scene full = mixed_scene();
  std::size_t redone = 0;
  for (std::uint64_t seed = 0; seed < 12; ++seed) {
    Scene thin = full;  // as many triangles, of which few meet anything
    Random random(seed);
    const double apart = std::exp2(1 + random.below(4)), size = std::exp2(-random.below(8));
    for (std::size_t v = 0; v < thin.vertices.size(); ++v) {
      if (v % 3 == 0 || seed % 3 == 0) thin.vertices[v] = size * thin.vertices[v];
      if (seed % 2 == 0) thin.vertices[v].x() += apart * static_cast<double>(v / 3 % 2);
    }
    for (const Scene* scene : std::initializer_list<const Scene*>{&thin, &full}) {
      const PairResult found = find_pairs(*scene, settings, both);
      for (const PairView& view : found.views) redone += view.counts.redone;
    }
  }
  expect_same(both);
  EXPECT_GT(redone, 1u);
}

TEST(GlPairs, SendOnlyWhatChanged) {
  GlPairs backend(lab::context());
  Scene scene = make_builtin_scene("crowd");
  const PairSettings settings{.views = parse_views("z"), .resolution = 64};
  find_pairs(scene, settings, backend);
  EXPECT_GT(backend.uploaded_bytes(), 20 * scene.triangles.size());
  const auto before = find_pairs(scene, settings, backend).candidates;
  EXPECT_EQ(backend.uploaded_bytes(), 0u);

  // A vertex inside its object's box, so that window and limits stay.
  const std::vector<Box> boxes = object_boxes(scene, triangle_boxes(scene));
  std::uint32_t moved = 0;
  for (const std::uint32_t v : scene.triangles[0]) {
    const Vec3& p = scene.vertices[v];
    if ((p.array() > boxes[0].lo.array()).all() && (p.array() < boxes[0].hi.array()).all())
      moved = v;
  }
  scene.vertices[moved] = 0.5 * (scene.vertices[moved] + 0.5 * (boxes[0].lo + boxes[0].hi));
  Both both(backend);
  find_pairs(scene, settings, both);
  EXPECT_GT(backend.uploaded_bytes(), 0u);
  EXPECT_LE(backend.uploaded_bytes(), std::size_t{128} << 10);
  expect_same(both);
}

TEST(GlPairs, GiveTheSameFromRunToRun) {
  const Scene scene = with_self(make_builtin_scene("random-soup"));
  const auto first = find_pairs(scene, {.blocks = false}, shared()).candidates;
  for (int run = 0; run < 5; ++run)
    EXPECT_EQ(find_pairs(scene, {.blocks = false}, shared()).candidates, first);
}

TEST(GlPairs, FindNothingWhereNothingIs) {
  EXPECT_TRUE(find_pairs(scene_of({{}, {}}), {}, shared()).candidates.empty());
  EXPECT_TRUE(find_pairs(scene_of({{{Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(0, 1, 0)}}}), {}, shared())
                  .candidates.empty());
}

TEST(GlPairsProperty, EqualTheCpusOnExtremeFamilies) {
  Both both(shared());
  for (const lab::Family& family : lab::families()) {
    EXPECT_TRUE(rc::check(family.name, [&] {
      Scene scene = lab::scene_of(*lab::given(), family);
      const int kind = *rc::gen::inRange(0, 1000);
      if (kind % 2 == 0) scene = with_self(std::move(scene), 1 + kind % 3);
      PairSettings settings = settings_of(static_cast<std::uint64_t>(kind));
      settings.clearance = 0;
      const std::size_t before = both.wrong + both.wrong_counts;
      const PairResult result = find_pairs(scene, settings, both);
      RC_ASSERT(both.wrong + both.wrong_counts == before);
    }));
  }
  expect_same(both);
  EXPECT_GT(both.pairs, static_cast<std::size_t>(trials(1000)));
}

// Views that take too much work: most of the scene lies in one pixel. And a device that finds so
// itself, since the limit is just below what it does.
TEST(GlPairs, GiveUpAViewThatTakesTooMuchWork) {
  const auto gives_up = [](const PairResult& result) {
    return std::ranges::any_of(
        result.stages, [](const Stage& stage) { return stage.reason == Reason::join_many_tests; });
  };
  const Scene strays = lab::stray_scene(0, 8000, {.outliers = 3, .surface = true, .exponent = 6});
  const PairResult on_gl = find_pairs(strays, {.blocks = false}, shared());
  EXPECT_TRUE(gives_up(on_gl));
  EXPECT_EQ(on_gl.candidates,
            find_pairs(strays, {.blocks = false}, *cpu_pair_backend(2)).candidates);

  const Scene needles = make_builtin_scene("needles");
  PairPlan plan = plan_pairs(needles, {.blocks = false});
  PairWorkspace workspace;
  plan.most_tests = UINT64_MAX;
  const std::uint64_t tests =
      find_pairs(needles, plan, shared(), workspace).views.at(0).counts.tests;
  int by_device = 0;
  for (const std::uint64_t most : {tests / 4, tests / 2, tests - 1}) {
    plan.most_tests = most;
    const PairResult result = find_pairs(needles, plan, shared(), workspace);
    EXPECT_TRUE(gives_up(result)) << most << " of " << tests;
    by_device += result.views.at(0).counts.dispatches > 0;
    EXPECT_EQ(lab::missed(lab::truth_of(needles), result.candidates), 0u);
  }
  EXPECT_GT(by_device, 0);
}

}  // namespace
}  // namespace farcull
