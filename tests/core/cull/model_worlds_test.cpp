// The model of the passes on all small worlds: theorem 2, and what the lemmas of Quick-CULLIDE say
// of bits and costs (docs/model.md). What is counted here stands in that page.
#include "tests/core/cull/model_worlds.h"
#include "core/base/text.h"

namespace farcull::model {
namespace {

// ---- runs: all worlds of two views ----

// The pairs of triangles of different owners that may meet in a world of this view alone, a bit
// each.
Set meeting_pairs(const std::vector<Set>& owners, const View& view, int n) {
  Set out = 0;
  int pair = 0;
  for (int t = 0; t < n; ++t) {
    for (int u = 0; u < t; ++u, ++pair) {
      const bool apart = std::ranges::none_of(
          owners, [&](Set owner) { return (owner & only(t)) && (owner & only(u)); });
      if (apart && (!view.drawn || (may_meet(view, t) & only(u)))) out |= only(pair);
    }
  }
  return out;
}

TEST(SmallWorlds, NoPairThatMeetsIsCulledInThreeRoundsOfTwoViews) {
  for (int n = 1; n <= kTriangles; ++n) {
    std::uint64_t worlds = 0, at_stake = 0;
    for (const std::vector<Set>& owners : divisions(n)) {
      const std::vector<View> views = all_views(owners, n);
      std::vector<Set> pairs;
      for (const View& view : views) pairs.push_back(meeting_pairs(owners, view, n));
      const Schedule schedule{
          .coarse = {wholes(owners)}, .triangles = singles(owners), .rounds = 3};
      World world{owners, only(n) - 1, {{}, {}}};
      for (std::size_t a = 0; a < views.size(); ++a) {
        world.views[0] = views[a];
        for (std::size_t b = 0; b < views.size(); ++b) {
          ++worlds;
          if (!(pairs[a] & pairs[b])) continue;  // nothing can meet
          ++at_stake;
          world.views[1] = views[b];
          const Bits no = forbidden(world);
          run(world, schedule, {}, [&](const Step& step) {
            if (breaks(step.bits, no)) ADD_FAILURE() << text_of(world, n);
          });
        }
      }
    }
    expect_on_page("| " + std::to_string(n) + " | " + grouped(worlds) + " | " + grouped(at_stake) +
                   " |");
  }
}

// Calls visit(world) for all worlds of n triangles and two views.
template <class Visit>
void for_worlds(int n, const Visit& visit) {
  for (const std::vector<Set>& owners : divisions(n)) {
    const std::vector<View> views = all_views(owners, n);
    World world{owners, only(n) - 1, {{}, {}}};
    for (const View& a : views) {
      world.views[0] = a;
      for (const View& b : views) {
        world.views[1] = b;
        visit(world);
      }
    }
  }
}

const auto ignore = [](const Step&) {};

TEST(SmallWorlds, EveryFormOfTheScheduleKeepsPairs) {
  for (int n = 1; n <= 3; ++n) {
    for_worlds(n, [&](const World& world) {
      const Bits no = forbidden(world);
      if (no.f == 0) return;
      for (int form = 0; form < 16; ++form) {
        Schedule s{.quick = (form & 1) != 0, .triangles = singles(world.owners)};
        s.all_views = form & 2;
        s.full = form & 4;
        if (form & 8) s.coarse = {wholes(world.owners)};
        run(world, s, {}, [&](const Step& step) {
          if (breaks(step.bits, no)) ADD_FAILURE() << text_of(world, n) << ", form " << form;
        });
      }
    });
  }
}

TEST(SmallWorlds, TheEndIsTheSameInAnyOrderOfViewsAndWithAnyGroups) {
  for (int n = 1; n <= 3; ++n) {
    for_worlds(n, [&](const World& world) {
      const Schedule s{.triangles = singles(world.owners)};
      const Bits end = run(world, s, {}, ignore);
      const World swapped{world.owners, world.region, {world.views[1], world.views[0]}};
      ASSERT_EQ(run(swapped, s, {}, ignore), end) << text_of(world, n);
      Schedule grouped = s, full = s;
      grouped.coarse = {wholes(world.owners)};
      full.full = true;
      ASSERT_EQ(run(world, grouped, {}, ignore), end) << text_of(world, n);
      ASSERT_EQ(run(world, full, {}, ignore), end) << text_of(world, n);
      // From any bits of another run: not below it.
      const Bits one_round = run(world, {.triangles = s.triangles, .rounds = 1}, {}, ignore);
      ASSERT_EQ(run(world, s, one_round, ignore), end) << text_of(world, n);
    });
  }
}

struct Work {
  std::vector<Step> steps;
  std::vector<std::uint64_t> draws, groups;  // up to each step
  Bits end;
};

Work work_of(const World& world, const Schedule& s) {
  Work out;
  std::uint64_t draws = 0, groups = 0;
  out.end = run(world, s, {}, [&](const Step& step) {
    out.steps.push_back(step);
    out.draws.push_back(draws += step.answer.draws);
    out.groups.push_back(groups += step.answer.groups);
  });
  return out;
}

// Where Quick-CULLIDE has ended, its last step stands.
bool is_ahead(const Work& quick, const Work& plain) {
  for (std::size_t i = 0; i < plain.steps.size(); ++i) {
    const std::size_t q = std::min(i, quick.steps.size() - 1);
    const Bits &has = quick.steps[q].bits, &wants = plain.steps[i].bits;
    if ((wants.f & ~has.f) || (wants.l & ~has.l)) return false;
    if (quick.draws[q] > plain.draws[i] || quick.groups[q] > plain.groups[i]) return false;
  }
  return true;
}

bool all_shown(const World& world) {
  return std::ranges::all_of(world.views,
                             [&](const View& view) { return view.shown == world.region; });
}

// Quick-CULLIDE may go on where plain CULLIDE has ended. Its total is then larger in some worlds,
// and in some of these it culls no more. The page shows the smallest in which all is shown.
void compare_totals(bool objects_first) {
  std::uint64_t worlds = 0, larger = 0, in_vain = 0, behind = 0;
  int least = 1000;
  std::string smallest;
  for (int n = 1; n <= 3; ++n) {
    for_worlds(n, [&](const World& world) {
      Schedule s{.triangles = singles(world.owners)};
      if (objects_first) s.coarse = {wholes(world.owners)};
      const Work quick = work_of(world, s);
      s.quick = false;
      const Work plain = work_of(world, s);
      s.quick = true;
      s.rules.asks_f_second = false;
      const Work broken = work_of(world, s);
      ++worlds;
      if (plain.steps.empty()) return;
      ASSERT_TRUE(is_ahead(quick, plain)) << text_of(world, n);
      behind += !is_ahead(broken, plain);
      if (quick.draws.back() <= plain.draws.back()) return;
      ++larger;
      if (quick.end.culled() != plain.end.culled()) return;
      ++in_vain;
      if (!all_shown(world) || weight(world) >= least) return;
      least = weight(world);
      smallest = text_of(world, n) + " | " + grouped(quick.draws.back()) + ", " +
                 grouped(plain.draws.back());
    });
  }
  EXPECT_GT(behind, 0u);
  expect_on_page(std::string("| ") + (objects_first ? "owners, then triangles" : "triangles") +
                 " | " + grouped(larger) + " of " + grouped(worlds) + " | " + grouped(in_vain) +
                 " | " + smallest + " |");
}

TEST(SmallWorlds, QuickIsAheadOfPlainAndMayGoOnInVain) {
  compare_totals(false);
  compare_totals(true);
}

// ---- Theorem 2 and the lemmas of Quick-CULLIDE for one pass of the model, from every state of up
// to four triangles (docs/model.md). What holds for each pass holds for any number of views and
// rounds.

// What a pass over one level of one view does in every state. A state has two bits for each of at
// most four triangles: F in the low half, L in the high one.
constexpr int kHalf = 4;
constexpr Set kStates = only(2 * kHalf);
Bits bits_of(Set state) { return {state & (only(kHalf) - 1), state >> kHalf}; }

struct Setting {
  World world;  // of one view
  Level level;
  bool has(Set state) const {
    const Bits bits = bits_of(state);
    return ((bits.f | bits.l) & ~world.region) == 0;
  }
};

struct Table {
  std::array<std::array<Answer, kStates>, 2> quick;  // [second pass][state]
  std::array<std::array<Answer, kStates>, 2>
      plain;  // of states in which all bits are of culled ones
  std::array<std::array<Set, kStates>, 2> asks_more, stores_more;  // cleared, against L2 to L5

