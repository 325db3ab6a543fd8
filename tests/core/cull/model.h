// The passes of the CULLIDE family as a model: pure functions over sets of triangles. It says what
// core/cull does in as few words as possible, and shares no code with it. docs/model.md explains it
// and what is tested with it.
#pragma once

#include "tests/lab/standard.h"

namespace farcull::model {

/// A set of triangles: bit t stands for triangle t.
using Set = std::uint32_t;
constexpr int kMost = 31;  // triangles of a world
constexpr Set only(int t) { return Set{1} << t; }
constexpr int first_of(Set set) { return std::countr_zero(set); }

/// The triangles that have F (cleared against all earlier owners), and those that have L (against
/// all later ones). A triangle that has both is culled.
struct Bits {
  Set f = 0, l = 0;
  Set culled() const { return f & l; }
  bool operator==(const Bits&) const = default;
};

/// What one view shows. A depth buffer keeps the nearest depth of each pixel, so a triangle is seen
/// against a stored set if and only if it is seen against one member of it. So a relation between
/// triangles says everything.
struct View {
  bool drawn = true;                  // false: the view cannot be drawn, and is left out
  Set undrawable = 0;                 // triangles whose place in the view is not known
  Set shown = 0;                      // drawable triangles with a point in the window
  std::array<Set, kMost> behind{};    // per shown triangle: the shown ones against which it is seen
  std::array<int, kMost> elements{};  // per shown triangle: what it is drawn as, 1 or more
};

struct World {
  std::vector<Set> owners;  // in their order; disjoint
  Set region = 0;           // the triangles that take part
  std::vector<View> views;  // at most kMostViews
};

/// Per owner its groups: disjoint subsets of it, each of which is asked as a whole.
using Level = std::vector<std::vector<Set>>;

/// Which rules hold. Each can be removed alone, to see what it is for.
struct Rules {
  bool backwards = true;           // the second pass goes from the last owner to the first
  bool one_order = true;           // in every round; false: every second round reverses the order
  bool stores_f_first = true;      // the first pass stores what has F alone (lemma L3)
  bool stores_l_second = true;     // the second pass stores what has L alone (lemma L5)
  bool asks_f_second = true;       // the second pass asks what has F alone (lemma L2)
  bool asks_l_first = true;        // the first pass asks what has L alone (lemma L4)
  bool undrawable_is_open = true;  // an undrawable triangle gets no bit
  bool undrawable_hides = true;    // an undrawable triangle is stored everywhere
  bool undrawn_hides_not = true;   // a triangle without a point in the window counts as not stored
  bool whole_groups = true;        // a group is seen where any member is; false: where its first is
  bool due_by_stored = true;       // a pass is left out where what it *stores* is unchanged
  bool due_in_view = true;         // since it last ran in this *view*; false: in any view
  bool until_no_bit = true;        // rounds end where no *bit* was set; false: where none is culled
  bool joins_inside_owners = true;  // pairs of one owner are tested
  bool reads_bits_in_order = true;  // of two owners, L of the earlier and F of the later are read
};

inline Level singles(const std::vector<Set>& owners) {
  Level out;
  for (const Set owner : owners) {
    out.emplace_back();
    for (Set rest = owner; rest != 0; rest &= rest - 1) out.back().push_back(rest & -rest);
  }
  return out;
}

inline Level wholes(const std::vector<Set>& owners) {
  Level out;
  for (const Set owner : owners) out.push_back({owner});
  return out;
}

struct Pass {
  bool second = false;  // it gives L; the first gives F
  Set asked = 0, stored = 0;
};

/// Plain CULLIDE asks and stores all live triangles, in both passes.
inline Pass plain_pass(bool second, Set region, const Bits& bits) {
  const Set live = region & ~bits.culled();
  return {second, live, live};
}

/// Quick-CULLIDE asks what lacks the bit of the pass, and stores what lacks the other bit.
inline Pass quick_pass(bool second, Set region, const Bits& bits, const Rules& rules) {
  const Set has = second ? bits.l : bits.f, other = second ? bits.f : bits.l;
  Pass pass{second, region & ~has, region & ~other};
  if (!(second ? rules.asks_f_second : rules.asks_l_first)) pass.asked &= ~other;
  if (!(second ? rules.stores_l_second : rules.stores_f_first)) pass.stored &= ~has;
  return pass;
}

/// Plain CULLIDE keeps no bits from level to level, only what is culled.
inline Bits forgotten(const Bits& bits) { return {bits.culled(), bits.culled()}; }

struct Answer {
  Set cleared = 0;           // the triangles that get the bit of the pass
  std::uint64_t draws = 0;   // elements asked and stored, up to the last question
  std::uint64_t groups = 0;  // asked
};

inline std::uint64_t count_elements(const View& view, Set triangles) {
  std::uint64_t count = 0;
  for (Set rest = triangles; rest != 0; rest &= rest - 1)
    count += static_cast<std::uint64_t>(view.elements[first_of(rest)]);
  return count;
}

inline bool seen(const View& view, Set members, Set stored, const Rules& rules) {
  if (!rules.whole_groups) members &= -members;
  Set behind = view.undrawable;
  for (Set rest = members; rest != 0; rest &= rest - 1) behind |= view.behind[first_of(rest)];
  return (behind & stored) != 0;
}

/// A pass goes through the owners in order. Each is asked, then stored. What is not seen is
/// cleared: also what is asked before anything is stored, or has no point in the window.
inline Answer run_pass(const World& world, const View& view, const Level& level, const Pass& pass,
                       bool reversed, const Rules& rules) {
  const Set open = rules.undrawable_is_open ? ~view.undrawable : ~Set{0};
  const Set hiding = (rules.undrawable_hides ? ~Set{0} : ~view.undrawable) &
                     (rules.undrawn_hides_not ? view.shown | view.undrawable : ~Set{0});
  Answer answer;
  Set stored = 0;           // so far
  std::uint64_t drawn = 0;  // so far
  const std::size_t n = world.owners.size();
  for (std::size_t i = 0; i < n; ++i) {
    const std::size_t o = (pass.second && rules.backwards) != reversed ? n - 1 - i : i;
    const Set asked = pass.asked & world.owners[o] & open;
    answer.cleared |= stored == 0 ? asked : asked & ~view.shown;
    for (const Set group : level[o]) {
      const Set members = group & pass.asked & view.shown;
      if (stored == 0 || members == 0) continue;
      if (!seen(view, members, stored, rules)) answer.cleared |= members;
      ++answer.groups;
      drawn += count_elements(view, members);
      answer.draws = drawn;
    }
    const Set more = pass.stored & world.owners[o] & hiding;
    stored |= more;
    drawn += count_elements(view, more & view.shown) + std::popcount(more & view.undrawable);
  }
  return answer;
}

struct Schedule {
  bool quick = true;            // false: plain CULLIDE
  std::vector<Level> coarse{};  // levels of the first round, before the triangles
  Level triangles{};            // each triangle alone
  bool alone = false;           // the coarse levels in every round, and never the triangles
  int rounds = 0;               // at most so many; 0: until one changes nothing
  bool all_views = false;       // a bit is set where every view sets it
  bool full = false;            // nothing is left out
  int enough = 0;               // live triangles at which the run ends; 0: never
  int worth = 0;  // the run goes on where a view culled one live triangle in so many; 0: always
  Rules rules{};
};

struct Step {
  int round = 0, view = 0, level = 0;  // level: into `coarse`, or its size for the triangles
  bool second = false, ran = false;    // ran: not left out
  Pass pass{};
  Answer answer{};
  Bits before{}, bits{};  // before and after the pass
};

constexpr int kMostViews = 8;
constexpr Set kNever = ~Set{0};  // no set of triangles
/// Per view and pass over single triangles: what it stored when it last ran.
using Memory = std::array<std::array<Set, 2>, kMostViews>;

template <class Watch>
Bits run_level(const World& world, const Schedule& s, Step step, Bits bits, Memory& memory,
               const Watch& watch) {
  const bool fine = step.level == static_cast<int>(s.coarse.size());
  if (!s.quick) bits = forgotten(bits);
  for (const bool second : {false, true}) {
    step.second = second;
    step.before = bits;
    step.pass = s.quick ? quick_pass(second, world.region, bits, s.rules)
                        : plain_pass(second, world.region, bits);
    Set& last = memory[s.rules.due_in_view ? step.view : 0][second];
    const Set now = s.rules.due_by_stored ? step.pass.stored : step.pass.asked;
    step.ran = !fine || !s.quick || s.full || s.all_views || last != now;
    step.answer = {};
    if (step.ran) {
      if (fine) last = now;
      const bool reversed = !s.rules.one_order && step.round % 2 == 0;
      step.answer =
          run_pass(world, world.views[step.view], fine ? s.triangles : s.coarse[step.level],
                   step.pass, reversed, s.rules);
      (second ? bits.l : bits.f) |= step.answer.cleared;
    }
    step.bits = bits;
    watch(step);
  }
  return bits;
}

inline int count_live(const World& world, const Bits& bits) {
  return std::popcount(world.region & ~bits.culled());
}

template <class Watch>
Bits visit(const World& world, const Schedule& s, int round, int view, Bits bits, Memory& memory,
           const Watch& watch) {
  const int levels = static_cast<int>(s.coarse.size());
  for (int level = round == 1 || s.alone ? 0 : levels; level < levels + !s.alone; ++level) {
    if (count_live(world, bits) == 0 && !s.full) break;
    bits = run_level(world, s, {.round = round, .view = view, .level = level}, bits, memory, watch);
  }
  return bits;
}

/// Whether the run ends after a view (or round) that left of `live` triangles those without `bits`.
inline bool ends(const World& world, const Schedule& s, int live, const Bits& bits) {
  const int left = count_live(world, bits);
  return !s.full &&
         ((s.enough > 0 && left <= s.enough) || (live - left) * s.worth < live * (s.worth > 0));
}

template <class Watch>
Bits run_round(const World& world, const Schedule& s, int round, Bits bits, Memory& memory,
               bool& ended, const Watch& watch) {
  if (s.all_views && !s.quick) bits = forgotten(bits);
  const Bits start = bits;
  Bits agreed = {kNever, kNever};
  for (int v = 0; v < static_cast<int>(world.views.size()); ++v) {
    if (world.views[v].drawn) {
      const int live = count_live(world, bits);
      bool ran = false;  // a visit that is left out decides nothing
      bits = visit(world, s, round, v, bits, memory, [&](const Step& step) {
        ran |= step.ran;
        watch(step);
      });
      if (!s.all_views && (ended = ran && ends(world, s, live, bits))) break;
    }
    if (!s.all_views) continue;
    if (!s.quick) bits = forgotten(bits);
    agreed = {agreed.f & bits.f, agreed.l & bits.l};
    bits = start;
  }
  return s.all_views && !world.views.empty() ? agreed : bits;
}

/// All rounds, from `bits`, which are facts: found by another run on the same triangles and owners.
/// Calls watch(step) after each pass. Returns the bits at the end.
template <class Watch>
Bits run(const World& world, const Schedule& s, Bits bits, const Watch& watch) {
  Set outside = 0;
  for (const Set owner : world.owners) outside |= owner & ~world.region;
  bits = {bits.f | outside, bits.l | outside};
  Memory memory;
  memory.fill({kNever, kNever});
  for (int round = 1;; ++round) {
    const Bits before = bits;
    bool ended = false;
    bits = run_round(world, s, round, bits, memory, ended, watch);
    const int live = count_live(world, before), culled = live - count_live(world, bits);
    const bool changed = s.quick && s.rules.until_no_bit ? bits != before : culled > 0;
    if (s.all_views) ended = ends(world, s, live, bits);
    if (!changed || round == s.rounds || ended || (!s.full && culled == live)) break;
  }
  return s.quick ? bits : forgotten(bits);
}

/// Whether exact tests look at two triangles after culling by patches as owners. owner(t): its
/// place in World::owners.
inline bool tested(const World& world, const Bits& bits, int u, int t, const Rules& rules) {
  int owner[2] = {0, 0};
  while (!(world.owners[owner[0]] & only(u))) ++owner[0];
  while (!(world.owners[owner[1]] & only(t))) ++owner[1];
  if (owner[0] == owner[1]) return rules.joins_inside_owners;
  const bool in_order = (owner[0] < owner[1]) == rules.reads_bits_in_order;
  const int earlier = in_order ? u : t, later = in_order ? t : u;
  return !(bits.l & only(earlier)) && !(bits.f & only(later));
}

}  // namespace farcull::model
