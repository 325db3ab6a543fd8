// Calls the checker that Coq has proved (verify/certificate/coq), a program of its own.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "core/scene/scene.h"

namespace farcull {

/// Takes the words of a scene one after the other: those that scene_hash() hashes, in its order.
using TakeWord = std::function<void(std::uint64_t)>;
/// Gives all words of a scene, or those of its coordinates alone.
void give_words(const Scene& scene, const TakeWord& take);
void give_coordinates(const Scene& scene, const TakeWord& take);

/// Gives the certificates and the scene to `farcull-check-verified`, which lies beside this program
/// or in the PATH, and returns its exit status: 0 proved, 1 refuted or not proved, 2 a file that it
/// cannot read. tiles: the certificates are those of all tiles of the scene, in order. It prints
/// its verdict on standard output, after the SHA-256 of the files as this program has them: both
/// checkers print the same. words: gives the words of the scene; they go to the checker through a
/// file in memory. Throws Error if it cannot be run.
int run_verified_checker(const std::vector<std::string>& certificates, bool tiles,
                         const std::function<void(const TakeWord&)>& words);

}  // namespace farcull
