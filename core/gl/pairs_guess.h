// Estimates the room for the first window of a scene, before a GL device has counted anything. For
// core/gl/pairs*.cpp alone.
#pragma once

#include <cstddef>
#include <optional>

#include "core/gl/pairs_run.h"

namespace farcull {

/// Room for the work on a window, by the bounds of its active triangles: enough for most scenes.
/// Nothing depends on its being enough, since a device counts all that it does. memory: bytes for
/// the masks and lists; block: bytes of one buffer. Nothing where they would not do.
std::optional<PairForecast> first_guess(const PairTask& task, std::size_t memory,
                                        std::size_t block);

}  // namespace farcull
