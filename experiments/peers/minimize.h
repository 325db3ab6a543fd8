// The smallest example of a fault: the same fault with fewer digits.
#pragma once

#include <optional>
#include <string>

#include "experiments/peers/runner.h"

namespace farcull {

/// A fault about one pair: the outcome, which the label contradicts, or a death.
struct PairFault {
  SuitePair pair;  // with its kind
  ContestOutcome outcome = ContestOutcome::apart;
};

/// The number of characters of the coordinates in decimal: what is minimized.
std::size_t cost_of(const SuitePair& pair);

/// A pair at which the contestant has the same fault, also where it is the only one that a process
/// is asked about; empty where the fault depends on what was asked before. It is one of which the
/// oracles say as before whether it meets, and whose coordinates have as few characters as a search
/// of at most `rounds` rounds finds: it moves and scales both triangles, rounds coordinates, and
/// takes whatever keeps the fault. A round asks one process. Corners that are shared stay so. The
/// kind is that of the new pair.
std::optional<SuitePair> minimized(const Invited& invited, const PairFault& fault,
                                   const ContestLimits& limits, int rounds = 8);

/// The 18 coordinates in decimal, with blanks between.
std::string coordinates_text(const SuitePair& pair);

}  // namespace farcull
