// The parts of account() besides its own tree, so that a test can put a faulty one in their place.
#pragma once

#include <cstdint>
#include <functional>
#include <span>

#include "verify/accounting.h"
#include "verify/exact.h"

namespace farcull {

/// A set of pairs as their number and a sum over them, which does not depend on their order. Two
/// sets of one size that differ have the same sum with a chance of 2^-64.
struct PairSet {
  std::uint64_t count = 0;
  std::uint64_t sum = 0;

  void add(const TrianglePair& pair);
  bool operator==(const PairSet&) const = default;
};

/// The pairs that count whose boxes overlap (not farther apart than the clearance along an axis),
/// as the certificate enumerates them (verify/box_pairs).
PairSet pairs_with_overlapping_boxes(const Scene& scene, double clearance);

struct AccountingParts {
  std::function<Collisions(const Scene&, std::span<const TrianglePair>, const ExactQuestion&)>
      decide;
  std::function<PairSet(const Scene&, double clearance)> overlapping;
};

/// account() with these parts in place of decide() and pairs_with_overlapping_boxes().
Accounting account(const Scene& scene, std::span<const TrianglePair> kept,
                   const AccountOptions& options, const AccountingParts& parts);

}  // namespace farcull
