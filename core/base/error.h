// Errors of the outside world (files, EGL, GL, disk, options): one exception type that says where,
// why and what to do. Mistakes of the programmer are assertions, uncertainty is a value ("keep the
// pair"); neither is an Error.
#pragma once

#include <stdexcept>
#include <string>

namespace farcull {

class Error : public std::runtime_error {
 public:
  /// where: a file ("mesh.obj"), a parameter ("{radius}") or a GL stage ("store"); reason: what is
  /// wrong there; remedy: what the user can do next; line: of a text file, from 1; 0: no line. The
  /// three texts are spelled() (core/base/parameter.h).
  Error(std::string where, std::string reason, std::string remedy, long line = 0);

  std::string where;
  std::string reason;
  std::string remedy;
  long line;
};

}  // namespace farcull
