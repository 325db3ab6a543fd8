// The model of the passes on all small worlds: theorem 2, and what the lemmas of Quick-CULLIDE say
// of bits and costs (docs/model.md). What is counted here stands in that page.
#include "tests/core/cull/model_worlds.h"
#include "core/base/count.h"

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

}  // namespace
}  // namespace farcull::model
