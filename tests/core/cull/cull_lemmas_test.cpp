// The two lemmas of CULLIDE and the five of Quick-CULLIDE (docs/reliability.md, "CULLIDE" and
// "Quick-CULLIDE": lemmas 6 to 10; the names of tests have the numbers of the two papers), each as
// a property: on raw triangles in the pixel-exact sense, on fattened ones against exact collisions.
// Each has a twin that breaks its rule and is caught.
#include "tests/lab/cull.h"

namespace farcull {
namespace {

using lab::Drawing;
using lab::Pairs;
using lab::Trace;

struct Question {
  const char* name;
  Drawing drawing;
  bool exact;  // against exact collisions; otherwise pixel-exact conflicts
};

std::vector<Question> questions() {
  return {{"raw", lab::raw_on_ideal(), false},
          {"boxes", lab::on_worst(obb_fattener()), true},
          {"exact offsets", lab::on_worst(minkowski_fattener()), true}};
}

// All passes run, whatever a rule makes due.
CullSettings settings_for(const Drawing& drawing, const std::string& views) {
  CullSettings settings =
      lab::cull_settings(drawing, views, drawing.fattener.name == "raw" ? 24 : 12);
  settings.full = true;
  return settings;
}

Pairs oracle(const Question& q, const Scene& scene, const CullSettings& settings) {
  return q.exact ? lab::collisions(scene) : lab::conflicts(scene, q.drawing, settings);
}

// How many of `pairs` are both in the set of `bit` (with BFV) at some step.
int both_in_set(const Trace& run, const Pairs& pairs, Bit bit) {
  int found = 0;
  for (const auto& [u, t] : pairs) {
    for (const lab::StepRecord& s : run.steps) {
      if ((s.bits[u] & bit) && (s.bits[t] & bit)) {
        ++found;
        break;
      }
    }
  }
  return found;
}

// A property over scenes and views, for each kind of primitive, until it has seen some pairs.
template <class Property>
void for_all(std::uint64_t seed, const Property& property) {
  for (const Question& q : questions()) {
    SCOPED_TRACE(q.name);
    std::size_t pairs = 0;
    const auto check = [&] {
      const Scene scene = lab::scene_of(*lab::small_triangles());
      const auto views = *rc::gen::elementOf(std::vector<std::string>{"z", "x,y,z", "1:2:3,-x"});
      const CullSettings settings = settings_for(q.drawing, views);
      const Pairs wanted = oracle(q, scene, settings);
      pairs += wanted.size();
      property(q, scene, settings, wanted);
    };
    lab::expect_property(seed, q.exact ? 20 : 60, check, [&] { return pairs > 20; });
  }
}

// A broken rule loses pairs.
void expect_loses(const PassRule& rule) {
  for (const Question& q : questions()) {
    SCOPED_TRACE(q.name);
    int lost = 0;
    for (int n = 0; more_cases(n, 0, lost > 0, 100); ++n) {
      const Scene scene = lab::scene_of(lab::random_small(2000 + n, 50));
      const CullSettings settings = settings_for(q.drawing, "x,y,z");
      lost += lab::wrongly_cleared(lab::run_by(rule, scene, q.drawing, settings),
                                   oracle(q, scene, settings));
    }
  }
}

TEST(CullLemma, L1FfvAndSfvAreCollisionFree) {
  for_all(811, [](const Question& q, const Scene& scene, const CullSettings& settings,
                  const Pairs& pairs) {
    const Trace run = lab::run_by(kQuickRule, scene, q.drawing, settings);
    RC_ASSERT(both_in_set(run, pairs, kF) == 0);
    RC_ASSERT(both_in_set(run, pairs, kL) == 0);
  });
}

TEST(CullLemma, L1FailsWithASwappedDepthTest) {
  for (const Fattener& fattener : {raw_triangles(), obb_fattener()}) {
    SCOPED_TRACE(fattener.name);
    const Drawing swapped = {fattener,
                             std::make_shared<IdealCanvas>(fattener.solid, CanvasFault::swapped)};
    const Drawing sound = {fattener, std::make_shared<IdealCanvas>(fattener.solid)};
    const Question q = {"", sound, fattener.name != "raw"};
    int found = 0;
    for (int n = 0; more_cases(n, 5, found > 0, 100); ++n) {
      const Scene scene = lab::scene_of(lab::random_small(2000 + n, 50));
      const CullSettings settings = settings_for(swapped, "x,y,z");
      const Pairs pairs = oracle(q, scene, settings);
      const Trace run = lab::run_by(kQuickRule, scene, swapped, settings);
      found += both_in_set(run, pairs, kF) + both_in_set(run, pairs, kL);
      ASSERT_EQ(both_in_set(lab::run_by(kQuickRule, scene, sound, settings), pairs, kF), 0);
    }
  }
}

// L2 and L4: the question that is left out would clear nothing more. (At object level it clears
// less for a while: a triangle that has the bit may speak for its whole group.)
TEST(CullLemma, L2AndL4QuestionsLeftOutWouldClearNothing) {
  PassRule asks_ffv_twice = kQuickRule, asks_sfv_twice = kQuickRule;
  asks_ffv_twice.asks[0][kF] = true;
  asks_sfv_twice.asks[1][kL] = true;
  for_all(812,
          [&](const Question& q, const Scene& scene, const CullSettings& settings, const Pairs&) {
            const Trace quick = lab::run_by(kQuickRule, scene, q.drawing, settings);
            for (const PassRule& rule : {asks_ffv_twice, asks_sfv_twice}) {
              const Trace more = lab::run_by(rule, scene, q.drawing, settings);
              RC_ASSERT(more.result.bits == quick.result.bits);
              for (std::size_t i = 0; i < std::min(more.steps.size(), quick.steps.size()); ++i)
                for (std::size_t t = 0; t < scene.triangles.size(); ++t)
                  RC_ASSERT((more.steps[i].bits[t] & ~quick.steps[i].bits[t]) == 0);
            }
          });
}

TEST(CullLemma, L2AndL4TheOtherQuestionIsNeeded) {
  PassRule ffv = kQuickRule, sfv = kQuickRule;  // asked only in the pass that it has passed
  ffv.asks[1][kF] = false;
  ffv.asks[0][kF] = true;
  sfv.asks[0][kL] = false;
  sfv.asks[1][kL] = true;
  for (const Question& q : questions()) {
    SCOPED_TRACE(q.name);
    for (const PassRule& rule : {ffv, sfv}) {
      std::size_t more = 0;
      for (int n = 0; more_cases(n, 0, more > 0, 100); ++n) {
        const Scene scene = lab::scene_of(lab::random_small(2100 + n, 30));
        const CullSettings settings = settings_for(q.drawing, "x,y,z");
        more += lab::run_by(rule, scene, q.drawing, settings).result.live.size() -
                lab::run_by(kQuickRule, scene, q.drawing, settings).result.live.size();
      }
    }
  }
}

// The published statement: storing is needed for one side only. `first` and `second` say in which
// passes a set is stored; everything else is stored in both.
PassRule storing(Bit set, bool first, bool second) {
  PassRule rule = kQuickRule;
  for (int pass = 0; pass < 2; ++pass)
    for (int bits = 0; bits < kCulled; ++bits) rule.stores[pass][bits] = true;
  rule.stores[0][set] = first;
  rule.stores[1][set] = second;
  return rule;
}

TEST(CullLemma, L3AndL5SetsStoredInOnePassLoseNoPair) {
  for_all(813, [](const Question& q, const Scene& scene, const CullSettings& settings,
                  const Pairs& pairs) {
    for (const PassRule& rule : {storing(kF, true, false), storing(kL, false, true), kQuickRule})
      RC_ASSERT(lab::wrongly_cleared(lab::run_by(rule, scene, q.drawing, settings), pairs) == 0);
  });
}

TEST(CullLemma, L3FfvStoredOnlyInTheSecondPassLosesPairs) {
  expect_loses(storing(kF, false, true));
}

TEST(CullLemma, L5SfvStoredOnlyInTheFirstPassLosesPairs) { expect_loses(storing(kL, true, false)); }

// ---- CULLIDE ----

/// The objects of a scene, drawn in the first view of the settings.
class OneView {
 public:
  OneView(const Scene& scene, const Drawing& drawing, const CullSettings& settings)
      : plan_(find_regions(scene)), object_(owners(scene)), canvas_(*drawing.canvas) {
    if (plan_.places.empty()) return;
    const auto window = fit_window(settings.views[0], plan_.places, settings.resolution);
    if (!window) return;
    const Budget budget =
        budget_for(canvas_.limits(), viewport_side(std::max(window->width, window->height)));
    FattenCounts counts;
    drawables_ = fatten(scene, plan_.triangles, *window, drawing.fattener,
                        drawing.fattener.name == "raw" ? 0 : budget.radius(), counts);
    canvas_.begin(*window, drawables_);
    drawn_ = true;
  }

