// The answers of decide() about each candidate, and their count.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/scene/scene.h"

namespace farcull {

/// The answer about one candidate. It begins undecided. neighbours_unasked: neighbours, where
/// ExactQuestion::neighbours is false.
enum class PairAnswer : std::uint8_t {
  undecided,
  apart,
  colliding,
  neighbours_apart,
  neighbours_colliding,
  neighbours_unasked
};

struct Collisions {
  std::vector<TrianglePair> pairs;            // that collide and are not neighbours
  std::vector<TrianglePair> neighbour_pairs;  // neighbours that collide
  std::uint64_t neighbours = 0;               // candidates that are neighbours, colliding or not
  std::uint64_t apart = 0;                    // candidates that do not collide, no neighbours
  std::uint64_t neighbours_apart = 0;         // neighbours that were decided and do not collide

  /// pairs and neighbour_pairs together; sorted where both are.
  std::vector<TrianglePair> all() const;
};

/// Each class counted where an answer is in it; the colliding candidates in the order given. Throws
/// std::logic_error where an answer is undecided, or where there is not one for each candidate.
Collisions count_answers(std::span<const TrianglePair> candidates,
                         std::span<const PairAnswer> answers);

}  // namespace farcull
