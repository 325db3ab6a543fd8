// Text for people: aligned tables, colours on a terminal, and quoted words of command lines.
#pragma once

#include <algorithm>
#include <cctype>
#include <cstddef>
#include <cstdio>
#include <utility>

#include "core/base/text.h"

namespace farcull {

/// Returns the width of text for people, in characters. For a terminal this is the terminal's
/// width, but at least 40. For a file or a pipe it is 100, so that their text is the same
/// everywhere.
std::size_t text_columns(std::FILE* stream = stdout);

/// Breaks lines at blanks, so that each line has at most `columns` characters if its words allow
/// it. A continuation line is indented to where the text of its line begins: after leading blanks,
/// and after a label followed by two blanks. The indentation is at least `indent`.
std::string wrapped(const std::string& text, std::size_t columns = text_columns(),
                    std::size_t indent = 0);

/// Rows of cells. Each column is as wide as its widest cell. If the table is then too wide, its
/// widest left-aligned column is wrapped. If that is not enough, the columns that do not fit are
/// put into further tables below. Each of these tables repeats the columns that name a row.
class Table {
 public:
  /// One letter per column: 'l' aligns to the left, 'r' to the right. keys: how many leading
  /// columns name a row.
  explicit Table(std::string_view alignment, std::size_t keys = 1)
      : alignment_(alignment), keys_(std::min(keys, alignment.size())) {}
  /// In a table of several columns, a row of one cell is a note on the row above it.
  void add(std::vector<std::string> cells) { rows_.push_back(std::move(cells)); }
  /// Returns the table as text: two blanks between columns, no blanks at the ends of lines.
  std::string text(std::size_t columns = text_columns()) const;

 private:
  std::string alignment_;
  std::size_t keys_;
  std::vector<std::vector<std::string>> rows_;
};

enum class Colour { good, bad, doubtful };  // green, red, yellow

/// Returns the text in bold and in the colour if the stream (STDOUT_FILENO, STDERR_FILENO) is a
/// terminal, TERM is set and not "dumb", and NO_COLOR is unset or empty (https://no-color.org).
std::string coloured(const std::string& text, Colour colour, int stream);

/// Quotes a word for a POSIX shell: unchanged if it is plain, else in single quotes.
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
