// One exception type for all errors of the environment (files, EGL, GL, disk, options). An Error
// says what is wrong, where, and what to do. An uncertain result is not an Error: the pair of
// triangles is then kept as a candidate.
#pragma once

#include <stdexcept>
#include <string>

namespace farcull {

class Error : public std::runtime_error {
 public:
  /// line: line number in a text file, counted from 1; 0: none. The texts may name a parameter as
  /// "{depth_format}" and a command as "{doctor}". The program replaces them by its own names.
  Error(std::string where, std::string reason, std::string remedy, long line = 0);

  std::string where;   // a parameter ("vertices"), a file, an object, or a step on a device
  std::string reason;  // what is wrong
  std::string remedy;  // what to do next
  long line;
};

// ---- names of parameters ----

/// Replaces each {parameter} in the text by the program's spelling of its name. Only removes the
/// braces if spell_parameters() has not been called.
std::string spelled(const std::string& text);
/// Sets how the program spells the name of a parameter, such as --depth-format on a command line.
/// `spelling` must return an empty text if the name is not a parameter. In this case spelled()
/// keeps the braces, as in the file name a{b}.obj. Call this before any other thread runs.
void spell_parameters(std::string (*spelling)(const std::string& name));

}  // namespace farcull
