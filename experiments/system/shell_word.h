// Words of command lines that are shown to be typed again.
#pragma once

#include <algorithm>
#include <cctype>
#include <string>
#include <string_view>

namespace farcull {

/// The word as a POSIX shell reads it back: as it is where it is plain, else in single quotes.
inline std::string quoted(const std::string& word) {
  const auto plain = [](char c) {
    return std::isalnum(static_cast<unsigned char>(c)) != 0 ||
           std::string_view("-_./,:@%+=").find(c) != std::string_view::npos;
  };
  if (!word.empty() && std::all_of(word.begin(), word.end(), plain)) return word;
  std::string out = "'";
  for (const char c : word) out += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return out + "'";
}

}  // namespace farcull
