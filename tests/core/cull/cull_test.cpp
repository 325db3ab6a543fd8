// Culling on a canvas without errors, judged by the independent accounting: whatever was culled
// must be harmless.
#include "core/cull/cull.h"

#include "core/boxes/join.h"
#include "experiments/record/stage_words.h"
#include "offsets/offsets.h"
#include "tests/lab/canvas.h"
#include "tests/lab/rational.h"
#include "tests/lab/reference.h"
#include "tests/lab/test.h"
#include "verify/accounting.h"

namespace farcull {
namespace {

using rational::Random;
using reference::Triangle;
using Objects = std::vector<std::vector<Triangle>>;
using Indices = std::vector<std::uint32_t>;

CullSettings settings_for(const std::string& views, int resolution, bool economy = true) {
  CullSettings settings;
  settings.views = parse_views(views);
  settings.resolution = resolution;
  settings.fattener = obb_fattener();
  settings.quick = economy;
  return settings;
}

CullResult cull_ideally(const Scene& scene, const CullSettings& settings,
                        CanvasFault fault = CanvasFault::none) {
  IdealCanvas canvas(settings.fattener.solid, fault);
  return cull(scene, find_regions(scene), settings, canvas);
}

Accounting accounting_of(const Scene& scene, const Indices& live) {
  return account(scene, box_join(triangle_boxes(scene), owners(scene), live));
}

std::uint64_t missed(const Scene& scene, const CullSettings& settings,
                     CanvasFault fault = CanvasFault::none) {
  return accounting_of(scene, cull_ideally(scene, settings, fault).live).false_negatives;
}

/// Objects of small triangles that touch, cross, pass closely, or do not meet.
Objects random_objects(Random& random) {
  Objects objects(2 + random.below(4));
  const bool grid = random.coin();
  const double spread = random.uniform(0.3, 3);
  for (auto& triangles : objects) {
    triangles.resize(random.below(12));
    const Vec3 at = random.cube(spread);
    for (Triangle& t : triangles) {
      const Vec3 base = at + random.cube(1);
      const double size = std::exp2(random.uniform(-6, 1));
      for (Vec3& p : t) {
        p = base + random.cube(size);
        if (grid) p = (p * 4).array().round() / 4;  // shared corners, coplanar overlaps
      }
      if (random.below(8) == 0) t[2] = t[1];
      if (random.below(16) == 0) t[0] = t[1] = t[2];
      if (random.below(12) == 0) t[0] += random.cube(20);  // needle
    }
  }
  // Contacts that hold exactly: a corner of one on a corner of another, which is then half a pixel
  // or less away at every resolution.
  for (std::size_t o = 1; o < objects.size(); ++o)
    if (!objects[o].empty() && !objects[o - 1].empty() && random.coin())
      objects[o][0][random.below(3)] = objects[o - 1].back()[random.below(3)];
  return objects;
}

constexpr const char* kViews[] = {"z", "x", "-y", "x,y,z", "z,-z", "1:1:1", "1:-2:0.5,y", "3:4:0"};

TEST(Cull, NothingThatCollidesIsCulled) {
  Random random(601);
  std::uint64_t colliding = 0, culled = 0;
  for (int n = 0; n < 1500; ++n) {
    const Objects objects = random_objects(random);
    const Scene scene = reference::scene_of(objects);
    const std::string views = kViews[random.below(8)];
    const int resolution = random.below(3) == 0 ? 1 + random.below(4) : 1 + random.below(64);
    const CullSettings settings = settings_for(views, resolution, random.coin());
    const CullResult result = cull_ideally(scene, settings);
    const Accounting accounting = accounting_of(scene, result.live);
    ASSERT_TRUE(accounting.adds_up());
    ASSERT_EQ(accounting.false_negatives, 0u)
        << "scene " << n << ", views " << views << " at " << resolution;
    ASSERT_TRUE(std::ranges::is_sorted(result.live));
    colliding += accounting_of(scene, {}).false_negatives;
    culled += scene.triangles.size() - result.live.size();
  }
  EXPECT_GT(colliding, 2000u);
  EXPECT_GT(culled, 5000u);
  std::cout << colliding << " colliding pairs kept, " << culled << " triangles culled\n";
}

TEST(Cull, NothingIsMissedWhateverTheOrderOfObjects) {
  Random random(602);
  for (int n = 0; n < 60; ++n) {
    Objects objects = random_objects(random);
    const int resolution = 1 + random.below(64);
    for (int k = 0; k < 6; ++k) {
      std::rotate(objects.begin(), objects.begin() + random.below(int(objects.size())),
                  objects.end());
      if (random.coin()) std::ranges::reverse(objects);
      ASSERT_EQ(missed(reference::scene_of(objects), settings_for("x,y,z", resolution)), 0u) << n;
    }
  }
}

// Bits only grow, and more bits store less: the fixed point is one, whatever order leads to it.
TEST(Cull, ReachesTheFixedPointWhateverTheOrderOfViews) {
  Random random(604);
  for (int n = 0; n < 250; ++n) {
    const Scene scene = reference::scene_of(random_objects(random));
    const int resolution = 1 + random.below(48);
    const bool economy = random.coin();
    CullSettings settings = settings_for("x,y,z,1:2:3", resolution, economy);
    const Indices live = cull_ideally(scene, settings).live;
    for (int k = 0; k < 3; ++k) {
      std::swap(settings.views[random.below(4)], settings.views[random.below(4)]);
      ASSERT_EQ(cull_ideally(scene, settings).live, live) << n;
    }
    settings.views.insert(settings.views.end(), settings.views.begin(), settings.views.end());
    ASSERT_EQ(cull_ideally(scene, settings).live, live) << n << ", every view twice";
    // From the fixed point, with all bits forgotten but those of the dead, nothing more is cleared.
    Regions again = find_regions(scene);
    again.triangles = live;
    IdealCanvas canvas(settings.fattener.solid);
    ASSERT_EQ(cull(scene, again, settings, canvas).live, live) << n << ", again";
  }
}

// In every second call it sees all that it is asked, as if samples depended on the call.
class FickleCanvas : public IdealCanvas {
 public:
  using IdealCanvas::IdealCanvas;
  std::vector<std::uint8_t> run(const Pass& pass) override {
    std::vector<std::uint8_t> seen = IdealCanvas::run(pass);
    if (++calls_ % 2 == 0) std::ranges::fill(seen, std::uint8_t{1});
    return seen;
  }

