// Text for people to read: aligned tables, colours on a terminal, and words of command lines that
// are shown to be typed again.
#pragma once

#include <algorithm>
#include <cctype>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "core/base/text.h"

namespace farcull {

/// Rows of cells; each column is as wide as its widest cell.
class Table {
 public:
  /// One letter a column: 'l' to the left, 'r' to the right.
  explicit Table(std::string_view alignment) : alignment_(alignment) {}
  void add(std::vector<std::string> cells) { rows_.push_back(std::move(cells)); }
  /// Two blanks between columns, none at the ends of lines.
  std::string text() const;

 private:
  std::string alignment_;
  std::vector<std::vector<std::string>> rows_;
};

enum class Colour { good, bad, doubtful };  // green, red, yellow

/// Whether a stream (STDOUT_FILENO, STDERR_FILENO) takes colours: a terminal that is not dumb, and
/// NO_COLOR is unset or empty (https://no-color.org).
bool takes_colour(int stream);

/// The text in bold and in the colour if the stream takes colours; else unchanged.
std::string coloured(const std::string& text, Colour colour, int stream);

/// The word as a POSIX shell reads it back: unchanged if it is plain, else in single quotes.
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
