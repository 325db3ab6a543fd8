// The one path of a file that several paths may lead to.
#pragma once

#include <cstdlib>
#include <memory>
#include <string>

namespace farcull {

/// The absolute path without links; `path` itself where there is no such file. By the C library,
/// since std::filesystem would hold several more paths at once.
inline std::string real_path(const std::string& path) {
#ifdef _WIN32
  char* const found = ::_fullpath(nullptr, path.c_str(), 0);
#else
  char* const found = ::realpath(path.c_str(), nullptr);
#endif
  const std::unique_ptr<char, void (*)(void*)> file(found, &std::free);
  return file ? file.get() : path;
}

}  // namespace farcull