 private:
  int calls_ = 0;
};

// The twin of the fixed point: such a canvas loses no pair, but where a run ends depends on the
// order of its views.
TEST(Cull, EndsElsewhereWhereSamplesDependOnTheCall) {
  Random random(604);
  int elsewhere = 0;
  for (int n = 0; n < 30; ++n) {
    const Scene scene = reference::scene_of(random_objects(random));
    CullSettings settings = settings_for("x,y,z,1:2:3", 1 + random.below(48));
    const auto live = [&] {
      FickleCanvas canvas(settings.fattener.solid);
      return cull(scene, find_regions(scene), settings, canvas).live;
    };
    const Indices first = live();
    EXPECT_EQ(accounting_of(scene, first).false_negatives, 0u);
    std::ranges::reverse(settings.views);
    elsewhere += live() != first;
  }
  EXPECT_GT(elsewhere, 0);
}

// Layers that do not meet, the earlier in front, between two objects that meet beside them. Where
// every live item is stored, a pass frees only the layer that has become the foremost: it must be
// run again because of what it killed itself.
TEST(Cull, PlainStoringPeelsLayersOneByOne) {
  const std::vector<Triangle> beside = {{Vec3(1.1, 0, 0), Vec3(1.2, 0, 1), Vec3(1.1, 1, 1)}};
  for (std::uint32_t layers = 2; layers <= 4; ++layers) {
    Objects objects{beside};
    for (std::uint32_t i = 0; i < layers; ++i) {
      const double z = 0.3 * i;  // inside the box of the first one
      objects.push_back({{Vec3(0, 0, z), Vec3(1, 0, z + 1), Vec3(0, 1, z + 1)}});
    }
    objects.push_back(beside);
    for (int order = 0; order < 2; ++order) {
      const Scene scene = reference::scene_of(objects);
      ASSERT_EQ(find_regions(scene).triangles.size(), scene.triangles.size());
      for (const bool economy : {true, false}) {
        EXPECT_EQ(cull_ideally(scene, settings_for("z", 128, economy)).live,
                  (Indices{0, layers + 1}))
            << layers << ", economy " << economy;
      }
      std::ranges::reverse(objects);
    }
  }
}

// More views never cull less, and a single view of two bits is not enough for what two views clear.
TEST(Cull, ViewsClearTheTwoSidesTogether) {
  Random random(605);
  bool together = false;
  for (int n = 0; n < 300; ++n) {
    const Scene scene = reference::scene_of(random_objects(random));
    Indices alone;
    std::iota(alone.begin(), alone.end(), 0u);
    const Indices both = cull_ideally(scene, settings_for("x,y", 32)).live;
    const Indices x = cull_ideally(scene, settings_for("x", 32)).live;
    const Indices y = cull_ideally(scene, settings_for("y", 32)).live;
    std::set_intersection(x.begin(), x.end(), y.begin(), y.end(), std::back_inserter(alone));
    ASSERT_TRUE(std::includes(alone.begin(), alone.end(), both.begin(), both.end())) << n;
    together |= both.size() < alone.size();
  }
  EXPECT_TRUE(together);
}

// ---- items beyond the budget ----

/// A triangle 1e20 times the region through the origin, and small ones: one through it, one apart.
Objects with_undrawable() {
  const Triangle huge = {Vec3(-1e20, -1e20, 0), Vec3(1e20, -1e20, 0), Vec3(0, 1e20, 0)};
  const Triangle through = {Vec3(0, 0, -1), Vec3(1, 0, 1), Vec3(0, 1, 1)};
  return {{huge}, {through}};
}

TEST(Cull, AnUndrawableItemKeepsItsPartner) {
  for (const char* views : {"z", "-z", "x", "1:1:1", "x,y,z"}) {
    for (const bool economy : {true, false}) {
      for (const int resolution : {1, 8, 64}) {
        Objects objects = with_undrawable();
        for (int order = 0; order < 2; ++order) {
          const CullResult result =
              cull_ideally(reference::scene_of(objects), settings_for(views, resolution, economy));
          ASSERT_EQ(result.live, (Indices{0, 1})) << views << " at " << resolution;
          std::ranges::reverse(objects);
        }
      }
    }
  }
}

TEST(Cull, AnUndrawableItemAmongManyMissesNothing) {
  Random random(606);
  for (int n = 0; n < 300; ++n) {
    Objects objects = random_objects(random);
    objects.push_back(with_undrawable()[0]);
    auto& owner = objects[random.below(int(objects.size()) - 1)];
    if (random.coin()) owner.push_back(objects.back()[0]);
    if (random.coin()) std::ranges::reverse(objects);
    const Scene scene = reference::scene_of(objects);
    ASSERT_EQ(missed(scene, settings_for(kViews[random.below(8)], 1 + random.below(32))), 0u) << n;
  }
}

// ---- twins that must fail: the oracle sees what each rule of the canvas is for ----

// In the middle of a region that is 2^26 px deep, the floats of the depth map are 8 px apart: two
// triangles in one plane are then seen by "at or behind" only. The points span the region.
Scene deep_scene(double z) {
  const auto flat = [z](double x) {
    return Triangle{Vec3(x, 0.4, z), Vec3(x + 0.1, 0.4, z), Vec3(x, 0.5, z)};
  };
  const auto point = [](const Vec3& p) { return Triangle{p, p, p}; };
  constexpr double kFar = 0x1p19;
  return reference::scene_of({{flat(0.4), point({0, 0, -kFar}), point({1, 1, kFar})},
                              {flat(0.42), point({0, 1, -kFar}), point({1, 0, kFar})}});
}

TEST(Cull, GreaterInsteadOfGreaterOrEqualMisses) {
  std::uint64_t lost = 0;
  for (int n = 0; n < 64; ++n) {
    const Scene scene = deep_scene(0.01 * n);
    EXPECT_EQ(missed(scene, settings_for("z", 64)), 0u);
    lost += missed(scene, settings_for("z", 64), CanvasFault::greater);
  }
  EXPECT_GT(lost, 0u);
}

TEST(Cull, ALostStoreMisses) {
  const Scene scene = reference::scene_of({{{Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(0, 1, 0)}},
                                           {{Vec3(0, 0, 0), Vec3(1, 0, 1), Vec3(0, 1, 1)}}});
  EXPECT_EQ(missed(scene, settings_for("z", 16)), 0u);
  EXPECT_EQ(missed(scene, settings_for("z", 16), CanvasFault::drops_first_store), 1u);
}

TEST(Cull, ForgettingUndrawableItemsMisses) {
  Objects objects = with_undrawable();
  for (int order = 0; order < 2; ++order) {
    const Scene scene = reference::scene_of(objects);
    EXPECT_EQ(missed(scene, settings_for("z", 16)), 0u);
    EXPECT_EQ(missed(scene, settings_for("z", 16), CanvasFault::nothing_everywhere), 1u);
    std::ranges::reverse(objects);
  }
}

// Without fattening, contacts between pixel centres are lost: the oracle sees that, too.
TEST(Cull, ATenthOfTheRadiusMisses) {
  Random random(607);
  std::uint64_t lost = 0;
  for (int n = 0; n < 300; ++n) {
    const Scene scene = reference::scene_of(random_objects(random));
    CullSettings settings = settings_for("z", 12);
    EXPECT_EQ(missed(scene, settings), 0u);
    settings.radius.factor = 0.1;
    lost += missed(scene, settings);
  }
  EXPECT_GT(lost, 10u);
}

// ---- the passes themselves ----

/// Knows the owner of every element, by its solid, and checks each pass against the rules.
class CheckingCanvas : public IdealCanvas {
 public:
  CheckingCanvas(const Scene& scene, const SolidProgram& solid)
      : IdealCanvas(solid), scene_(scene), owner_of_triangle_(owners(scene)) {}

