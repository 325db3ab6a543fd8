// Breaks lines and lays out tables. Widths count UTF-8 characters.
#include "experiments/system/text_table.h"

#include <unistd.h>

#include <cstdlib>
#include <sstream>

namespace farcull {

namespace {

// Returns the number of UTF-8 characters: the bytes that are not continuation bytes.
std::size_t width_of(const std::string& text) {
  return static_cast<std::size_t>(
      std::ranges::count_if(text, [](unsigned char c) { return (c & 0xc0) != 0x80; }));
}

}  // namespace

std::size_t text_columns(std::FILE* stream) {
  const unsigned columns = terminal_columns(stream);
  return columns == 0 ? 100 : std::max(columns, 40u);
}

std::string wrapped(const std::string& text, std::size_t columns, std::size_t indent) {
  constexpr std::size_t kLongestLabel = 24;
  std::string out;
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line); out += line + "\n") {
    const std::size_t first = std::min(line.find_first_not_of(' '), line.size());
    const std::size_t gap = std::min(line.find("  ", first), line.size());
    const std::size_t after = line.find_first_not_of(' ', gap);
    const std::size_t below = std::max(indent, after <= kLongestLabel ? after : first);
    while (width_of(line) > columns) {
      std::size_t at = line.rfind(' ', columns);
      if (at == std::string::npos || at <= below) at = line.find(' ', std::max(columns, below + 1));
      if (at == std::string::npos) break;
      out += line.substr(0, line.find_last_not_of(' ', at) + 1) + "\n";
      line = std::string(below, ' ') + line.substr(at + 1);
    }
  }
  return out;
}

std::string Table::text(std::size_t columns) const {
  constexpr std::size_t kGap = 2, kLeastWrapped = 24, kNoteIndent = 6;
  const std::size_t count = alignment_.size();
  const auto is_note = [&](const auto& row) { return row.size() == 1 && count > 1; };
  std::vector<std::size_t> widths(count, 0);
  for (const auto& row : rows_) {
    for (std::size_t i = 0; i < row.size() && !is_note(row); ++i)
      widths[i] = std::max(widths[i], width_of(row[i]));
  }
  std::size_t total = 0, widest = count;
  for (std::size_t i = 0; i < count; ++i) {
    total += widths[i] == 0 ? 0 : widths[i] + (total == 0 ? 0 : kGap);
    if (alignment_[i] == 'l' && (widest == count || widths[i] > widths[widest])) widest = i;
  }
  if (total > columns && widest < count && total - widths[widest] + kLeastWrapped <= columns)
    widths[widest] = columns - (total - widths[widest]);

  std::string out;
  const auto add_row = [&](const std::vector<std::string>& row, std::size_t from, std::size_t to) {
    std::vector<std::vector<std::string>> cells(count);
    std::size_t height = 1;
    for (std::size_t i = 0; i < row.size(); ++i) {
      std::istringstream lines(i == widest ? wrapped(row[i], widths[i]) : row[i]);
      for (std::string line; std::getline(lines, line);) cells[i].push_back(line);
      height = std::max(height, cells[i].size());
    }
    for (std::size_t k = 0; k < height; ++k) {
      std::string line;
      for (std::size_t i = 0; i < row.size(); ++i) {
        if (widths[i] == 0 || (i >= keys_ && (i < from || i >= to))) continue;
        const std::string cell = k < cells[i].size() ? cells[i][k] : "";
        const std::string pad(widths[i] - std::min(widths[i], width_of(cell)), ' ');
        line += (line.empty() ? "" : std::string(kGap, ' ')) +
                (alignment_[i] == 'l' ? cell + pad : pad + cell);
      }
      line.erase(line.find_last_not_of(' ') + 1);
      out += line + "\n";
    }
  };
  for (std::size_t from = keys_, to = from;; from = to) {
    std::size_t used = 0;
    for (std::size_t i = 0; i < keys_; ++i)
      used += widths[i] == 0 ? 0 : widths[i] + (i > 0 ? kGap : 0);
    for (; to < count && (to == from || used + kGap + widths[to] <= columns || widths[to] == 0);
         ++to)
      used += widths[to] == 0 ? 0 : kGap + widths[to];
    if (from > keys_) out += "\n";
    for (const auto& row : rows_) {
      if (!is_note(row)) add_row(row, from, to);
      if (is_note(row) && from == keys_)
        out += wrapped(std::string(kNoteIndent, ' ') + row[0], columns);
    }
    if (to >= count) return out;
  }
}

std::string coloured(const std::string& text, Colour colour, int stream) {
  const char* const unwanted = std::getenv("NO_COLOR");
  const char* const terminal = std::getenv("TERM");
  if (::isatty(stream) != 1 || (unwanted != nullptr && *unwanted != '\0') || terminal == nullptr ||
      std::string_view(terminal) == "dumb") {
    return text;
  }
  const char* const number = colour == Colour::good ? "32" : colour == Colour::bad ? "31" : "33";
  return std::string("\033[1;") + number + "m" + text + "\033[0m";
}

}  // namespace farcull
