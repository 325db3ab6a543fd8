// Names of methods.
#include "experiments/method/method.h"

#include <vector>

#include "core/base/error.h"

namespace farcull {

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
