// Three bytes become four digits of six bits each; the last group is padded with '='.
#include "core/base/base64.h"

#include <algorithm>
#include <array>
#include <string_view>

namespace farcull {
namespace {

constexpr std::string_view kDigits =
    "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";

}  // namespace

std::string to_base64(std::span<const std::uint8_t> bytes) {
  std::string out;
  out.reserve((bytes.size() + 2) / 3 * 4);
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    const std::size_t have = std::min<std::size_t>(3, bytes.size() - i);
    std::uint32_t word = 0;
    for (std::size_t k = 0; k < 3; ++k) word = word << 8 | (k < have ? bytes[i + k] : 0u);
    for (std::size_t k = 0; k < 4; ++k) out += k <= have ? kDigits[word >> (18 - 6 * k) & 63] : '=';
  }
  return out;
}

std::optional<std::vector<std::uint8_t>> from_base64(const std::string& text) {
  constexpr std::uint8_t kNone = 64;
  std::array<std::uint8_t, 256> value;
  value.fill(kNone);
  for (std::uint8_t v = 0; v < 64; ++v) value[static_cast<unsigned char>(kDigits[v])] = v;
  if (text.size() % 4 != 0) return {};
  std::size_t padding = 0;
  while (padding < 2 && padding < text.size() && text[text.size() - 1 - padding] == '=') ++padding;
  std::vector<std::uint8_t> out;
  out.reserve(text.size() / 4 * 3);
  for (std::size_t i = 0; i < text.size(); i += 4) {
    const std::size_t digits = i + 4 == text.size() ? 4 - padding : 4;
    std::uint32_t word = 0;
    for (std::size_t k = 0; k < 4; ++k) {
      const std::uint8_t v = k < digits ? value[static_cast<unsigned char>(text[i + k])] : 0;
      if (v == kNone) return {};
      word = word << 6 | v;
    }
    if ((word & (digits == 2 ? 0xffffu : digits == 3 ? 0xffu : 0u)) != 0) return {};
    for (std::size_t k = 0; k + 1 < digits; ++k)
      out.push_back(static_cast<std::uint8_t>(word >> (16 - 8 * k)));
  }
  return out;
}

}  // namespace farcull
