// `farcull check` of certificates of distances.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "experiments/scenes/frames.h"

namespace farcull {

inline constexpr std::uint64_t kMaxBytes = std::uint64_t{4} << 30;  // of a certificate or a list

/// Text that a terminal can show, line by line.
std::string clean_lines(const std::string& text);

/// What the command was given.
struct DistanceCheckArguments {
  std::string certificate;  // a file, of frames with a number
  std::vector<std::string> scene;
  bool self = false;
  std::string json;  // "" for none, "-" for standard output instead of the text
};

/// Whether the file is there and says that it is a certificate of distances.
bool is_of_distances(const std::string& file);

/// Prints the verdict and returns the exit status, as run_check(). text: of the certificate. Throws
/// Error where the text or the scene cannot be read.
int check_distance_file(const DistanceCheckArguments& arguments, const std::string& text);

/// The same for each frame, and in all.
int check_distance_frames(const DistanceCheckArguments& arguments, const FrameRange& range);

}  // namespace farcull
