// Numbers as people read them.
#pragma once

#include <cstdint>
#include <string>

namespace farcull {

/// 1234567 as 1,234,567.
inline std::string grouped(std::uint64_t n) {
  const std::string digits = std::to_string(n);
  std::string out;
  for (std::size_t i = 0; i < digits.size(); ++i) {
    if (i > 0 && (digits.size() - i) % 3 == 0) out += ',';
    out += digits[i];
  }
  return out;
}

/// A number and what agrees with it: "1 pair", "1,234 pairs", "1 triangle is left".
inline std::string counted(std::uint64_t n, const std::string& one, const std::string& many) {
  return grouped(n) + " " + (n == 1 ? one : many);
}

}  // namespace farcull
