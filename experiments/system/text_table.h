// Text for people: aligned tables, colours on a terminal, and words quoted for a shell.
#pragma once

#include <algorithm>
#include <cctype>
#include <cstddef>
#include <cstdio>
#include <utility>

#include "core/base/text.h"

namespace farcull {

/// Returns the width of text for people, in characters: the width of the terminal, but at least 40.
/// If the stream is a file or a pipe, returns 100, so that the text is the same on every machine.
std::size_t text_columns(std::FILE* stream = stdout);

/// Breaks lines at blanks, so that each line has at most `columns` characters. A longer word stays
/// whole. A continuation line is indented by the leading blanks of the first line. If a label and
/// two blanks follow, the indentation includes the label. The indentation is at least `indent`.
std::string wrapped(const std::string& text, std::size_t columns = text_columns(),
                    std::size_t indent = 0);

/// Rows of cells. Each column is as wide as its widest cell. If the table is then too wide, the
/// widest left-aligned column is wrapped. If the table is still too wide, the remaining columns go
/// into further tables below. Each of these tables repeats the columns that name a row.
class Table {
 public:
  /// One letter per column: 'l' aligns to the left, 'r' to the right. keys: number of leading
  /// columns that name a row.
  explicit Table(std::string_view alignment, std::size_t keys = 1)
      : alignment_(alignment), keys_(std::min(keys, alignment.size())) {}
  /// A row of one cell is a note on the row above, if the table has several columns.
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

/// Quotes a word for a POSIX shell. A word of harmless characters stays unchanged.
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
