// Shared by the sources of `farcull check`.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "core/scene/scene.h"
#include "experiments/command/command.h"
#include "verify/certificate/certificate.h"

namespace farcull {

/// The largest certificate or list that is read.
constexpr std::uint64_t kMaxCheckedBytes = std::uint64_t{4} << 30;

Certificate read_certificate(const std::string& path);

/// Replaces what a terminal cannot show, line by line.
std::string clean_lines(const std::string& text);

/// Takes the words of a scene one after the other: those that scene_hash() hashes, in its order.
using TakeWord = std::function<void(std::uint64_t)>;

/// Gives the certificates and the scene to the checker that Coq has proved
/// (verify/certificate/coq): `farcull-check-verified`, which is in the folder of this program or in
/// the PATH. Prints the SHA-256 of the files as this program has them, then the output of the
/// checker: the same SHA-256, and its verdict. words: gives the words of the scene; status: the
/// result of this checker. Throws Error if the other one cannot be run, or if they do not agree
/// whether this is proved.
void check_again(const CheckArguments& arguments, const std::vector<std::string>& files,
                 const std::function<void(const TakeWord&)>& words, int status);

/// Checks certificates of tiles in turn, each with the triangles that meet its tile. So the memory
/// is that of the largest part of the scene and of one tile. whole: these must be all tiles, in
/// order. Prints the verdict and returns the exit status, as run_check().
int check_tiles(const CheckArguments& arguments, const std::vector<std::string>& files, bool whole);

/// Gives all words of a scene, or those of its coordinates alone.
void give_words(const Scene& scene, const TakeWord& take);
void give_coordinates(const Scene& scene, const TakeWord& take);

}  // namespace farcull
