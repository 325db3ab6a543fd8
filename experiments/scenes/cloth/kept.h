// A folder that keeps every state of a simulated cloth, so that no step is ever computed twice and
// an interrupted simulation goes on as if nothing had happened.
#pragma once

#include <optional>
#include <string>

#include "experiments/scenes/cloth/cloth.h"

namespace farcull {

/// The folder named by the environment variable FARCULL_CLOTH; empty where it is not set.
std::string cloth_folder();

/// The states of one cloth, one file a frame: its doubles as they are in memory, under a heading
/// that says which settings and which arithmetic they are of, with a checksum. A file appears whole
/// or not at all.
class KeptCloth {
 public:
  /// Makes FOLDER and in it the folder of these settings. Throws Error where they cannot be made.
  KeptCloth(const std::string& folder, const ClothSettings& settings);

  /// The file of a frame.
  std::string path(long frame) const;

  /// The largest frame from 1 to `frame` that has a file; 0 where none has: the start is not kept.
  long last(long frame) const;

  /// The state in the file of a frame, bit for bit as write() got it. Throws Error naming the file
  /// and the remedy where it cannot be read, is truncated or damaged, is of another frame, of other
  /// settings or of other arithmetic.
  ClothState read(long frame) const;

  /// Throws Error naming the file where the system refuses it.
  void write(const ClothState& state) const;

 private:
  std::string folder_;
  std::string heading_;  // of each file: settings and arithmetic
};

}  // namespace farcull
