// Text for people to read: aligned tables, colours on a terminal, and words of command lines that
// are shown to be typed again.
#pragma once

#include <algorithm>
#include <cctype>
#include <cstddef>
#include <cstdio>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "core/base/text.h"

namespace farcull {

/// Columns for text that people read: those of the stream's terminal, but at least 40; 100 where it
/// is no terminal, so that a file or a pipe gets the same text everywhere.
std::size_t text_columns(std::FILE* stream = stdout);

/// Breaks lines at blanks, so that each has at most `columns` if its words allow it. The rest of a
/// line stands below its text: after its leading blanks and a label that two blanks end, or after
/// `indent` blanks if these are more.
std::string wrapped(const std::string& text, std::size_t columns = text_columns(),
                    std::size_t indent = 0);

/// Rows of cells; each column is as wide as its widest cell, and the table as `columns` allow. If
/// it is wider, the widest left column is wrapped. If that is not enough, the columns that do not
/// fit stand in a second table below, after the first column again.
class Table {
 public:
  /// One letter a column: 'l' to the left, 'r' to the right.
  explicit Table(std::string_view alignment) : alignment_(alignment) {}
  /// A row of one cell, in a table of several columns, is a note below the row before.
  void add(std::vector<std::string> cells) { rows_.push_back(std::move(cells)); }
  /// Two blanks between columns, none at the ends of lines.
  std::string text(std::size_t columns = text_columns()) const;

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
