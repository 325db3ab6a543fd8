// Shared by the sources of `farcull check`.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "experiments/command/command.h"
#include "experiments/command/verified.h"
#include "verify/certificate/certificate.h"

namespace farcull {

/// The largest certificate or list that is read.
constexpr std::uint64_t kMaxCheckedBytes = std::uint64_t{4} << 30;

Certificate read_certificate(const std::string& path);

/// Replaces what a terminal cannot show, line by line.
std::string clean_lines(const std::string& text);

/// Asks the proved checker as well. Throws Error unless it proves just what this one has proved.
/// status: of this one. words: gives those of the scene.
void check_again(const CheckArguments& arguments, const std::vector<std::string>& files,
                 const std::function<void(const TakeWord&)>& words, int status);

/// Checks certificates of tiles one after the other, each with the triangles that meet its tile:
/// the memory is that of the largest part of the scene and of one tile. whole: they have to be
/// those of all tiles, in order. Prints the verdict and returns the exit status, as run_check().
int check_tiles(const CheckArguments& arguments, const std::vector<std::string>& files, bool whole);

}  // namespace farcull
