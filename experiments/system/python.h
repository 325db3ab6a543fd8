// Finds and starts a Python interpreter. Parts of the program are written in Python.
#pragma once

#include <unistd.h>

#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <vector>

#include "core/base/error.h"

namespace farcull {

/// Returns the interpreter to run: $FARCULL_PYTHON if set, else /usr/bin/python3 if this file
/// exists (Debian installs Python packages for it), else python3 from PATH.
inline std::string python() {
  const char* const named = std::getenv("FARCULL_PYTHON");
  constexpr const char* kUsual = "/usr/bin/python3";
  return named != nullptr && *named != '\0' ? named
         : ::access(kUsual, X_OK) == 0      ? kUsual
                                            : "python3";
}

/// Returns the folder of the Python program that writes reports and figures: the folder that
/// FARCULL_REPORT names, else the folder installed beside this program, else `of_sources`.
inline std::string report_folder(const std::string& of_sources) {
  namespace fs = std::filesystem;
  const char* const named = std::getenv("FARCULL_REPORT");
  const fs::path self = fs::read_symlink("/proc/self/exe");
  const fs::path installed = self.parent_path().parent_path() / "share/farcull/report";
  const std::string folder = named != nullptr && *named != '\0' ? named
                             : fs::exists(installed)            ? installed.string()
                                                                : of_sources;
  if (!fs::exists(folder + "/__main__.py"))
    throw Error(folder, "the program that writes reports is not there", "install farcull again");
  return folder;
}

/// Replaces this process by Python with these arguments. Throws Error with `remedy` if Python
/// cannot be run.
[[noreturn]] inline void become_python(std::vector<std::string> words, const std::string& remedy) {
  words.insert(words.begin(), python());
  std::vector<char*> arguments;
  for (std::string& word : words) arguments.push_back(word.data());
  arguments.push_back(nullptr);
  ::execvp(arguments.front(), arguments.data());
  throw Error(words.front(), std::string("cannot be run: ") + std::strerror(errno), remedy);
}

}  // namespace farcull
