// One exception type for all errors of the environment (files, EGL, GL, disk, options). An Error
// says what is wrong, where, and what to do. Programming mistakes are assertions. An uncertain
// result is a value ("keep the pair"), not an Error.
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

/// Replaces each {parameter} in the text by the program's spelling of its name. If no spelling is
/// set, only removes the braces.
std::string spelled(const std::string& text);
/// Sets how the program spells the name of a parameter, such as --depth-format on a command line.
/// `spelling` must return an empty text for a name that is no parameter. spelled() then keeps the
/// braces, as in the file name a{b}.obj. Call this before any other thread runs.
void spell_parameters(std::string (*spelling)(const std::string& name));

}  // namespace farcull
