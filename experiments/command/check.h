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

/// Asks the proved checker as well. Throws Error unless both checkers agree whether this is proved.
/// status: the result of this checker. words: gives the words of the scene.
void check_again(const CheckArguments& arguments, const std::vector<std::string>& files,
                 const std::function<void(const TakeWord&)>& words, int status);

/// Checks certificates of tiles in turn, each with the triangles that meet its tile. So the memory
/// is that of the largest part of the scene and of one tile. whole: these must be all tiles, in
/// order. Prints the verdict and returns the exit status, as run_check().
int check_tiles(const CheckArguments& arguments, const std::vector<std::string>& files, bool whole);

// ---- the checker that Coq has proved (verify/certificate/coq), a program of its own

/// Gives all words of a scene, or those of its coordinates alone.
void give_words(const Scene& scene, const TakeWord& take);
void give_coordinates(const Scene& scene, const TakeWord& take);

/// Gives the certificates and the scene to `farcull-check-verified`, which is in the folder of this
/// program or in the PATH. Returns its exit status: 0 proved, 1 refuted or not proved, 2 a file
/// that it cannot read. tiles: the certificates are those of all tiles of the scene, in order.
/// Prints on standard output the SHA-256 of the files as this program has them, then the output of
/// the checker: the same SHA-256, and its verdict. words: gives the words of the scene; they go to
/// the checker through a file in memory. Throws Error if it cannot be run.
int run_verified_checker(const std::vector<std::string>& certificates, bool tiles,
                         const std::function<void(const TakeWord&)>& words);

}  // namespace farcull
