// The model of the passes against core/cull, step by step, on random worlds and schedules
// (docs/model.md). FARCULL_MODEL_TRIALS=1000000 asks for more of them. FARCULL_MODEL_DUMP=FILE
// writes them for the model that Coq has proved things of, which tests/coq.sh runs.
#include "tests/core/cull/model_cases.h"

namespace farcull::model {
namespace {

// The sanitizers take several times as long.
#ifdef __SANITIZE_ADDRESS__
constexpr int kTrials = 5'000;
#else
constexpr int kTrials = 100'000;
#endif
constexpr int kMostTriangles = 12;

int trials() {
  const char* text = std::getenv("FARCULL_MODEL_TRIALS");
  return text ? std::stoi(text) : kTrials;
}

// The triangles that `t` may meet, itself left out: each sees the other in every view that shows
// both.
Set may_meet(const World& world, int t) {
  Set out = world.region & only(t) ? world.region & ~only(t) : 0;
  for (const View& view : world.views) {
    if (!view.drawn) continue;
    Set here = view.undrawable;
    for (Set rest = view.shown; rest != 0; rest &= rest - 1) {
      const int u = first_of(rest);
      if ((view.undrawable & only(t)) || ((view.behind[t] & only(u)) && (view.behind[u] & only(t))))
        here |= only(u);
    }
    out &= (view.shown | view.undrawable) & only(t) ? here : 0;
  }
  return out;
}

// The bits that theorem 2 forbids where all triangles meet that may: F of a triangle that meets one
// of an earlier owner, L of one that meets one of a later owner.
Bits forbidden(const World& world) {
  Bits out;
  Set before = 0, all = 0;
  for (const Set owner : world.owners) all |= owner;
  for (const Set owner : world.owners) {
    for (Set rest = owner; rest != 0; rest &= rest - 1) {
      const Set met = may_meet(world, first_of(rest));
      if (met & before) out.f |= rest & -rest;
      if (met & all & ~before & ~owner) out.l |= rest & -rest;
    }
    before |= owner;
  }
  return out;
}

Case nth_case(int n) { return random_case(static_cast<std::uint64_t>(n), kMostTriangles); }

// What the random cases contain, so that they cannot agree by being empty.
struct Contents {
  int steps = 0, left_out = 0, third_rounds = 0, plain = 0, agreements = 0, patches = 0, selves = 0;
  int undrawable = 0, undrawn = 0, culled = 0, must_stay = 0;