  void begin(const Window& window, const Drawables& drawables) override {
    const double radius =
        budget_for(limits(), viewport_side(std::max(window.width, window.height))).radius();
    std::map<Solid, std::uint32_t> owner_of_solid;
    for (std::uint32_t t = 0; t < scene_.triangles.size(); ++t) {
      FattenCounts counts;
      const Indices one{t};
      const Drawables alone = fatten(scene_, one, window, obb_fattener(), radius, counts);
      for (const Proxy& proxy : alone.proxies) {
        const auto [known, is_new] = owner_of_solid.emplace(proxy.solid, owner_of_triangle_[t]);
        if (!is_new && known->second != owner_of_triangle_[t]) known->second = kAnyOwner;
      }
    }
    owner_.clear();
    for (const Proxy& proxy : drawables.proxies) owner_.push_back(owner_of_solid.at(proxy.solid));
    IdealCanvas::begin(window, drawables);
  }

  std::vector<std::uint8_t> run(const Pass& pass) override {
    ++passes;
    EXPECT_FALSE(pass.steps.empty());
    EXPECT_EQ(pass.steps.back().verb, Verb::ask) << "stored, and nobody is asked";
    EXPECT_EQ(pass.steps.front().verb, Verb::store) << "asked against nothing";
    std::uint32_t next = 0, slots = 0;
    std::set<std::uint32_t> stored;
    std::vector<std::uint32_t> order;
    for (const Step& step : pass.steps) {
      EXPECT_EQ(step.first, next);
      EXPECT_GT(step.count, 0u);
      next += step.count;
      std::optional<std::uint32_t> owner;
      for (std::uint32_t d = step.first; d < next; ++d) {
        const Draw& draw = pass.draws.at(d);
        if (step.verb == Verb::ask) {  // one slot after the other, none in two steps
          EXPECT_TRUE(draw.slot == slots || (d > step.first && draw.slot + 1 == slots));
          slots = draw.slot + 1;
        }
        const bool everywhere = draw.element == kEverywhere;
        EXPECT_FALSE(everywhere && step.verb == Verb::ask);
        const std::uint32_t of = everywhere ? kAnyOwner : owner_.at(draw.element);
        if (of == kAnyOwner) continue;
        if (!owner) order.push_back(*(owner = of));
        EXPECT_EQ(of, *owner) << "two objects in one step";
        if (step.verb == Verb::store) {
          stored.insert(of);
        } else {
          EXPECT_EQ(stored.count(of), 0u) << "asked against its own object";
          ++asked;
        }
      }
    }
    EXPECT_EQ(next, pass.draws.size());
    EXPECT_EQ(slots, pass.slots);
    EXPECT_TRUE(std::ranges::is_sorted(order) || std::is_sorted(order.rbegin(), order.rend()));
    return IdealCanvas::run(pass);
  }

