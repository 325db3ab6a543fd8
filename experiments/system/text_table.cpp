// Lays out tables: the width of a column is that of its widest cell. Colours are ANSI escape
// sequences, which every terminal except a dumb one understands.
#include "experiments/system/text_table.h"

#include <unistd.h>

#include <algorithm>
#include <cstdlib>
#include <string_view>

namespace farcull {

namespace {

// The number of characters of a text in UTF-8: the bytes that are not continuation bytes.
std::size_t width_of(const std::string& text) {
  return static_cast<std::size_t>(
      std::ranges::count_if(text, [](unsigned char c) { return (c & 0xc0) != 0x80; }));
}

}  // namespace

std::string Table::text() const {
  std::vector<std::size_t> widths(alignment_.size(), 0);
  for (const auto& row : rows_) {
    for (std::size_t i = 0; i < row.size(); ++i) widths[i] = std::max(widths[i], width_of(row[i]));
  }
  std::string out;
  for (const auto& row : rows_) {
    std::string line;
    for (std::size_t i = 0; i < row.size(); ++i) {
      const std::string pad(widths[i] - width_of(row[i]), ' ');
      if (widths[i] == 0) continue;
      if (!line.empty()) line += "  ";
      line += alignment_[i] == 'l' ? row[i] + pad : pad + row[i];
    }
    line.erase(line.find_last_not_of(' ') + 1);
    out += line + "\n";
  }
  return out;
}

bool takes_colour(int stream) {
  const char* const unwanted = std::getenv("NO_COLOR");
  const char* const terminal = std::getenv("TERM");
  return ::isatty(stream) == 1 && (unwanted == nullptr || *unwanted == '\0') &&
         terminal != nullptr && std::string_view(terminal) != "dumb";
}

std::string coloured(const std::string& text, Colour colour, int stream) {
  if (!takes_colour(stream)) return text;
  const char* const number = colour == Colour::good ? "32" : colour == Colour::bad ? "31" : "33";
  return std::string("\033[1;") + number + "m" + text + "\033[0m";
}

}  // namespace farcull
