// Numbers are converted by <charconv>, which no locale changes.
#include "experiments/suite/words.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <utility>

#include "core/base/error.h"

namespace farcull {

std::string_view take_word(std::string_view& line) {
  constexpr std::string_view kBlanks = " \t\r";
  line.remove_prefix(std::min(line.find_first_not_of(kBlanks), line.size()));
  const std::string_view word = line.substr(0, line.find_first_of(kBlanks));
  line.remove_prefix(word.size());
  return word;
}

std::optional<double> parse_hexadecimal(std::string_view word) {
  const bool negative = word.starts_with('-');
  if (negative) word.remove_prefix(1);
  if (!word.starts_with("0x")) return std::nullopt;
  word.remove_prefix(2);
  // from_chars would take a second sign, and the names of what is not finite.
  if (word.empty() || word[0] == '-' || word[0] == 'i' || word[0] == 'n') return std::nullopt;
  double value = 0;
  const char* const end = word.data() + word.size();
  const auto [rest, code] = std::from_chars(word.data(), end, value, std::chars_format::hex);
  if (code != std::errc() || rest != end || !std::isfinite(value)) return std::nullopt;
  return negative ? -value : value;
}

void append_hexadecimal(std::string& text, double value) {
  std::array<char, 40> buffer;
  if (std::signbit(value)) text += '-';
  const auto [end, code] = std::to_chars(buffer.data(), buffer.data() + buffer.size(),
                                         std::abs(value), std::chars_format::hex);
  text += "0x";
  text.append(buffer.data(), end);
}

std::string decimal(double value) {
  std::array<char, 40> buffer;
  const auto [end, code] = std::to_chars(buffer.data(), buffer.data() + buffer.size(), value);
  return {buffer.data(), end};
}

Lines::Lines(std::string_view text, std::string name) : rest_(text), name_(std::move(name)) {
  if (text.empty() || text.back() != '\n') {
    throw Error(name_, "the file does not end with a newline, so its end may be missing",
                "write or download it again");
  }
}

bool Lines::next(std::string_view& line) {
  if (rest_.empty()) return false;
  const std::size_t end = rest_.find('\n');
  line = rest_.substr(0, end);
  rest_.remove_prefix(end + 1);
  ++number_;
  return true;
}

void Lines::fail(const std::string& reason, const std::string& remedy) const {
  throw Error(name_, reason, remedy, number_);
}

}  // namespace farcull