  void add(const Case& c, const Outcome& outcome, const Bits& no) {
    steps += static_cast<int>(outcome.steps.size());
    left_out += outcome.passes < outcome.steps.size();
    third_rounds +=
        !outcome.steps.empty() && outcome.steps.back().name.find("round 3") != std::string::npos;
    plain += !c.schedule.quick;
    agreements += c.schedule.all_views;
    patches += !c.patches.empty();
    selves += c.self;
    for (const View& view : c.world.views) {
      undrawable += view.drawn && view.undrawable != 0;
      undrawn += view.drawn && (c.world.region & ~view.undrawable & ~view.shown) != 0;
    }
    culled += std::ranges::count(outcome.bits, kCulled) > 0;
    must_stay += (no.f | no.l) != 0;
  }
  std::vector<int> all() const {
    return {left_out, third_rounds, plain,   agreements, patches,
            selves,   undrawable,   undrawn, culled,     must_stay};
  }
};

bool breaks(const Case& c, const Outcome& outcome, const Bits& no) {
  const std::vector<std::uint8_t> forbidden = bits_of(c, no);
  const auto wrong = [&](const std::vector<std::uint8_t>& bits) {
    for (std::size_t t = 0; t < bits.size(); ++t)
      if (bits[t] & forbidden[t]) return true;
    return false;
  };
  return wrong(outcome.bits) ||
         std::ranges::any_of(outcome.steps, [&](const Seen& step) { return wrong(step.bits); });
}

// The pairs that exact tests look at after culling by patches. All boxes overlap.
std::vector<TrianglePair> pairs_by_core(const Case& c, const Outcome& core) {
  std::vector<std::uint32_t> live;
  for (std::uint32_t t = 0; t < core.bits.size(); ++t)
    if (core.bits[t] != kCulled) live.push_back(t);
  const std::vector<Box> boxes(core.bits.size(), Box{Vec3::Zero(), Vec3::Ones()});
  return join_patches(c.scene, boxes, {.owner = c.patches}, live, core.bits);
}

// A run of core/cull for tests/proofs/coq/replay.ml, as numbers; a set is a mask of bits. Which
// passes there are is the model's word, and what they set is that of core/cull.
std::string dump(const Case& c, const Outcome& core) {
  std::ostringstream out;
  const std::size_t n = core.bits.size();
  out << "case " << n << ' ' << c.world.region << ' ' << c.world.owners.size();
  for (const Set owner : c.world.owners) out << ' ' << owner;
  out << ' ' << c.world.views.size();
  for (const View& view : c.world.views) {
    out << ' ' << view.undrawable << ' ' << view.shown;
    for (std::size_t t = 0; t < n; ++t) out << ' ' << view.behind[t];
  }
  std::vector<Step> steps;
  run(c.world, c.schedule, c.start, [&](const Step& step) { steps.push_back(step); });
  const auto add_bits = [&](const std::vector<std::uint8_t>& bits) {
    Bits sets;
    for (std::size_t t = 0; t < n; ++t) {
      sets.f |= Set{(bits[t] & kF) != 0} << t;
      sets.l |= Set{(bits[t] & kL) != 0} << t;
    }
    out << ' ' << sets.f << ' ' << sets.l;
  };
  out << ' ' << steps.size();
  for (std::size_t i = 0; i < steps.size(); ++i) {
    const Step& step = steps[i];
    const bool fine = step.level == static_cast<int>(c.schedule.coarse.size());
    out << ' ' << c.schedule.quick << ' ' << step.second << ' ' << step.view << ' ' << step.ran;
    const Level& level = fine ? c.schedule.triangles : c.schedule.coarse[step.level];
    out << ' ' << level.size();
    for (const std::vector<Set>& groups : level) {
      out << ' ' << groups.size();
      for (const Set group : groups) out << ' ' << group;
    }
    out << ' ' << step.before.f << ' ' << step.before.l;
    add_bits(core.steps[i].bits);
  }
  add_bits(core.bits);
  std::vector<std::array<std::uint32_t, 3>> pairs;
  if (!c.patches.empty()) {
    const std::vector<TrianglePair> kept = pairs_by_core(c, core);
    const std::vector<std::uint32_t> object = owners(c.scene);
    for (std::uint32_t a = 0; a < n; ++a) {
      for (std::uint32_t b = a + 1; b < n; ++b) {
        if (object[a] != object[b] || c.scene.objects[object[a]].self)
          pairs.push_back({a, b, std::ranges::find(kept, TrianglePair{a, b}) != kept.end()});
      }
    }
  }
  out << ' ' << pairs.size();
  for (const auto& [a, b, tested] : pairs) out << ' ' << a << ' ' << b << ' ' << tested;
  out << '\n';
  return out.str();
}

TEST(CullModel, AgreesWithCullStepByStep) {
  const int count = trials();
  Contents contents;
  std::ofstream dumped;
  if (const char* path = std::getenv("FARCULL_MODEL_DUMP")) dumped.open(path);
  for (int n = 0; n < count; ++n) {
    const Case c = nth_case(n);
    const Outcome core = by_core(c);
    ASSERT_EQ(difference(by_model(c), core), "") << "seed " << n;
    if (dumped.is_open()) dumped << dump(c, core);
    const Bits no = forbidden(c.world);
    contents.add(c, core, no);
    if (((c.start.f & no.f) | (c.start.l & no.l)) == 0) {
      ASSERT_FALSE(breaks(c, core, no)) << "theorem 2, seed " << n;
    }
  }
  if (dumped.is_open()) dumped << "end\n";
  std::printf("%d schedules, %d steps\n", count, contents.steps);
  for (const int some : contents.all()) EXPECT_GT(some, count / 100);
}

// The smallest world of this kind, as in docs/model.md: two triangles that meet, along two views.
// Plain CULLIDE ends after a round that culls nothing. Quick-CULLIDE has set bits, goes on, and
// culls nothing more.
TEST(CullModel, QuickMayGoOnInVain) {
  View view{.shown = 3};
  view.behind[0] = only(1);
  view.behind[1] = only(0);
  view.elements[0] = view.elements[1] = 1;
  const World world{{only(0), only(1)}, 3, {view, view}};
  const Schedule quick{.triangles = singles(world.owners)};
  Schedule plain = quick;
  plain.quick = false;
  const Outcome by_quick = by_core(case_of(world, quick, {}));
  const Outcome by_plain = by_core(case_of(world, plain, {}));
  EXPECT_EQ(by_quick.steps.back().draws, 10u);
  EXPECT_EQ(by_plain.steps.back().draws, 8u);
  EXPECT_EQ(by_quick.bits, (std::vector<std::uint8_t>{kF, kL}));
  EXPECT_EQ(by_plain.bits, (std::vector<std::uint8_t>{0, 0}));
}

struct Removed {
  const char* name;
  bool Rules::*rule;
  Fault fault = Fault::none;  // what removes the same from core/cull, where its pass rule does not
  bool by_pass_rule = false;
};
const Removed kRemoved[] = {
    {"backwards", &Rules::backwards},
    {"one_order", &Rules::one_order},
    {"stores_f_first", &Rules::stores_f_first, Fault::none, true},
    {"stores_l_second", &Rules::stores_l_second, Fault::none, true},
    {"asks_f_second", &Rules::asks_f_second, Fault::none, true},
    {"asks_l_first", &Rules::asks_l_first, Fault::none, true},
    {"undrawable_is_open", &Rules::undrawable_is_open},
    {"undrawable_hides", &Rules::undrawable_hides, Fault::nothing_everywhere},
    {"undrawn_hides_not", &Rules::undrawn_hides_not},
    {"whole_groups", &Rules::whole_groups, Fault::first_of_slot},
    {"due_by_stored", &Rules::due_by_stored},
    {"due_in_view", &Rules::due_in_view},
    {"until_no_bit", &Rules::until_no_bit},
};

TEST(CullModelTwin, AModelWithoutOneRuleDisagrees) {
  for (const Removed& removed : kRemoved) {
    bool differs = false;
    for (int n = 0; n < 2000 && !differs; ++n) {
      Case c = nth_case(n);
      const Outcome core = by_core(c);
      c.schedule.rules.*removed.rule = false;
      differs = !difference(by_model(c), core).empty();
    }
    EXPECT_TRUE(differs) << removed.name;
  }
}

// Where the canvas or the pass rule can remove a rule from core/cull, it then does what the model
// does without that rule: what breaks there breaks here.
TEST(CullModelTwin, CullWithoutTheSameRuleAgrees) {
  for (const Removed& removed : kRemoved) {
    if (!removed.by_pass_rule && removed.fault == Fault::none) continue;
    for (int n = 0; n < kTrials / 50; ++n) {
      Case c = nth_case(n);
      // Of a cluster the canvas takes the first triangle along the curve, the model that of the
      // least number.
      if (removed.fault == Fault::first_of_slot && !c.clusters.empty()) continue;
      c.schedule.rules.*removed.rule = false;
      c.schedule.full = true;  // core/cull decides what is due by the rule that holds
      ASSERT_EQ(difference_of_bits(by_model(c), by_core(c, removed.fault)), "")
          << removed.name << ", seed " << n;
    }
  }
}

// ---- patches ----

std::vector<TrianglePair> pairs_by_model(const Case& c, const Bits& bits) {
  std::vector<TrianglePair> out;
  const std::vector<std::uint32_t> object = owners(c.scene);
  for (std::uint32_t a = 0; a < object.size(); ++a) {
    for (std::uint32_t b = a + 1; b < object.size(); ++b) {
      const bool one_object = object[a] == object[b];
      if (one_object && !c.scene.objects[object[a]].self) continue;
      if (tested(c.world, bits, static_cast<int>(a), static_cast<int>(b), c.schedule.rules))
        out.push_back({a, b});
    }
  }
  return out;
}

TEST(CullModel, AgreesWithJoinPatches) {
  const Rules intact;
  int inside_differs = 0, order_differs = 0;
  for (int n = 0; n < kTrials / 20; ++n) {
    Case c = nth_case(n);
    if (c.patches.empty()) continue;
    const Bits bits = run(c.world, c.schedule, c.start, [](const Step&) {});
    const Outcome core = by_core(c);
    const std::vector<TrianglePair> pairs = pairs_by_core(c, core);
    ASSERT_EQ(pairs, pairs_by_model(c, bits)) << "seed " << n;
    c.schedule.rules.joins_inside_owners = false;
    inside_differs += pairs != pairs_by_model(c, bits);
    c.schedule.rules = intact;
    c.schedule.rules.reads_bits_in_order = false;
    order_differs += pairs != pairs_by_model(c, bits);
  }
  EXPECT_GT(inside_differs, 0);
  EXPECT_GT(order_differs, 0);
}

}  // namespace
}  // namespace farcull::model
