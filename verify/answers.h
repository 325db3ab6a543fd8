// The answers of decide() about each candidate, and their count.
#pragma once

#include <cstdint>
#include <span>

#include "verify/exact.h"

namespace farcull {

/// A candidate begins undecided. neighbours_unasked: neighbours, where ExactQuestion::neighbours is
/// false.
enum class PairAnswer : std::uint8_t {
  undecided,
  apart,
  colliding,
  neighbours_apart,
  neighbours_colliding,
  neighbours_unasked
};

/// Each class counted where an answer is in it; the colliding candidates in the order given. Throws
/// std::logic_error where an answer is undecided, or where there is not one for each candidate.
Collisions count_answers(std::span<const TrianglePair> candidates,
                         std::span<const PairAnswer> answers);

}  // namespace farcull
