// All small worlds of the model (model.h), what must never be set in them, and how they are written
// in docs/model.md.
#pragma once

#include <string>
#include <vector>

#include "tests/core/cull/model.h"

namespace farcull::model {

/// The triangles that `t` may meet, as far as this view knows (the visibility axiom): two triangles
/// that meet are seen against each other; one without a point in the window meets none.
inline Set may_meet(const View& view, int t) {
  if (view.undrawable & only(t)) return view.undrawable | view.shown;
  if (!(view.shown & only(t))) return 0;
  Set out = view.undrawable;
  for (Set rest = view.shown & view.behind[t]; rest != 0; rest &= rest - 1) {
    const int u = std::countr_zero(rest);
    if (view.behind[u] & only(t)) out |= only(u);
  }
  return out;
}

/// The triangles that `t` may meet in a world, itself left out.
inline Set may_meet(const World& world, int t) {
  Set out = world.region & only(t) ? world.region & ~only(t) : 0;
  for (const View& view : world.views) {
    if (view.drawn) out &= may_meet(view, t);
  }
  return out;
}

/// The bits that theorem 2 forbids where all triangles meet that may: F of a triangle that meets
/// one of an earlier owner, L of one that meets one of a later owner.
inline Bits forbidden(const World& world) {
  Bits out;
  Set before = 0, all = 0;
  for (const Set owner : world.owners) all |= owner;
  for (const Set owner : world.owners) {
    for (Set rest = owner; rest != 0; rest &= rest - 1) {
      const int t = std::countr_zero(rest);
      const Set met = may_meet(world, t);
      if (met & before) out.f |= only(t);
      if (met & all & ~before & ~owner) out.l |= only(t);
    }
    before |= owner;
  }
  return out;
}

inline bool breaks(const Bits& bits, const Bits& forbidden) {
  return ((bits.f & forbidden.f) | (bits.l & forbidden.l)) != 0;
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
        for (int u = 0; u < n; ++u) {
          if ((owner & view.shown & only(t)) && (~owner & view.shown & only(u)))
            pairs.emplace_back(t, only(u));
        }
      }
    }
    for (Set relation = 0; relation < only(static_cast<int>(pairs.size())); ++relation) {
      view.behind = {};
      for (std::size_t i = 0; i < pairs.size(); ++i) {
        if (relation & only(static_cast<int>(i))) view.behind[pairs[i].first] |= pairs[i].second;
      }
      out.push_back(view);
    }
  }
  return out;
}

}  // namespace farcull::model
