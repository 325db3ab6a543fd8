// All small worlds of the model (model.h), what must never be set in them, and how they are written
// in docs/model.md.
#pragma once

#include "tests/core/cull/model.h"
#include "tests/lab/test.h"

namespace farcull::model {

/// Triangles of the largest worlds that are all looked at; four take the sanitizers minutes.
#ifdef __SANITIZE_ADDRESS__
constexpr int kTriangles = 3;
#else
constexpr int kTriangles = 4;
#endif

/// What is taken for granted of triangles that meet. Each can be removed alone.
struct Axioms {
  bool both_ways = true;   // each is seen against the other, in every view that shows both
  bool has_point = true;   // each has a point in every window, where it can be drawn
  bool takes_part = true;  // each is in the region
};

/// The triangles that `t` may meet, as far as this view knows.
inline Set may_meet(const View& view, int t, const Axioms& axioms = {}) {
  const Set undrawn = axioms.has_point ? 0 : ~view.shown;
  if (view.undrawable & only(t)) return view.undrawable | view.shown | undrawn;
  if (!(view.shown & only(t))) return axioms.has_point ? 0 : ~Set{0};
  Set out = view.undrawable | undrawn;
  for (Set rest = view.shown; rest != 0; rest &= rest - 1) {
    const int u = first_of(rest);
    const int ways = ((view.behind[t] & only(u)) != 0) + ((view.behind[u] & only(t)) != 0);
    if (ways == 2 || (ways == 1 && !axioms.both_ways)) out |= only(u);
  }
  return out;
}

inline Set all_of(const World& world) {
  Set all = 0;
  for (const Set owner : world.owners) all |= owner;
  return all;
}

/// The triangles that `t` may meet in a world, itself left out.
inline Set may_meet(const World& world, int t, const Axioms& axioms = {}) {
  const Set part = axioms.takes_part ? world.region : all_of(world);
  Set out = part & only(t) ? part & ~only(t) : 0;
  for (const View& view : world.views)
    if (view.drawn) out &= may_meet(view, t, axioms);
  return out;
}

/// The bits that theorem 2 forbids where all triangles meet that may: F of a triangle that meets
/// one of an earlier owner, L of one that meets one of a later owner.
inline Bits forbidden(const World& world, const Axioms& axioms = {}) {
  Bits out;
  Set before = 0;
  const Set all = all_of(world);
  for (const Set owner : world.owners) {
    for (Set rest = owner; rest != 0; rest &= rest - 1) {
      const Set met = may_meet(world, first_of(rest), axioms);
      if (met & before) out.f |= rest & -rest;
      if (met & all & ~before & ~owner) out.l |= rest & -rest;
    }
    before |= owner;
  }
  return out;
}

inline bool breaks(const Bits& bits, const Bits& forbidden) {
  return ((bits.f & forbidden.f) | (bits.l & forbidden.l)) != 0;
}

/// How much there is to say of a world: pairs that are seen, and, three times, triangles not shown.
inline int weight(const World& world) {
  int out = 0;
  const int n = std::popcount(all_of(world));
  for (const View& view : world.views) {
    out += 3 * (n - std::popcount(view.shown));
    for (const Set behind : view.behind) out += std::popcount(behind);
  }
  return out;
}

/// Ways to divide n triangles among owners, in the order of the triangles: 2^(n-1) of them.
inline std::vector<std::vector<Set>> divisions(int n) {
  std::vector<std::vector<Set>> out;
  for (Set cuts = 0; cuts < only(n - 1); ++cuts) {
    std::vector<Set> owners = {only(0)};
    for (int t = 1; t < n; ++t) {
      if (cuts & only(t - 1)) owners.push_back(0);
      owners.back() |= only(t);
    }
    out.push_back(owners);
  }
  return out;
}

/// All that a view can show of triangles of these owners: the first cannot be drawn. Pairs of one
/// owner are left out, since an owner is asked before it is stored.
inline std::vector<View> all_views(const std::vector<Set>& owners, int n) {
  std::vector<View> out = {{.drawn = false}};
  int kinds = 1;
  for (int t = 0; t < n; ++t) kinds *= 3;
  for (int kind = 0; kind < kinds; ++kind) {
    View view;
    for (int t = 0, rest = kind; t < n; ++t, rest /= 3) {
      view.elements[t] = rest % 3 == 0;
      if (rest % 3 == 0) view.shown |= only(t);
      if (rest % 3 == 2) view.undrawable |= only(t);
    }
    std::vector<std::pair<int, Set>> pairs;  // asked, stored
    for (const Set owner : owners) {
      for (int t = 0; t < n; ++t) {
        for (int u = 0; u < n; ++u)
          if ((owner & view.shown & only(t)) && (~owner & view.shown & only(u)))
            pairs.emplace_back(t, only(u));
      }
    }
    for (Set relation = 0; relation < only(static_cast<int>(pairs.size())); ++relation) {
      view.behind = {};
      for (std::size_t i = 0; i < pairs.size(); ++i)
        if (relation & only(static_cast<int>(i))) view.behind[pairs[i].first] |= pairs[i].second;
      out.push_back(view);
    }
  }
  return out;
}

// Worlds of the model as docs/model.md writes them, and the lines of that page.

/// Triangles are a, b, c ...
inline std::string letter(int t) { return {static_cast<char>('a' + t)}; }

inline std::string text_of(const View& view, int n) {
  if (!view.drawn) return " cannot be drawn";
  std::string out;
  for (int t = 0; t < n; ++t) {
    if (view.undrawable & only(t))
      out += " " + letter(t) + "?";
    else if (!(view.shown & only(t)))
      out += " " + letter(t) + "-";
    for (int u = 0; u < n; ++u)
      if (view.behind[t] & only(u)) out += " " + letter(t) + ">" + letter(u);
  }
  return out.empty() ? " nothing is seen" : out;
}

/// "{a} {b c}; view 1: a>b c?": the owners in order; a is seen against b; c is undrawable. "c-": it
/// has no point in the window.
inline std::string text_of(const World& world, int n) {
  std::string out;
  for (const Set owner : world.owners) {
    out += out.empty() ? "{" : " {";
    std::string members;
    for (int t = 0; t < n; ++t)
      if (owner & only(t)) members += (members.empty() ? "" : " ") + letter(t);
    out += members + "}";
  }
  for (std::size_t v = 0; v < world.views.size(); ++v)
    out += "; view " + std::to_string(v + 1) + ":" + text_of(world.views[v], n);
  return out;
}

/// Expects that a line of docs/model.md begins so.
inline void expect_on_page(const std::string& text) {
  const std::string page = "\n" + read_text(FARCULL_TEST_DIR "/../docs/model.md");
  EXPECT_NE(page.find("\n" + text), std::string::npos)
      << "docs/model.md has no line that begins so:\n"
      << text;
}

}  // namespace farcull::model