  /// Whether the asked object is fully visible with respect to the objects that `stored` names.
  template <class Stored>
  bool fully_visible(std::uint32_t asked, const Stored& stored) const {
    if (!drawn_) return false;
    Pass pass;
    pass.slots = 1;
    const auto step = [&](Verb verb, const auto& wanted) {
      const auto first = static_cast<std::uint32_t>(pass.draws.size());
      for (std::uint32_t i = 0; i < plan_.triangles.size(); ++i)
        if (wanted(object_[plan_.triangles[i]])) lab::add(pass.draws, drawables_, i, 0);
      pass.steps.push_back({verb, first, static_cast<std::uint32_t>(pass.draws.size()) - first});
    };
    step(Verb::store, stored);
    step(Verb::ask, [asked](std::uint32_t o) { return o == asked; });
    return canvas_.run(pass)[0] == 0;
  }

  const std::vector<std::uint32_t>& objects() const { return object_; }

 private:
  Regions plan_;
  std::vector<std::uint32_t> object_;
  Canvas& canvas_;
  Drawables drawables_;
  bool drawn_ = false;
};

/// How often an object is fully visible with respect to the earlier, the later or all other objects
/// and is in one of `pairs` with one of them.
int visible_and_colliding(const Scene& scene, const Drawing& drawing, const CullSettings& settings,
                          const Pairs& pairs) {
  const OneView view(scene, drawing, settings);
  int found = 0;
  for (std::uint32_t o = 0; o < scene.objects.size(); ++o) {
    const auto earlier = [o](std::uint32_t s) { return s < o; };
    const auto later = [o](std::uint32_t s) { return s > o; };
    const auto others = [o](std::uint32_t s) { return s != o; };
    const auto count = [&](const auto& stored) {
      if (!view.fully_visible(o, stored)) return;
      found += std::ranges::any_of(pairs, [&](const auto& pair) {
        const std::uint32_t a = view.objects()[pair.first], b = view.objects()[pair.second];
        return (a == o && stored(b)) || (b == o && stored(a));
      });
    };
    count(earlier);
    count(later);
    count(others);
  }
  return found;
}

TEST(CullideLemma, L1AFullyVisibleObjectDoesNotCollide) {
  for (const Question& q : questions()) {
    SCOPED_TRACE(q.name);
    std::size_t pairs = 0;
    const auto check = [&] {
      const Scene scene = lab::scene_of(*lab::small_triangles());
      const auto name = *rc::gen::elementOf(std::vector<const char*>{"z", "-x", "1:2:3"});
      const CullSettings settings = settings_for(q.drawing, name);
      const Pairs wanted = oracle(q, scene, settings);
      pairs += wanted.size();
      RC_ASSERT(visible_and_colliding(scene, q.drawing, settings, wanted) == 0);
    };
    lab::expect_property(821, q.exact ? 20 : 40, check, [&] { return pairs > 20; });
  }
}

// Raw triangles on a coarse grid: objects that no sample sees collide, so the lemma is false of
// space.
TEST(CullideLemma, L1IsFalseOfRawTrianglesOnACoarseGrid) {
  const Question raw = {"raw", lab::raw_on_ideal(), true};
  int found = 0;
  for (int n = 0; more_cases(n, 0, found > 0, 100); ++n) {
    const Scene scene = lab::scene_of(lab::random_small(2200 + n, 50));
    CullSettings settings = settings_for(raw.drawing, "z");
    settings.resolution = 4;
    found += visible_and_colliding(scene, raw.drawing, settings, oracle(raw, scene, settings));
  }
}

TEST(CullideLemma, L1FailsWithASwappedDepthTest) {
  for (const Fattener& fattener : {obb_fattener(), minkowski_fattener()}) {
    const Question q = {
        "", {fattener, std::make_shared<IdealCanvas>(fattener.solid, CanvasFault::swapped)}, true};
    SCOPED_TRACE(fattener.name);
    int found = 0;
    for (int n = 0; more_cases(n, 0, found > 0, 100); ++n) {
      const Scene scene = lab::scene_of(lab::random_small(2200 + n, 50));
      const CullSettings settings = settings_for(q.drawing, "z");
      found += visible_and_colliding(scene, q.drawing, settings, oracle(q, scene, settings));
    }
  }
}

/// Per object: whether a triangle of it is in the potentially colliding set.
std::vector<bool> in_pcs(const PassRule& rule, const Scene& scene, const Drawing& drawing,
                         const CullSettings& settings) {
  std::vector<bool> out(scene.objects.size());
  const std::vector<std::uint32_t> object = owners(scene);
  for (const std::uint32_t t : lab::run_by(rule, scene, drawing, settings).result.live)
    out[object[t]] = true;
  return out;
}

// Lemma 7 (a), the half that reliability is: what collides is in the set.
TEST(CullideLemma, L2ObjectsThatCollideStayInThePcs) {
  for_all(822, [](const Question& q, const Scene& scene, const CullSettings& settings,
                  const Pairs& pairs) {
    const std::vector<std::uint32_t> object = owners(scene);
    for (const PassRule& rule : {kPlainRule, kQuickRule}) {
      const std::vector<bool> pcs = in_pcs(rule, scene, q.drawing, settings);
      for (const auto& [u, t] : pairs) RC_ASSERT(pcs[object[u]] && pcs[object[t]]);
    }
  });
}

TEST(CullideLemma, L2RawTrianglesOnACoarseGridLoseObjectsThatCollide) {
  const Question raw = {"raw", lab::raw_on_ideal(), true};
  int lost = 0;
  for (int n = 0; more_cases(n, 0, lost > 0, 100); ++n) {
    const Scene scene = lab::scene_of(lab::random_small(2200 + n, 50));
    CullSettings settings = settings_for(raw.drawing, "z");
    settings.resolution = 4;
    const std::vector<bool> pcs = in_pcs(kPlainRule, scene, raw.drawing, settings);
    const std::vector<std::uint32_t> object = owners(scene);
    for (const auto& [u, t] : oracle(raw, scene, settings))
      lost += !pcs[object[u]] || !pcs[object[t]];
  }
}

// Lemma 7 (b), the half that culls: how many objects stay although a view shows them fully visible
// with respect to all earlier and to all later ones; and how many it shows so.
struct Leavers {
  int stayed = 0, shown = 0;
};
void count_leavers(const PassRule& rule, const Question& q, const Scene& scene,
                   const CullSettings& settings, Leavers& out) {
  std::vector<bool> shown(scene.objects.size());
  {
    const OneView view(scene, q.drawing, settings);
    for (std::uint32_t o = 0; o < shown.size(); ++o) {
      shown[o] = view.fully_visible(o, [o](std::uint32_t s) { return s < o; }) &&
                 view.fully_visible(o, [o](std::uint32_t s) { return s > o; });
    }
  }
  const std::vector<bool> pcs = in_pcs(rule, scene, q.drawing, settings);
  for (std::size_t o = 0; o < shown.size(); ++o) {
    out.shown += shown[o] && scene.objects[o].triangle_count > 0;
    out.stayed += shown[o] && pcs[o];
  }
}

TEST(CullideLemma, L2AnObjectFullyVisibleToBothSidesLeavesThePcs) {
  for (const Question& q : questions()) {
    SCOPED_TRACE(q.name);
    Leavers found;
    const auto check = [&] {
      const Scene scene = lab::scene_of(*lab::small_triangles());
      const auto name = *rc::gen::elementOf(std::vector<const char*>{"z", "-x", "1:2:3"});
      for (const PassRule& rule : {kPlainRule, kQuickRule})
        count_leavers(rule, q, scene, settings_for(q.drawing, name), found);
      RC_ASSERT(found.stayed == 0);
    };
    lab::expect_property(823, 20, check, [&] { return found.shown > 20; });
  }
}

TEST(CullideLemma, L2WithoutTheSecondPassObjectsStay) {
  PassRule rule = kPlainRule;
  for (bool& asks : rule.asks[1]) asks = false;
  for (const Question& q : questions()) {
    SCOPED_TRACE(q.name);
    Leavers found;
    for (int n = 0; more_cases(n, 0, found.stayed > 0, 100); ++n) {
      const Scene scene = lab::scene_of(lab::random_small(2300 + n, 12));
      count_leavers(rule, q, scene, settings_for(q.drawing, "z"), found);
    }
  }
}

/// Two objects of points whose box is a cube that holds everything, so that all is in a region.
void add_cube(std::vector<std::vector<std::array<Vec3, 3>>>& objects) {
  for (const double x : {1.125, -1.125}) {
    const Vec3 p(x, -1.125, -1.125), q(-x, 1.125, 1.125);
    objects.push_back({{p, p, p}, {q, q, q}});
  }
}

/// Two square rings of half-width 0.3, each of four flat bars: one around the origin, the other
/// upright around (0.27, lift, 0); linked where lift is 0.
Scene rings(double lift) {
  std::vector<std::vector<std::array<Vec3, 3>>> objects(2);
  for (int ring = 0; ring < 2; ++ring) {
    const auto at = [&](double a, double b) {
      return ring == 0 ? Vec3(a, b, 0) : Vec3(0.27 + a, lift, b);
    };
    constexpr double kIn = 0.22, kOut = 0.3;
    const double corner[4][2] = {{1, 1}, {-1, 1}, {-1, -1}, {1, -1}};
    for (int k = 0; k < 4; ++k) {
      const double *p = corner[k], *q = corner[(k + 1) % 4];
      const Vec3 a = at(kIn * p[0], kIn * p[1]), b = at(kOut * p[0], kOut * p[1]),
                 c = at(kOut * q[0], kOut * q[1]), d = at(kIn * q[0], kIn * q[1]);
      objects[ring].push_back({a, b, c});
      objects[ring].push_back({a, c, d});
    }
  }
  add_cube(objects);
  return lab::scene_of(objects);
}

// Lemma 7 (c): "an object that collides with no other is not in the PCS" is false. Linked rings do
// not touch, and in no view is one of them in front of the other.
TEST(CullideLemma, L2LinkedRingsAreNeverFullyVisibleAlthoughTheyDoNotCollide) {
  const auto is = [](std::uint32_t o) { return [o](std::uint32_t s) { return s == o; }; };
  for (const Question& q : questions()) {
    for (const char* name : {"1:2:3", "-2:1:1", "1:1:-3"}) {
      CullSettings settings = settings_for(q.drawing, name);
      settings.resolution = 96;
      for (const double lift : {0.0, 0.8}) {
        const Scene scene = rings(lift);
        ASSERT_TRUE(lab::collisions(scene).empty());
        const OneView view(scene, q.drawing, settings);
        const bool apart = view.fully_visible(0, is(1)) || view.fully_visible(1, is(0));
        EXPECT_EQ(apart, lift > 0) << q.name << ", " << name << ", lifted by " << lift;
      }
    }
  }
}

// Nor is it true of triangles: those that are closer than the fattening can tell apart stay. Raw
// ones leave, and so do fattened ones with room between them.
TEST(CullideLemma, L2FattenedTrianglesCloserThanAPixelStayAlthoughTheyDoNotCollide) {
  for (const Question& q : questions()) {
    for (const double gap : {0.01, 0.8}) {
      std::vector<std::vector<std::array<Vec3, 3>>> objects;
      for (const double z : {0.0, gap})
        objects.push_back({{Vec3(-0.5, -0.5, z - 0.5), Vec3(0.5, -0.5, z), Vec3(0, 0.5, z)}});
      add_cube(objects);
      const Scene scene = lab::scene_of(objects);
      ASSERT_TRUE(lab::collisions(scene).empty());
      const CullSettings settings = settings_for(q.drawing, "x,y,z");
      for (const PassRule& rule : {kPlainRule, kQuickRule}) {
        const std::vector<bool> pcs = in_pcs(rule, scene, q.drawing, settings);
        const bool close = q.exact && gap < 0.1;
        EXPECT_EQ(pcs[0] && pcs[1], close) << q.name << ", " << gap;
        EXPECT_EQ(pcs[0] || pcs[1], close) << q.name << ", " << gap;
      }
    }
  }
}

}  // namespace
}  // namespace farcull