  Set plain_cleared(bool second, const Bits& bits) const {
    return plain[second][bits.culled() | bits.culled() << kHalf].cleared;
  }
};

// against_lemmas: what has the bit of the pass alone is asked as well (against L2 and L4); what has
// the other one alone is stored as well (against L3 and L5).
void fill(const Setting& at, bool against_lemmas, Table& table) {
  const Rules rules;
  for (Set state = 0; state < kStates; ++state) {
    if (!at.has(state)) continue;
    const Bits bits = bits_of(state);
    for (const bool second : {false, true}) {
      const auto answer = [&](const Pass& pass) {
        return run_pass(at.world, at.world.views[0], at.level, pass, false, rules);
      };
      const Pass quick = quick_pass(second, at.world.region, bits, rules);
      table.quick[second][state] = answer(quick);
      const Pass plain = plain_pass(second, at.world.region, bits);
      if (bits.f == bits.l) table.plain[second][state] = answer(plain);
      if (!against_lemmas) continue;
      const Set live = plain.asked;
      table.asks_more[second][state] = answer({second, live, quick.stored}).cleared;
      table.stores_more[second][state] = answer({second, quick.asked, live}).cleared;
    }
  }
}

// Calls visit(setting, table, whether triangles are asked one by one) for each view of n triangles,
// each division among owners and each of these into groups.
template <class Visit>
void for_settings(int n, bool against_lemmas, const Visit& visit) {
  const auto table = std::make_unique<Table>();
  for (const std::vector<Set>& owners : divisions(n)) {
    for (const std::vector<Set>& groups : divisions(n)) {
      Level level;
      std::size_t placed = 0;
      for (const Set owner : owners) {
        level.emplace_back();
        for (const Set group : groups)
          if ((group & ~owner) == 0) level.back().push_back(group);
        placed += level.back().size();
      }
      if (placed < groups.size()) continue;  // a group of two owners
      for (const View& view : all_views(owners, n)) {
        if (!view.drawn) continue;
        const Setting at{{owners, only(n) - 1, {view}}, level};
        fill(at, against_lemmas, *table);
        visit(at, *table, groups.size() == static_cast<std::size_t>(n));
      }
    }
  }
}

Set with(Set state, bool second, Set cleared) {
  return state | (second ? cleared << kHalf : cleared);
}

// Theorem 2 holds pair by pair: a pass from any state in which a pair that may meet is safe leaves
// it safe. So it holds for any number of views, rounds and levels, from any bits that are facts.
TEST(SmallSteps, KeepEveryPairThatMeets) {
  std::uint64_t checked = 0;
  for (int n = 2; n <= kTriangles; ++n) {
    for_settings(n, true, [&](const Setting& at, const Table& table, bool) {
      Set before = 0;
      for (const Set owner : at.world.owners) {
        for (int t = 0; t < n; ++t) {
          if (!(owner & only(t))) continue;
          const Set met = may_meet(at.world, t) & before;
          for (int u = 0; u < t; ++u) {
            if (!(met & only(u))) continue;
            for (Set state = 0; state < kStates; ++state) {
              const Bits bits = bits_of(state);
              if (!at.has(state) || (bits.f & only(t)) || (bits.l & only(u))) continue;
              const Set f = table.quick[0][state].cleared | table.plain_cleared(false, bits) |
                            table.asks_more[0][state] | table.stores_more[0][state];
              const Set l = table.quick[1][state].cleared | table.plain_cleared(true, bits) |
                            table.asks_more[1][state] | table.stores_more[1][state];
              ASSERT_FALSE((f & only(t)) || (l & only(u))) << text_of(at.world, n);
              ++checked;
            }
          }
        }
        before |= owner;
      }
    });
  }
  std::printf("%s steps with a pair\n", grouped(checked).c_str());
}

// After every step Quick-CULLIDE's bits contain plain CULLIDE's, and it has drawn and asked no more
// ("Against plain CULLIDE"). Plain CULLIDE's pass depends on what is culled alone.
TEST(SmallSteps, QuickIsAheadOfPlain) {
  for (int n = 1; n <= kTriangles; ++n) {
    for_settings(n, false, [&](const Setting& at, const Table& table, bool) {
      for (Set state = 0; state < kStates; ++state) {
        if (!at.has(state)) continue;
        const Set culled = bits_of(state).culled();
        for (const bool second : {false, true}) {
          const Answer& quick = table.quick[second][state];
          const Set has = second ? bits_of(state).l : bits_of(state).f;
          for (Set some = culled;; some = (some - 1) & culled) {
            const Answer& plain = table.plain[second][some | some << kHalf];
            ASSERT_FALSE(plain.cleared & ~(has | quick.cleared)) << text_of(at.world, n);
            ASSERT_LE(quick.draws, plain.draws) << text_of(at.world, n);
            ASSERT_LE(quick.groups, plain.groups) << text_of(at.world, n);
            if (some == 0) break;
          }
        }
      }
    });
  }
}

// More bits before a pass are more bits after it. So passes that are repeated until none sets a bit
// end at the least set of bits above those of the begin, in any order.
TEST(SmallSteps, AreMonotone) {
  for (int n = 1; n <= kTriangles; ++n) {
    for_settings(n, false, [&](const Setting& at, const Table& table, bool) {
      for (Set more = 0; more < kStates; ++more) {
        if (!at.has(more)) continue;
        for (const bool second : {false, true}) {
          const Set after = with(more, second, table.quick[second][more].cleared);
          for (Set some = more;; some = (some - 1) & more) {
            ASSERT_FALSE(with(some, second, table.quick[second][some].cleared) & ~after)
                << text_of(at.world, n);
            if (some == 0) break;
          }
        }
      }
    });
  }
}

// A pass over single triangles whose stored set is what it was when the pass last ran in this view
// would set nothing. Over groups it may: so only passes over triangles are left out.
TEST(SmallSteps, WhatIsLeftOutWouldSetNothing) {
  int groups_would = 0;
  for (int n = 1; n <= kTriangles; ++n) {
    for_settings(n, false, [&](const Setting& at, const Table& table, bool alone) {
      for (Set state = 0; state < kStates; ++state) {
        if (!at.has(state)) continue;
        for (const bool second : {false, true}) {
          // The bits of the pass may grow afterwards; the others are what decides what is
          // stored.
          const Set after = with(state, second, table.quick[second][state].cleared);
          const Set own = second ? at.world.region << kHalf : at.world.region;
          const Set free = own & ~after;
          for (Set more = free;; more = (more - 1) & free) {
            const Set later = after | more;
            const bool sets =
                (with(later, second, table.quick[second][later].cleared) & ~later) != 0;
            ASSERT_FALSE(alone && sets) << text_of(at.world, n);
            groups_would += sets;
            if (more == 0) break;
          }
        }
      }
    });
  }
  EXPECT_GT(groups_would, 0);
}

// L2 and L4: asking what has the bit already sets no other bit. Where triangles are asked in groups
// it may set fewer. L3 and L5: storing what has the other bit can only set fewer.
TEST(SmallSteps, WhatTheLemmasLeaveOutWouldSetNothing) {
  int asking_sets_fewer = 0, storing_sets_fewer = 0;
  for (int n = 1; n <= kTriangles; ++n) {
    for_settings(n, true, [&](const Setting& at, const Table& table, bool alone) {
      for (Set state = 0; state < kStates; ++state) {
        if (!at.has(state)) continue;
        for (const bool second : {false, true}) {
          const Set after = with(state, second, table.quick[second][state].cleared);
          const Set asks = with(state, second, table.asks_more[second][state]);
          const Set stores = with(state, second, table.stores_more[second][state]);
          ASSERT_FALSE(alone && asks != after) << text_of(at.world, n);
          ASSERT_FALSE(asks & ~after) << text_of(at.world, n);
          ASSERT_FALSE(stores & ~after) << text_of(at.world, n);
          asking_sets_fewer += asks != after;
          storing_sets_fewer += stores != after;
        }
      }
    });
  }
  EXPECT_GT(asking_sets_fewer, 0);
  EXPECT_GT(storing_sets_fewer, 0);
}

}  // namespace
}  // namespace farcull::model
