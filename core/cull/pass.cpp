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

// One pass in the making. It only reads the state.
class PassBuilder {
 public:
  PassBuilder(const CullState& state, std::span<const std::uint32_t> items,
              const Drawables& drawables, Bit ask, const PassRule& rule, const Level& level)
      : state_(state), items_(items), drawables_(drawables), ask_(ask), rule_(rule), level_(level) {
    undrawable_.resize(items.size());
    for (const std::uint32_t item : drawables.undrawable) undrawable_[item] = 1;
    for_owners(state, items, ask, [&](std::size_t from, std::size_t to) {
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
    for (const std::uint32_t item : undrawn_) clear(items_[item]);
    for (std::size_t slot = 0; slot < pass_.slots; ++slot) {
      if (seen[slot]) continue;
      for (std::size_t i = slot_begin_[slot]; i < slot_begin_[slot + 1]; ++i)
        clear(items_[asked_[i]]);
    }
  }

 private:
  bool asks(std::size_t item) const { return rule_.asks[ask_ == kL][state_.bits[items_[item]]]; }
  bool stores(std::size_t item) const {
    return rule_.stores[ask_ == kL][state_.bits[items_[item]]];
  }

  void ask_owner(std::size_t from, std::size_t to) {
    const Step step{Verb::ask, static_cast<std::uint32_t>(pass_.draws.size()), 0};
    std::uint32_t group = 0;
    bool first = true;
    for (std::size_t i = from; i < to; ++i) {
      if (undrawable_[i] || !asks(i)) continue;
      const auto item = static_cast<std::uint32_t>(i);
      if (!anything_stored_ || drawables_.first[i] == drawables_.first[i + 1]) {
        undrawn_.push_back(item);
        continue;
      }
      const std::uint32_t of = level_.group ? (*level_.group)[items_[i]] : items_[i];
      if (first || of != group) slot_begin_.push_back(asked_.size());
      first = false;
      group = of;
      asked_.push_back(item);
      add_elements(i, static_cast<std::uint32_t>(slot_begin_.size() - 1));
    }
    push(step);
  }

  void store_owner(std::size_t from, std::size_t to) {
    const Step step{Verb::store, static_cast<std::uint32_t>(pass_.draws.size()), 0};
    for (std::size_t i = from; i < to; ++i) {
      if (!stores(i)) continue;
      if (undrawable_[i]) {
        pass_.draws.push_back({kEverywhere, 0});
      } else {
        add_elements(i, 0);
      }
    }
    push(step);
  }

  void add_elements(std::size_t item, std::uint32_t slot) {
    for (std::uint32_t e = drawables_.first[item]; e < drawables_.first[item + 1]; ++e)
      pass_.draws.push_back({e, slot});
  }

  void push(Step step) {
    step.count = static_cast<std::uint32_t>(pass_.draws.size()) - step.first;
    if (step.count == 0) return;
    pass_.steps.push_back(step);
    if (step.verb == Verb::store) anything_stored_ = true;
  }

  const CullState& state_;
  std::span<const std::uint32_t> items_;
  const Drawables& drawables_;
  Bit ask_;
  const PassRule& rule_;
  const Level& level_;
  std::vector<std::uint8_t> undrawable_;
  std::vector<std::uint32_t> undrawn_;   // items that get the bit without being drawn
  std::vector<std::uint32_t> asked_;     // items, slot after slot
  std::vector<std::size_t> slot_begin_;  // into asked_
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
  PassBuilder builder(state, items, drawables, ask, rule, level);
  Pass& pass = builder.pass();
  pass.touching = touching;
  const std::vector<std::uint8_t> seen =
      pass.steps.empty() ? std::vector<std::uint8_t>() : canvas.run(pass);
  builder.for_unseen(seen, [&](std::uint32_t triangle) { state.set(triangle, ask); });
  return builder.cost();
}

PassCost plain_cost(const CullState& state, std::span<const std::uint32_t> items,
                    const Drawables& drawables, Bit ask, const Level& level) {
  return PassBuilder(state, items, drawables, ask, kPlainRule, level).cost();
}

}  // namespace farcull
