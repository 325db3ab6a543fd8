// Builds a pass from the state of the run, runs it on the canvas, and turns its answers into bits.
#include "core/cull/pass.h"

#include <algorithm>

namespace farcull {
namespace {

// Calls visit(from, to) for the items of each owner, in the order of the pass that asks `ask`.
template <class Visit>
void for_owners(const VisitItems& items, Bit ask, const Visit& visit) {
  const std::vector<std::uint32_t>& begin = items.owner_begin;
  if (ask == kF) {
    for (std::size_t o = 0; o + 1 < begin.size(); ++o) visit(begin[o], begin[o + 1]);
  } else {
    for (std::size_t o = begin.size(); o-- > 1;) visit(begin[o - 1], begin[o]);
  }
}

// Says which items a pass asks and stores. It only reads the state.
struct PassQuestion {
  const CullState& state;
  const VisitItems& visit;
  const Drawables& drawables;
  Bit ask;
  const PassRule& rule;
  const Level& level;

  std::uint8_t bits(std::size_t item) const { return state.bits[visit.items[item]]; }
  bool asks(std::size_t item) const { return rule.asks[ask == kL][bits(item)]; }
  bool stores(std::size_t item) const { return rule.stores[ask == kL][bits(item)]; }
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

// Builds one pass.
class PassBuilder {
 public:
  explicit PassBuilder(const PassQuestion& of) : of_(of) {
    pass_.draws.reserve(2 * of.drawables.elements());
    asked_.reserve(of.visit.items.size());
    for_owners(of.visit, of.ask, [&](std::size_t from, std::size_t to) {
      ask_owner(from, to);
      const bool last = of.ask == kF ? to == of.visit.items.size() : from == 0;
      if (!last) store_owner(from, to);  // no query would read the last store
    });
    while (!pass_.steps.empty() && pass_.steps.back().verb == Verb::store) {
      pass_.draws.resize(pass_.steps.back().first);
      pass_.steps.pop_back();
    }
    pass_.slots = static_cast<std::uint32_t>(slot_begin_.size());
    slot_begin_.push_back(asked_.size());
  }

  Pass& pass() { return pass_; }
  PassCost cost() const { return {pass_.draws.size(), pass_.slots}; }

  // Calls clear(triangle) for all that the pass did not see.
  template <class Clear>
  void for_unseen(const std::vector<std::uint8_t>& seen, const Clear& clear) const {
    for (const std::uint32_t item : undrawn_) clear(of_.visit.items[item]);
    for (std::size_t slot = 0; slot < pass_.slots; ++slot) {
      if (seen[slot]) continue;
      for (std::size_t i = slot_begin_[slot]; i < slot_begin_[slot + 1]; ++i)
        clear(of_.visit.items[asked_[i]]);
    }
  }

 private:
  void ask_owner(std::size_t from, std::size_t to) {
    const Step step{Verb::ask, static_cast<std::uint32_t>(pass_.draws.size()), 0};
    std::uint32_t group = 0;
    bool first = true;
    for (std::size_t i = from; i < to; ++i) {
      if (of_.undrawable(i) || !of_.asks(i)) continue;
      const auto item = static_cast<std::uint32_t>(i);
      if (!anything_stored_ || of_.elements(i) == 0) {
        undrawn_.push_back(item);
        continue;
      }
      const std::uint32_t its = of_.group(i);
      if (first || its != group) slot_begin_.push_back(asked_.size());
      first = false;
      group = its;
      asked_.push_back(item);
      add_elements(i, static_cast<std::uint32_t>(slot_begin_.size() - 1));
    }
    push(step);
  }

  void store_owner(std::size_t from, std::size_t to) {
    const Step step{Verb::store, static_cast<std::uint32_t>(pass_.draws.size()), 0};
    for (std::size_t i = from; i < to; ++i) {
      if (!of_.stores(i)) continue;
      if (of_.undrawable(i)) {
        pass_.draws.push_back({kEverywhere, 0});
      } else {
        add_elements(i, 0);
      }
    }
    push(step);
  }

  void add_elements(std::size_t item, std::uint32_t slot) {
    const std::vector<std::uint32_t>& first = of_.drawables.first;
    for (std::uint32_t e = first[item]; e < first[item + 1]; ++e) pass_.draws.push_back({e, slot});
  }

  void push(Step step) {
    step.count = static_cast<std::uint32_t>(pass_.draws.size()) - step.first;
    if (step.count == 0) return;
    pass_.steps.push_back(step);
    if (step.verb == Verb::store) anything_stored_ = true;
  }

  const PassQuestion& of_;
  std::vector<std::uint32_t> undrawn_;   // items that get the bit without being drawn
  std::vector<std::uint32_t> asked_;     // items, slot after slot
  std::vector<std::size_t> slot_begin_;  // per slot: its first index in asked_
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

void VisitItems::mark_undrawable(const Drawables& drawables) {
  if (drawables.undrawable.empty()) return;
  undrawable.resize(items.size());
  for (const std::uint32_t item : drawables.undrawable) undrawable[item] = 1;
}

PassCost run_pass(CullState& state, const VisitItems& items, const Drawables& drawables, Bit ask,
                  const PassRule& rule, const Level& level, bool touching, Canvas& canvas) {
  const PassQuestion question{state, items, drawables, ask, rule, level};
  PassBuilder builder(question);
  Pass& pass = builder.pass();
  pass.touching = touching;
  const std::vector<std::uint8_t> seen =
      pass.steps.empty() ? std::vector<std::uint8_t>() : canvas.run(pass);
  builder.for_unseen(seen, [&](std::uint32_t triangle) { state.set(triangle, ask); });
  return builder.cost();
}

// The cost of a pass of plain CULLIDE: counts as PassBuilder does, and makes no lists.
PassCost plain_cost(const CullState& state, const VisitItems& items, const Drawables& drawables,
                    Bit ask, const Level& level) {
  const PassQuestion of{state, items, drawables, ask, kPlainRule, level};
  PassCost cost;            // up to the last query
  std::uint64_t drawn = 0;  // elements so far
  bool anything_stored = false;
  for_owners(items, ask, [&](std::size_t from, std::size_t to) {
    // No branch for a single item, because a visit counts all its items often.
    std::uint64_t elements = 0, everywhere = 0, groups = 0, group = UINT64_MAX;
    for (std::size_t i = from; i < to; ++i) {
      const std::uint32_t open = of.bits(i) != kCulled;
      const std::uint64_t its = of.group(i);
      const bool counts = open * of.elements(i) > 0;
      elements += open * of.elements(i);
      groups += counts && its != group;
      group = counts ? its : group;
    }
    for (std::size_t i = from; i < to && !items.undrawable.empty(); ++i)
      everywhere += of.undrawable(i) && of.asks(i);
    if (anything_stored) {
      cost.queries += groups;
      drawn += elements;
      if (elements > 0) cost.draws = drawn;
    }
    drawn += elements + everywhere;  // plain CULLIDE stores what it asks
    anything_stored = anything_stored || elements + everywhere > 0;
  });
  return cost;
}

}  // namespace farcull
