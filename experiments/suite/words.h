// Words of a line of text, and numbers in hexadecimal, for the files of a suite.
#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace farcull {

/// The next word of `line`, which is removed from it with the blanks before it. Empty at the end.
std::string_view take_word(std::string_view& line);

/// A finite double as C's %a prints it, such as 0x1.8p+1; empty for anything else.
std::optional<double> parse_hexadecimal(std::string_view word);
/// Appends a finite double as C's %a prints it, whatever the locale.
void append_hexadecimal(std::string& text, double value);

/// The shortest decimal text that is read back as the same finite double, whatever the locale.
std::string decimal(double value);

/// The lines of a text one by one, with their numbers.
class Lines {
 public:
  /// `name` stands for the file in errors. Throws Error where the text does not end with a newline.
  Lines(std::string_view text, std::string name);

  /// The next line without its newline; false at the end.
  bool next(std::string_view& line);
  long number() const { return number_; }  // of the line read last, from 1
  /// Throws Error naming the file and the line read last.
  [[noreturn]] void fail(const std::string& reason, const std::string& remedy) const;

 private:
  std::string_view rest_;
  std::string name_;
  long number_ = 0;
};

}  // namespace farcull
