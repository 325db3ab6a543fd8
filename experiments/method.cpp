#include "experiments/method.h"

#include <array>
#include <vector>

#include "core/error.h"

namespace farcull {
namespace {

constexpr std::array kMethods = {Method::far,       Method::cullide,   Method::quick_cullide,
                                 Method::s_cullide, Method::i_collide, Method::far_pairs,
                                 Method::exact};

}  // namespace

std::span<const Method> all_methods() { return kMethods; }

std::string to_string(Method method) {
  switch (method) {
    case Method::far:
      return "far";
    case Method::cullide:
      return "cullide";
    case Method::quick_cullide:
      return "quick-cullide";
    case Method::s_cullide:
      return "s-cullide";
    case Method::i_collide:
      return "i-collide";
    case Method::far_pairs:
      return "far-pairs";
    case Method::exact:
      return "exact";
  }
  return "";
}

Method parse_method(const std::string& name, const std::string& option) {
  for (const Method method : kMethods) {
    if (name == to_string(method)) return method;
  }
  throw Error(option, "'" + name + "' is no method", "give " + method_names());
}

std::string method_names(bool (*can)(Method)) {
  std::vector<std::string> names;
  for (const Method method : kMethods) {
    if (can == nullptr || can(method)) names.push_back(to_string(method));
  }
  std::string text;
  for (std::size_t i = 0; i < names.size(); ++i)
    text += (i == 0 ? "" : i + 1 < names.size() ? ", " : " or ") + names[i];
  return text;
}

bool draws(Method method) {
  return method == Method::far || method == Method::cullide || method == Method::quick_cullide ||
         method == Method::s_cullide;
}

bool tests_self(Method method) {
  return method == Method::s_cullide || method == Method::i_collide ||
         method == Method::far_pairs || method == Method::exact;
}

bool tests_self_alone(Method method) { return method == Method::s_cullide; }

bool takes_clearance(Method method) {
  return method == Method::far_pairs || method == Method::exact;
}

}  // namespace farcull
