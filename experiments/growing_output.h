// A text that grows during a long run and is whole after each addition.
#pragma once

#include <string>
#include <utility>

namespace farcull {

/// A text that grows by additions and has an end, such as a JSON array with its brackets. After
/// each addition a file holds everything up to there and the end, so whatever ends the program
/// leaves a whole text; only a kill or a crash of the machine while an addition is written can cut
/// it short. The first addition appears as write_output() does: what the path held is there until
/// then. Standard output, devices and pipes take the additions as they come, and the end once.
class GrowingOutput {
 public:
  /// Nothing is written before the first addition.
  explicit GrowingOutput(std::string path) : path_(std::move(path)) {}
  ~GrowingOutput();
  GrowingOutput(const GrowingOutput&) = delete;
  GrowingOutput& operator=(const GrowingOutput&) = delete;

  /// Adds `text`; `end` takes the place of the end before. Throws Error as write_output() does; a
  /// file then holds what it held before.
  void add(const std::string& text, const std::string& end);
  /// No addition will follow. The destructor does the same where it can, and says nothing.
  void finish();

 private:
  std::string path_;
  std::string end_;
  bool begun_ = false, finished_ = false, streamed_ = false;
  int file_ = -1;       // of a regular file, or of a device or pipe
  long long kept_ = 0;  // bytes before the end
};

}  // namespace farcull
