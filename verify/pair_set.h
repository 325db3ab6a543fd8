// A set of pairs as their number and a hash, and the set of pairs whose boxes overlap.
#pragma once

#include <cstdint>

#include "core/scene/scene.h"

namespace farcull {

/// The number of pairs and a sum over them, which does not depend on their order. Two sets of one
/// size that differ have the same sum with a chance of 2^-64.
struct PairSet {
  std::uint64_t count = 0;
  std::uint64_t sum = 0;

  void add(const TrianglePair& pair);
  bool operator==(const PairSet&) const = default;
};

/// The pairs that count whose boxes overlap (not farther apart than the clearance along an axis),
/// as the certificate enumerates them (verify/certificate/box_pairs.h).
PairSet pairs_with_overlapping_boxes(const Scene& scene, double clearance);

}  // namespace farcull
