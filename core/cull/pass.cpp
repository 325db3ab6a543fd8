// Builds a pass from the state of a run, runs the pass on the canvas, and sets bits by the results.
#include "core/cull/pass.h"

#include <algorithm>

#include "core/base/stage.h"

namespace farcull {
namespace {

// Calls visit(from, to) for the items from .. to - 1 of each owner. ask: the bit that the pass may
// set. Owners ascend in the pass for F and descend in the pass for L.
template <class Visit>
void for_owners(const VisitItems& items, Bit ask, const Visit& visit) {
  const std::vector<std::uint32_t>& begin = items.owner_begin;
  if (ask == kF) {
    for (std::size_t o = 0; o + 1 < begin.size(); ++o) visit(begin[o], begin[o + 1]);
  } else {
    for (std::size_t o = begin.size(); o-- > 1;) visit(begin[o - 1], begin[o]);
  }
}

// The input of a pass: determines which items the pass asks and stores.
struct PassQuestion {
  const CullState& state;
  const VisitItems& visit;
  const Drawables& drawables;
  Bit ask;
  const PassRule& rule;
  const Level& level;

  std::uint8_t bits(std::size_t item) const { return state.bits[visit.items[item]]; }
  std::uint32_t elements(std::size_t item) const {
    return drawables.first[item + 1] - drawables.first[item];
  }
  std::uint32_t group(std::size_t item) const {
    return level.group ? (*level.group)[visit.items[item]] : visit.items[item];
  }
  bool undrawable(std::size_t item) const {
    return !visit.undrawable.empty() && visit.undrawable[item];
  }
};

// Builds one pass and keeps which items belong to each slot.
class PassBuilder {
 public:
  explicit PassBuilder(const PassQuestion& of) : of_(of) {
    pass_.draws.reserve(2 * of.drawables.elements());
    asked_.reserve(of.visit.items.size());
    grouped_ = of.level.group != nullptr;
    for_owners(of.visit, of.ask, [&](std::size_t from, std::size_t to) {
      ask_owner(from, to);
      const bool last = of.ask == kF ? to == of.visit.items.size() : from == 0;
      if (!last) store_owner(from, to);  // no query follows the last owner
    });
    while (!pass_.steps.empty() && pass_.steps.back().verb == Verb::store) {
      pass_.draws.resize(pass_.steps.back().first);
      pass_.steps.pop_back();
    }
    pass_.slots = static_cast<std::uint32_t>(grouped_ ? slot_begin_.size() : asked_.size());
    slot_begin_.push_back(static_cast<std::uint32_t>(asked_.size()));
  }

  Pass& pass() { return pass_; }
  PassCost cost() const { return {pass_.draws.size(), pass_.slots}; }

  // Calls clear(item) for all asked items that are not seen. seen: the result of Canvas::run().
  template <class Clear>
  void for_unseen(const std::vector<std::uint8_t>& seen, const Clear& clear) const {
    for (const std::uint32_t item : undrawn_) clear(item);
    for (std::size_t slot = 0; slot < pass_.slots; ++slot) {
      if (seen[slot]) continue;
      const std::size_t from = grouped_ ? slot_begin_[slot] : slot;
      const std::size_t to = grouped_ ? slot_begin_[slot + 1] : slot + 1;
      for (std::size_t i = from; i < to; ++i) clear(asked_[i]);
    }
  }

 private:
  void ask_owner(std::size_t from, std::size_t to) {
    const Step step{Verb::ask, static_cast<std::uint32_t>(pass_.draws.size()), 0};
    const bool(&asks)[4] = of_.rule.asks[of_.ask == kL];
    std::uint32_t group = 0;
    bool first = true;
    for (std::size_t i = from; i < to; ++i) {
      if (!asks[of_.bits(i)] || of_.undrawable(i)) continue;
      const auto item = static_cast<std::uint32_t>(i);
      if (!anything_stored_ || of_.elements(i) == 0) {
        undrawn_.push_back(item);
        continue;
      }
      if (grouped_) {
        const std::uint32_t its = of_.group(i);
        if (first || its != group) slot_begin_.push_back(static_cast<std::uint32_t>(asked_.size()));
        first = false;
        group = its;
      }
      asked_.push_back(item);
      add_elements(i, static_cast<std::uint32_t>((grouped_ ? slot_begin_ : asked_).size() - 1));
    }
    push(step);
  }

  void store_owner(std::size_t from, std::size_t to) {
    const Step step{Verb::store, static_cast<std::uint32_t>(pass_.draws.size()), 0};
    const bool(&stores)[4] = of_.rule.stores[of_.ask == kL];
    for (std::size_t i = from; i < to; ++i) {
      if (!stores[of_.bits(i)]) continue;
      if (of_.undrawable(i)) {
        pass_.draws.push_back({kEverywhere, 0});
      } else {
        add_elements(i, 0);
      }
    }
    push(step);
  }

  void add_elements(std::size_t item, std::uint32_t slot) {
    const std::uint32_t* const first = of_.drawables.first.data() + item;
    for (std::uint32_t e = first[0]; e < first[1]; ++e) pass_.draws.push_back({e, slot});
  }

