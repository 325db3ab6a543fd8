// The table of methods: the one place that lists them.
#include <array>

#include "experiments/method/cullide.h"
#include "experiments/method/exact.h"
#include "experiments/method/far_pairs.h"
#include "experiments/method/i_collide.h"
#include "experiments/method/method.h"
// The header of a new method goes here.

namespace farcull {
namespace {

constexpr std::array kTable = {
    Traits{.method = Method::far,
           .name = "far",
           .promises = Promises::at_budget_radius,
           .draws = true,
           .fattens = true,
           .quick = true,
           .tests_self = true,
           .plan = plan_drawing,
           .find = find_by_drawing},
    Traits{.method = Method::cullide,
           .name = "cullide",
           .draws = true,
           .plan = plan_drawing,
           .find = find_by_drawing},
    Traits{.method = Method::quick_cullide,
           .name = "quick-cullide",
           .draws = true,
           .quick = true,
           .plan = plan_drawing,
           .find = find_by_drawing},
    Traits{.method = Method::s_cullide,
           .name = "s-cullide",
           .draws = true,
           .quick = true,
           .tests_self = true,
           .tests_self_alone = true,
           .plan = plan_drawing,
           .find = find_by_drawing},
    Traits{.method = Method::i_collide,
           .name = "i-collide",
           .promises = Promises::always,
           .tests_self = true,
           .plan = plan_sweep,
           .find = find_by_sweep},
    Traits{.method = Method::far_pairs,
           .name = "far-pairs",
           .promises = Promises::always,
           .chooses_views = true,
           .tests_self = true,
           .takes_clearance = true,
           .plan = plan_far_pairs,
           .find = find_far_pairs},
    Traits{.method = Method::exact,
           .name = "exact",
           .culls = false,
           .tests_self = true,
           .takes_clearance = true,
           .plan = plan_exact,
           .find = find_exact},
    // A new method goes here.
};

constexpr auto kMethods = [] {
  std::array<Method, kTable.size()> methods{};
  for (std::size_t i = 0; i < kTable.size(); ++i) methods[i] = kTable[i].method;
  return methods;
}();

// traits() looks an entry up by the value of its method.
static_assert([] {
  for (std::size_t i = 0; i < kTable.size(); ++i) {
    if (static_cast<std::size_t>(kTable[i].method) != i) return false;
  }
  return true;
}());

}  // namespace

const Traits& traits(Method method) { return kTable[static_cast<std::size_t>(method)]; }

std::span<const Method> all_methods() { return kMethods; }

}  // namespace farcull
