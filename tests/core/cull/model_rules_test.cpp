// Each rule of the passes, and each thing that they take for granted, removed once: the smallest
// world in which something breaks, as docs/model.md shows it. core/cull, which has all the rules,
// keeps what is lost there.
#include "core/base/text.h"
#include "tests/core/cull/model_cases.h"
#include "tests/core/cull/model_worlds.h"

namespace farcull::model {
namespace {

// What breaks without a rule.
enum class Breaks { lost, lost_in_patches, kept, questions };

struct Removal {
  const char* text;  // on the page
  Breaks breaks;
  std::function<void(Rules&)> remove = {};
  Axioms axioms = {};
  bool owners_first = false;  // owners are asked as a whole before their triangles
  bool mixed = false;         // a group of all triangles
  bool any_start = false;     // the run begins with any bits
};

struct Found {
  World world;
  Bits start;
  Schedule schedule;  // without the rule
  int n = 0, weight = 1 << 20;
  std::string effect;  // empty: nothing found yet
};

std::string text_of_bits(const Bits& bits, int n) {
  std::string out;
  for (int t = 0; t < n; ++t) {
    if (bits.f & only(t)) out += " F(" + letter(t) + ")";
    if (bits.l & only(t)) out += " L(" + letter(t) + ")";
  }
  return out;
}

// The first pair that may meet and is not left for exact tests.
std::string lost_pair(const World& world, const Bits& end, const Removal& removal, int n,
                      const Rules& rules) {
  for (int t = 0; t < n; ++t) {
    const Set met = may_meet(world, t, removal.axioms);
    for (int u = 0; u < t; ++u) {
      const bool one_owner = std::ranges::any_of(
          world.owners, [&](Set owner) { return (owner & only(t)) && (owner & only(u)); });
      // Whether triangles of one owner are seen against each other nobody asks.
      if (!one_owner && !(met & only(u))) continue;
      const bool patches = removal.breaks == Breaks::lost_in_patches;
      const bool left = patches ? tested(world, end, u, t, rules)
                                : one_owner || !(end.culled() & (only(u) | only(t)));
      if (!left) return letter(u) + " with " + letter(t) + " is lost";
    }
  }
  return "";
}

// What breaks in a world without the rule; empty: nothing.
std::string effect(const World& world, const Bits& start, const Schedule& intact,
                   const Schedule& removed, const Removal& removal, int n) {
  std::uint64_t groups = 0, fewer_groups = 0;
  const Bits end =
      run(world, removed, start, [&](const Step& step) { groups += step.answer.groups; });
  if (removal.breaks == Breaks::lost || removal.breaks == Breaks::lost_in_patches)
    return lost_pair(world, end, removal, n, removed.rules);
  const Bits wanted =
      run(world, intact, start, [&](const Step& step) { fewer_groups += step.answer.groups; });
  if (removal.breaks == Breaks::questions) {
    if (end != wanted || groups == fewer_groups) return "";
    return counted(groups, "question", "questions") + " in place of " + grouped(fewer_groups);
  }
  for (int t = 0; t < n; ++t)
    if (wanted.culled() & ~end.culled() & only(t)) return letter(t) + " is kept";
  return "";
}

void try_world(const World& world, int rounds, const Removal& removal, int n, Found& found) {
  Schedule intact{.triangles = singles(world.owners), .rounds = rounds};
  const Set all = only(n) - 1;
  if (removal.owners_first) intact.coarse = {wholes(world.owners)};
  if (removal.mixed) intact.coarse = {Level(world.owners.size(), {all})};
  Schedule removed = intact;
  if (removal.remove) removal.remove(removed.rules);
  const Set starts = removal.any_start ? only(2 * n) : 1;
  for (Set start = 0; start < starts; ++start) {
    const Bits bits{start & all, start >> n};
    const int weight =
        model::weight(world) + std::popcount(start) + n - std::popcount(world.region);
    if (weight >= found.weight) continue;
    const std::string what = effect(world, bits, intact, removed, removal, n);
    if (!what.empty()) found = {world, bits, removed, n, weight, what};
  }
}

// Fewest triangles, then fewest views, then fewest rounds, then least to say of the views.
Found smallest_of(int n, std::size_t views, int rounds, const Removal& removal) {
  Found found;
  for (const std::vector<Set>& owners : divisions(n)) {
    const std::vector<View> all = all_views(owners, n);
    World world{owners, only(n) - 1, std::vector<View>(views)};
    for (std::size_t a = 1; a < all.size(); ++a) {  // the first cannot be drawn
      world.views[0] = all[a];
      for (std::size_t b = 1; b < (views == 1 ? 2 : all.size()); ++b) {
        if (views == 2) world.views[1] = all[b];
        const Set least = removal.axioms.takes_part ? only(n) - 1 : 1;
        for (world.region = only(n) - 1; world.region >= least; --world.region)
          try_world(world, rounds, removal, n, found);
      }
    }
  }
  return found;
}

Found smallest(const Removal& removal) {
  const bool ends = removal.breaks == Breaks::kept || removal.breaks == Breaks::questions;
  for (int n = 1; n <= 3; ++n) {
    for (std::size_t views = 1; views <= 2; ++views) {
      for (int rounds = ends ? 0 : 1; rounds <= (ends ? 0 : 3); ++rounds) {
        Found found = smallest_of(n, views, rounds, removal);
        if (!found.effect.empty()) return found;
      }
    }
  }
  return {};
}

std::string line(const Removal& removal, const Found& found) {
  std::string world = text_of(found.world, found.n);
  for (int t = 0; t < found.n; ++t)
    if (!(found.world.region & only(t))) world += "; " + letter(t) + " takes no part";
  if (found.start != Bits{}) world += "; it begins with" + text_of_bits(found.start, found.n);
  if (found.schedule.rounds > 1) world += "; " + std::to_string(found.schedule.rounds) + " rounds";
  return std::string("| ") + removal.text + " | " + world + " | " + found.effect + " |";
}

const Axioms kOneWay{.both_ways = false}, kNoPoint{.has_point = false},
    kNoPart{.takes_part = false};

const std::vector<Removal>& removals() {
  static const std::vector<Removal> all = {
      {"the second pass goes backwards", Breaks::lost, [](Rules& r) { r.backwards = false; }},
      {"the owners have one order, in all rounds", Breaks::lost,
       [](Rules& r) { r.one_order = false; }},
      {"the first pass stores what has F alone (L3)", Breaks::lost,
       [](Rules& r) { r.stores_f_first = false; }},
      {"the second pass stores what has L alone (L5)", Breaks::lost,
       [](Rules& r) { r.stores_l_second = false; }},
      {"an undrawable triangle gets no bit", Breaks::lost,
       [](Rules& r) { r.undrawable_is_open = false; }},
      {"an undrawable triangle is stored everywhere", Breaks::lost,
       [](Rules& r) { r.undrawable_hides = false; }},
      {"a group is seen where any member is",
       Breaks::lost,
       [](Rules& r) { r.whole_groups = false; },
       {},
       true},
      {"pairs inside a patch are tested", Breaks::lost_in_patches,
       [](Rules& r) { r.joins_inside_owners = false; }},
      {"of a pair of patches, L of the earlier and F of the later are read",
       Breaks::lost_in_patches, [](Rules& r) { r.reads_bits_in_order = false; }},
      {"triangles that meet are seen against each other, both ways", Breaks::lost, {}, kOneWay},
      {"a triangle without a point in a window meets nothing", Breaks::lost, {}, kNoPoint},
      {"a triangle that takes no part meets nothing", Breaks::lost, {}, kNoPart},
      {"a group has triangles of one owner", Breaks::lost, {}, {}, false, true},
      {"bits at the begin are facts", Breaks::lost, {}, {}, false, false, true},
      {"the second pass asks what has F alone (L2)", Breaks::kept,
       [](Rules& r) { r.asks_f_second = false; }},
      {"the first pass asks what has L alone (L4)", Breaks::kept,
       [](Rules& r) { r.asks_l_first = false; }},
      {"a pass is left out by what it stores, not by what it asks", Breaks::kept,
       [](Rules& r) { r.due_by_stored = false; }},
      {"it is left out by its last run in the same view", Breaks::kept,
       [](Rules& r) { r.due_in_view = false; }},
      {"rounds end where no bit was set, not where nothing was culled", Breaks::kept,
       [](Rules& r) { r.until_no_bit = false; }},
      {"a triangle without a point in the window counts as not stored", Breaks::questions,
       [](Rules& r) { r.undrawn_hides_not = false; }},
  };
  return all;
}

TEST(ModelRules, EachIsNeededAsThePageShows) {
  for (const Removal& removal : removals()) {
    const Found found = smallest(removal);
    ASSERT_FALSE(found.effect.empty()) << removal.text;
    expect_on_page(line(removal, found));
    if (removal.mixed) continue;  // core/cull makes no such groups
    Case c = case_of(found.world, found.schedule, found.start);
    c.schedule.rules = {};
    EXPECT_EQ(difference(by_model(c), by_core(c)), "") << removal.text;
  }
}

// Of the removed rules: with all rules nothing is lost in any world of up to three triangles, one
// view and two rounds. (model_worlds_test.cpp has larger worlds, without patches.)
TEST(ModelRules, TogetherTheyLoseNothing) {
  for (const Breaks breaks : {Breaks::lost, Breaks::lost_in_patches})
    for (int n = 1; n <= 3; ++n)
      EXPECT_EQ(smallest_of(n, 1, 2, {.text = "", .breaks = breaks}).effect, "");
}

}  // namespace
}  // namespace farcull::model
