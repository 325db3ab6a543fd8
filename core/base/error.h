// Errors of the outside world (files, EGL, GL, disk, options): one exception type that says where,
// why and what to do. Mistakes of the programmer are assertions, not Errors. Uncertainty is a value
// ("keep the pair"), not an Error.
#pragma once

#include <stdexcept>
#include <string>

namespace farcull {

class Error : public std::runtime_error {
 public:
  /// line: of a text file, from 1; 0: no line. A text may name a parameter as "{depth_format}" and
  /// a command as "{doctor}". Only the program knows how its users write these names.
  Error(std::string where, std::string reason, std::string remedy, long line = 0);

  std::string where;   // a parameter ("vertices"), a file, an object, or a step on a device
  std::string reason;  // what is wrong there
  std::string remedy;  // what to do next
  long line;
};

// ---- names of parameters ----

/// Replaces each {parameter} in the text by the program's spelling of it, or by the bare name if
/// the program has set no spelling.
std::string spelled(const std::string& text);
/// Sets how the program spells a parameter's name, such as --depth-format on a command line.
/// `spelling` returns an empty text for a name that is no parameter; the braces then stay (a file
/// may be called a{b}.obj). Call this before any other thread runs.
void spell_parameters(std::string (*spelling)(const std::string& name));

}  // namespace farcull
