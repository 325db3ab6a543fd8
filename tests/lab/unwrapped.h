// Lines of a run's answer that are wrapped at 80 columns, each in one line again.
#pragma once

#include <regex>
#include <string>

namespace farcull::lab {

inline std::string unwrapped(const std::string& text) {
  return std::regex_replace(text, std::regex("\n {11}"), " ");
}

}  // namespace farcull::lab
