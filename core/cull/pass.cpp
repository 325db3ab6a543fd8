// A pass is built from the state of the run, run on the canvas, and its answers become bits.
#include "core/cull/pass.h"

#include <algorithm>

namespace farcull {
namespace {

// Calls visit(from, to) for the items of each owner, in the order of the pass that asks `ask`.
template <class Visit>
void for_owners(const CullState& state, std::span<const std::uint32_t> items, Bit ask,
                const Visit& visit) {
  const auto owner = [&](std::size_t i) { return state.owner[items[i]]; };
  if (ask == kF) {
    for (std::size_t from = 0, to = 0; from < items.size(); from = to) {
      while (to < items.size() && owner(to) == owner(from)) ++to;
      visit(from, to);
    }
  } else {
    for (std::size_t to = items.size(), from = to; to > 0; to = from) {
      while (from > 0 && owner(from - 1) == owner(to - 1)) --from;
      visit(from, to);
    }
  }
}

// Says which items a pass asks and stores. It only reads the state.
struct PassQuestion {
  const CullState& state;
  std::span<const std::uint32_t> items;
  const Drawables& drawables;
  Bit ask;
  const PassRule& rule;
  const Level& level;

  std::uint8_t bits(std::size_t item) const { return state.bits[items[item]]; }
  bool asks(std::size_t item) const { return rule.asks[ask == kL][bits(item)]; }
  bool stores(std::size_t item) const { return rule.stores[ask == kL][bits(item)]; }
  std::uint32_t elements(std::size_t item) const {
    return drawables.first[item + 1] - drawables.first[item];
  }
  std::uint32_t group(std::size_t item) const {
    return level.group ? (*level.group)[items[item]] : items[item];
  }
};

std::vector<std::uint8_t> undrawable_items(const PassQuestion& of) {
  if (of.drawables.undrawable.empty()) return {};
  std::vector<std::uint8_t> out(of.items.size());
  for (const std::uint32_t item : of.drawables.undrawable) out[item] = 1;
  return out;
}

// One pass in the making.
class PassBuilder {
 public:
  explicit PassBuilder(const PassQuestion& of) : of_(of), undrawable_(undrawable_items(of)) {
    pass_.draws.reserve(2 * of.drawables.elements());
    asked_.reserve(of.items.size());
    for_owners(of.state, of.items, of.ask, [&](std::size_t from, std::size_t to) {
      ask_owner(from, to);
      store_owner(from, to);
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
    for (const std::uint32_t item : undrawn_) clear(of_.items[item]);
    for (std::size_t slot = 0; slot < pass_.slots; ++slot) {
      if (seen[slot]) continue;
      for (std::size_t i = slot_begin_[slot]; i < slot_begin_[slot + 1]; ++i)
        clear(of_.items[asked_[i]]);
    }
  }

 private:
  void ask_owner(std::size_t from, std::size_t to) {
    const Step step{Verb::ask, static_cast<std::uint32_t>(pass_.draws.size()), 0};
    std::uint32_t group = 0;
    bool first = true;
    for (std::size_t i = from; i < to; ++i) {
      if (undrawable(i) || !of_.asks(i)) continue;
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
      if (undrawable(i)) {
        pass_.draws.push_back({kEverywhere, 0});
      } else {
        add_elements(i, 0);
      }
    }
    push(step);
  }

  bool undrawable(std::size_t item) const { return !undrawable_.empty() && undrawable_[item]; }

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
  std::vector<std::uint8_t> undrawable_;  // per item; empty: none is
  std::vector<std::uint32_t> undrawn_;    // items that get the bit without being drawn
  std::vector<std::uint32_t> asked_;      // items, slot after slot
  std::vector<std::size_t> slot_begin_;   // into asked_
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

PassCost run_pass(CullState& state, std::span<const std::uint32_t> items,
                  const Drawables& drawables, Bit ask, const PassRule& rule, const Level& level,
                  bool touching, Canvas& canvas) {
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
PassCost plain_cost(const CullState& state, std::span<const std::uint32_t> items,
                    const Drawables& drawables, Bit ask, const Level& level) {
  const PassQuestion of{state, items, drawables, ask, kPlainRule, level};
  const std::vector<std::uint8_t> undrawable = undrawable_items(of);
  PassCost cost;            // up to the last question
  std::uint64_t drawn = 0;  // so far
  bool anything_stored = false;
  for_owners(state, items, ask, [&](std::size_t from, std::size_t to) {
    std::uint64_t asked = 0, stored = 0, groups = 0;
    std::uint32_t group = 0;
    for (std::size_t i = from; i < to; ++i) {
      if (!of.asks(i)) continue;  // plain CULLIDE stores what it asks
      if (!undrawable.empty() && undrawable[i]) {
        ++stored;
        continue;
      }
      const std::uint32_t elements = of.elements(i);
      stored += elements;
      if (!anything_stored || elements == 0) continue;
      const std::uint32_t its = of.group(i);
      if (groups == 0 || its != group) ++groups;
      group = its;
      asked += elements;
    }
    cost.queries += groups;
    drawn += asked;
    if (asked > 0) cost.draws = drawn;
    drawn += stored;
    anything_stored = anything_stored || stored > 0;
  });
  return cost;
}

}  // namespace farcull