  long passes = 0, asked = 0;

 private:
  // Equal triangles of different objects, and undrawable items, are of any owner.
  static constexpr std::uint32_t kAnyOwner = 0xffffffff;

  const Scene& scene_;
  Indices owner_of_triangle_;
  Indices owner_;  // per element
};

TEST(Cull, PassesAskNobodyAgainstItselfAndEndWithAnAsk) {
  Random random(608);
  long passes = 0, asked = 0;
  for (int n = 0; n < 200; ++n) {
    const Scene scene = reference::scene_of(random_objects(random));
    const CullSettings settings =
        settings_for(kViews[random.below(8)], 1 + random.below(24), random.coin());
    CheckingCanvas canvas(scene, settings.fattener.solid);
    cull(scene, find_regions(scene), settings, canvas);
    passes += canvas.passes;
    asked += canvas.asked;
    if (HasFailure()) FAIL() << n;
  }
  EXPECT_GT(passes, 500);
  EXPECT_GT(asked, 2000);
}

// ---- what is left out, and why ----

TEST(Cull, RefusesAResolutionBeyondTheDevice) {
  const Scene scene = reference::scene_of(with_undrawable());
  EXPECT_THROW(cull_ideally(scene, settings_for("z", 0)), Error);
  EXPECT_THROW(cull_ideally(scene, settings_for("z", -5)), Error);
  EXPECT_THROW(cull_ideally(scene, settings_for("z", 4097)), Error);
}

TEST(Cull, BoxesApartNeedNoCanvas) {
  const Triangle t = {Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(0, 1, 0)};
  const Triangle apart = {Vec3(5, 0, 0), Vec3(6, 0, 0), Vec3(5, 1, 0)};
  for (const Objects& objects :
       {Objects{}, Objects{{}, {}}, Objects{{t, t}}, Objects{{t}, {apart}}}) {
    const CullResult result = cull_ideally(reference::scene_of(objects), settings_for("x,z", 8));
    EXPECT_TRUE(result.live.empty());
    ASSERT_EQ(result.views.size(), 2u);
    ASSERT_EQ(result.stages.size(), 2u);
    for (int v = 0; v < 2; ++v) {
      EXPECT_FALSE(result.views[v].drawn);
      EXPECT_FALSE(result.stages[v].ran);
      EXPECT_TRUE(has_text(reason_of(result.stages[v]), "no two objects"));
    }
  }
}

TEST(Cull, AViewThatDoublesCannotResolveCullsNothing) {
  const double far = DBL_MAX;
  const Triangle a = {Vec3(-far, -far, -far), Vec3(far, far, far), Vec3(far, -far, 0)};
  const Scene scene = reference::scene_of({{a}, {a}});
  const CullResult result = cull_ideally(scene, settings_for("z,1:1:1", 8));
  EXPECT_EQ(result.live, (Indices{0, 1}));
  for (const ViewReport& view : result.views) EXPECT_FALSE(view.drawn);
  ASSERT_EQ(result.stages.size(), 2u);
  EXPECT_TRUE(has_text(reason_of(result.stages[0]), "nothing is culled"));
}

TEST(Cull, ReportsWhatItDrew) {
  const Triangle t = {Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(0, 1, 0.5)};
  const Triangle high = {Vec3(0, 0, 0.5), Vec3(1, 0, 9), Vec3(0, 1, 9)};
  CullSettings settings = settings_for("z", 32);
  const Scene scene = reference::scene_of({{t}, {high}});
  const CullResult result = cull_ideally(scene, settings);
  ASSERT_EQ(result.views.size(), 1u);
  const ViewReport& view = result.views[0];
  EXPECT_TRUE(view.drawn);
  EXPECT_GT(view.width, 32);
  EXPECT_EQ(view.radius_px, view.budget.radius());
  EXPECT_GT(view.depth_step_px, 0);
  ASSERT_GE(result.stages.size(), 3u);
  EXPECT_EQ(name_of(result.stages[0]), "fatten z, round 1");
  EXPECT_EQ(name_of(result.stages[1]), "cull objects z, round 1");
  EXPECT_EQ(name_of(result.stages[2]), "cull triangles z, round 1");
  EXPECT_GT(result.stages[1].queries, 0u);
  settings.radius = {.published = true, .factor = 1};
  EXPECT_EQ(cull_ideally(scene, settings).views[0].radius_px, published_radius(view.depth_step_px));
}

}  // namespace
}  // namespace farcull
