// Numbers from text.
#pragma once

#include <charconv>
#include <optional>
#include <string_view>
#include <system_error>

namespace farcull {

/// The number at the beginning of `text`, which is removed from it. A decimal number as of
/// std::from_chars: no leading space and no '+'. Empty, and `text` unchanged, if it begins with no
/// number or T cannot hold the number.
template <class T>
std::optional<T> take_number(std::string_view& text) {
  T value{};
  const auto [end, code] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (code != std::errc()) return std::nullopt;
  text.remove_prefix(static_cast<std::size_t>(end - text.data()));
  return value;
}

/// The number that is all of `text`; empty where `text` is anything else.
template <class T>
std::optional<T> parse_number(std::string_view text) {
  const std::optional<T> value = take_number<T>(text);
  return text.empty() ? value : std::nullopt;
}

}  // namespace farcull