  void push(Step step) {
    step.count = static_cast<std::uint32_t>(pass_.draws.size()) - step.first;
    if (step.count == 0) return;
    pass_.steps.push_back(step);
    if (step.verb == Verb::store) anything_stored_ = true;
  }

  const PassQuestion& of_;
  bool grouped_ = false;                   // false: each slot has one item
  std::vector<std::uint32_t> undrawn_;     // asked items that get the bit without being drawn
  std::vector<std::uint32_t> asked_;       // asked items that are drawn, in the order of slots
  std::vector<std::uint32_t> slot_begin_;  // if grouped: per slot, its first index in asked_
  bool anything_stored_ = false;
  Pass pass_;
};

}  // namespace

void CullState::set(std::uint32_t triangle, Bit bit) {
  if (bits[triangle] & bit) return;
  bits[triangle] |= bit;
  ++changes[bit == kL];
  if (bits[triangle] == kCulled) ++culled;
}

void CullState::remove_culled() {
  std::erase_if(live, [&](std::uint32_t t) { return bits[t] == kCulled; });
}

void CullState::clear_bits() {
  for (const std::uint32_t t : live) bits[t] = 0;
}

VisitItems::VisitItems(const CullState& state) : items(state.live) {
  for (std::size_t i = 0; i < items.size(); ++i) {
    if (i == 0 || state.owner[items[i]] != state.owner[items[i - 1]])
      owner_begin.push_back(static_cast<std::uint32_t>(i));
  }
  owner_begin.push_back(static_cast<std::uint32_t>(items.size()));
}

void VisitItems::take_drawables(const Drawables& drawables) {
  if (!drawables.undrawable.empty()) undrawable.resize(items.size());
  for (const std::uint32_t item : drawables.undrawable) undrawable[item] = 1;
  open.assign(owner_begin.size() - 1, {});
  const std::uint32_t* const first = drawables.first.data();
  for (std::size_t o = 0; o < open.size(); ++o) {
    const std::uint32_t from = owner_begin[o], to = owner_begin[o + 1];
    open[o].elements = first[to] - first[from];
    for (std::uint32_t i = from; i < to; ++i) open[o].drawn += first[i + 1] > first[i];
    for (std::uint32_t i = from; i < to && !undrawable.empty(); ++i)
      open[o].undrawable += undrawable[i];
  }
}

void VisitItems::close(std::uint32_t item, const Drawables& drawables) {
  const auto after = std::upper_bound(owner_begin.begin(), owner_begin.end(), item);
  OpenItems& its = open[static_cast<std::size_t>(after - owner_begin.begin() - 1)];
  const std::uint32_t elements = drawables.first[item + 1] - drawables.first[item];
  its.elements -= elements;
  its.drawn -= elements > 0;
}

PassCost run_pass(CullState& state, VisitItems& items, const Drawables& drawables, Bit ask,
                  const PassRule& rule, const Level& level, bool touching, Canvas& canvas) {
  const PassQuestion question{state, items, drawables, ask, rule, level};
  PassBuilder builder(question);
  Pass& pass = builder.pass();
  pass.touching = touching;
  const std::vector<std::uint8_t> seen =
      pass.steps.empty() ? std::vector<std::uint8_t>() : canvas.run(pass);
  builder.for_unseen(seen, [&](std::uint32_t item) {
    const std::uint32_t triangle = items.items[item];
    state.set(triangle, ask);
    if (state.bits[triangle] == kCulled) items.close(item, drawables);
  });
  return builder.cost();
}

// Returns the same cost as a PassBuilder with kPlainRule, but makes no lists.
PassCost plain_cost(const CullState& state, const VisitItems& items, const Drawables& drawables,
                    Bit ask, const Level& level) {
  const PassQuestion of{state, items, drawables, ask, kPlainRule, level};
  PassCost cost;            // cost up to the last query
  std::uint64_t drawn = 0;  // number of elements so far
  bool anything_stored = false;
  std::size_t next = ask == kF ? 0 : items.open.size();
  for_owners(items, ask, [&](std::size_t from, std::size_t to) {
    const OpenItems& open = items.open[ask == kF ? next++ : --next];
    std::uint64_t groups = level.group ? open.drawn > 0 : open.drawn;
    if (level.group && level.size != kObjectLevel) {
      groups = 0;
      std::uint64_t last = UINT64_MAX;
      for (std::size_t i = from; i < to; ++i) {
        if (of.bits(i) == kCulled || of.elements(i) == 0) continue;
        groups += last != of.group(i);
        last = of.group(i);
      }
    }
    if (anything_stored) {
      cost.queries += groups;
      drawn += open.elements;
      if (open.elements > 0) cost.draws = drawn;
    }
    // Plain CULLIDE stores every triangle that it asks, and undrawable triangles.
    drawn += open.elements + open.undrawable;
    anything_stored = anything_stored || open.elements + open.undrawable > 0;
  });
  return cost;
}

}  // namespace farcull
