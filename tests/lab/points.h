// The key of a study's point as texts.
#pragma once

#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

#include "experiments/studies/point.h"

namespace farcull {

/// The values of a key as text, in the order of its fields; empty if a column does not apply.
inline std::vector<std::string> axis_values(const PointKey& key) {
  std::vector<std::string> out;
  key.fields([&](std::string_view name, const auto& value) {
    if constexpr (std::is_convertible_v<decltype(value), std::string>) {
      out.push_back(value);
    } else if constexpr (requires { value.has_value(); }) {
      out.push_back(column_text(value));
    } else {
      const bool none = std::cmp_equal(value, name == "frame" ? -1 : 0);
      out.push_back(none ? "" : std::to_string(value));
    }
  });
  return out;
}

}  // namespace farcull
