// A file that is written piece by piece and appears whole or not at all.
#pragma once

#include <cstdio>
#include <memory>
#include <string>
#include <string_view>

namespace farcull {

class HalfWritten;

/// Writes beside the path; put() renames into place. What is not put is removed, also where SIGINT,
/// SIGTERM or SIGHUP ends the program. One at a time in a process, and no write_output() meanwhile.
/// A symbolic link stays and its file is replaced.
class StreamedOutput {
 public:
  /// Throws Error naming the path where it is standard output, a device or a pipe, which cannot
  /// appear at once, or where the folder or the disk refuses.
  explicit StreamedOutput(const std::string& path);
  ~StreamedOutput();
  StreamedOutput(const StreamedOutput&) = delete;
  StreamedOutput& operator=(const StreamedOutput&) = delete;

  /// Throws Error where the disk refuses.
  void add(std::string_view text);
  /// Ends the file, on the disk, and puts it in place. Throws Error as add().
  void put();

 private:
  std::string path_, place_;
  std::unique_ptr<HalfWritten> part_;
  std::FILE* file_ = nullptr;
};

}  // namespace farcull
