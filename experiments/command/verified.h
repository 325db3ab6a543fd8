// Calls the checker that Coq has proved (verify/certificate/coq), a program of its own.
#pragma once

#include <string>

#include "core/scene/scene.h"

namespace farcull {

/// Gives the certificate and the scene to `farcull-check-verified`, which lies beside this program
/// or in the PATH, and returns its exit status: 0 proved, 1 refuted or not proved, 2 a file that it
/// cannot read. It prints its verdict on standard output. The scene goes to it through a file in
/// memory with the words that scene_hash() hashes. Throws Error if it cannot be run.
int run_verified_checker(const std::string& certificate, const Scene& scene);

}  // namespace farcull
