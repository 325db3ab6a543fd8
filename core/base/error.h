// One exception type for all errors of the outside world (files, EGL, GL, disk, options). It says
// what is wrong, where, and what to do. Mistakes of the programmer are assertions, not Errors. An
// uncertain result is a value ("keep the pair"), not an Error.
#pragma once

#include <stdexcept>
#include <string>

namespace farcull {

class Error : public std::runtime_error {
 public:
  /// line: the line of a text file, counted from 1, or 0 for none. A text may name a parameter as
  /// "{depth_format}" and a command as "{doctor}": the program shows them as its users write them.
  Error(std::string where, std::string reason, std::string remedy, long line = 0);

  std::string where;   // a parameter ("vertices"), a file, an object, or a step on a device
  std::string reason;  // what is wrong
  std::string remedy;  // what to do next
  long line;
};

// ---- names of parameters ----

/// Replaces each {parameter} in the text by the program's spelling of it, or by the bare name if
/// the program has set no spelling.
std::string spelled(const std::string& text);
/// Sets how the program spells a parameter's name, such as --depth-format on a command line. If a
/// name is no parameter, `spelling` returns an empty text, and spelled() keeps the braces, as in a
/// file name a{b}.obj. Call this before any other thread runs.
void spell_parameters(std::string (*spelling)(const std::string& name));

}  // namespace farcull
