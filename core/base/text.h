// Reads numbers from text, formats numbers for people, and suggests corrections of misspelt words.
// Also determines whether a stream is a terminal, and how wide the terminal is.
#pragma once

#include <algorithm>
#include <charconv>
#include <cstdint>
#include <cstdio>
#include <optional>
#include <string>
#include <string_view>
#include <system_error>
#include <vector>

namespace farcull {

/// Removes the number at the beginning of `text` and returns it. The number is decimal, as in
/// std::from_chars: no leading space and no '+'. Returns empty and leaves `text` unchanged if
/// `text` begins with no number, or if T cannot hold the number.
template <class T>
std::optional<T> take_number(std::string_view& text) {
  T value{};
  const auto [end, code] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (code != std::errc()) return std::nullopt;
  text.remove_prefix(static_cast<std::size_t>(end - text.data()));
  return value;
}

/// Parses the whole `text` as one number. Returns empty if `text` is not a number of type T.
template <class T>
std::optional<T> parse_number(std::string_view text) {
  const std::optional<T> value = take_number<T>(text);
  return text.empty() ? value : std::nullopt;
}

/// Returns the word in `known` that `word` probably misspells, or empty. The result differs from
/// `word` by at most two edits, and by fewer edits than half the number of letters in `word`. Case
/// is ignored. An edit inserts, deletes or replaces a letter, or swaps two adjacent letters.
std::string likely_word(const std::string& word, const std::vector<std::string>& known);
/// Returns "did you mean NAME? ", or an empty text if the name is empty.
inline std::string did_you_mean(const std::string& name) {
  return name.empty() ? "" : "did you mean " + name + "? ";
}

/// Returns 1234567 as "1,234,567".
inline std::string grouped(std::uint64_t n) {
  std::string out = std::to_string(n);
  for (std::size_t at = out.size(); at > 3;) out.insert(at -= 3, 1, ',');
  return out;
}

/// Returns the shortest decimal text that parses to the same double. Ignores the locale.
inline std::string shortest(double value) {
  char text[32];
  return {text, std::to_chars(text, text + sizeof text, value).ptr};
}

/// Replaces each control character, such as a newline, by a space.
inline std::string one_line(std::string text) {
  std::ranges::replace_if(
      text, [](unsigned char c) { return c < ' '; }, ' ');
  return text;
}

/// Returns the text with '?' for each byte outside printable ASCII. If the text is longer than
/// `most` bytes, cuts the text there and adds "...".
inline std::string printable(std::string_view text, std::size_t most) {
  std::string out;
  for (const char c : text.substr(0, most)) out += c >= ' ' && c <= '~' ? c : '?';
  return text.size() > most ? out + "..." : out;
}

/// Returns the reason in an error message of nlohmann-json. Removes a prefix such as
/// "[json.exception.parse_error.101] parse error at line 1, column 2: ".
inline std::string_view json_fault(std::string_view message) {
  for (const std::string_view mark : {"] ", "column "}) {
    const std::size_t found = message.find(mark);
    if (found != message.npos) message.remove_prefix(found + mark.size());
  }
  const std::size_t number = message.find_first_not_of("0123456789");
  if (number != 0 && number != message.npos && message.substr(number, 2) == ": ")
    message.remove_prefix(number + 2);
  return message;
}

/// Returns the number with the word `one` or `many`, such as "1 pair" or "1,234 pairs".
inline std::string counted(std::uint64_t n, const std::string& one, const std::string& many) {
  return grouped(n) + " " + (n == 1 ? one : many);
}

/// Returns true if the stream is a terminal, and false for anything else or a closed stream.
bool is_terminal(std::FILE* stream);

/// Returns the terminal's width in columns, or 0 if the width is unknown or there is no terminal.
unsigned terminal_columns(std::FILE* stream);

}  // namespace farcull
