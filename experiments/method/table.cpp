// The table of methods: the one place that lists them.
#include "experiments/method/method.h"

#include <array>
#include <vector>

#include "core/base/error.h"
#include "experiments/method/methods.h"

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

std::string to_string(Method method) { return traits(method).name; }

Method parse_method(const std::string& name, const std::string& option) {
  for (const Method method : all_methods()) {
    if (name == to_string(method)) return method;
  }
  throw Error(option, "'" + name + "' is no method", "give " + method_names());
}

std::string method_names(const std::function<bool(const Traits&)>& can) {
  std::vector<std::string> names;
  for (const Method method : all_methods()) {
    if (!can || can(traits(method))) names.push_back(to_string(method));
  }
  std::string text;
  for (std::size_t i = 0; i < names.size(); ++i)
    text += (i == 0 ? "" : i + 1 < names.size() ? ", " : " or ") + names[i];
  return text;
}

}  // namespace farcull
