// Independent accounting. Each pair of triangles that counts is kept by culling, proved apart or
// missed. A pair counts if its triangles are of different objects, or of one object marked `self`.
//
// The accounting shares no code with culling. It computes its own boxes, and finds the pairs with
// overlapping boxes by its own algorithm, not by CGAL's join or core's join. It decides the pairs
// that were not kept with verify/exact. It does not use offsets, views or budgets.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "core/base/fields.h"
#include "core/scene/scene.h"
#include "verify/exact.h"

namespace farcull {

/// A fingerprint of a set of pairs: the number of pairs and the sum of their hashes. Two different
/// sets of the same size have equal sums with a probability of about 2^-64.
struct PairSet {
  std::uint64_t count = 0;
  std::uint64_t sum = 0;

  void add(const TrianglePair& pair);
  bool operator==(const PairSet&) const = default;
};

/// Returns the fingerprint of the pairs that count and whose boxes overlap, enumerated by BoxPairs
/// (verify/certificate/box_pairs.h). Boxes overlap if their gap along each axis is at most the
/// clearance.
PairSet pairs_with_overlapping_boxes(const Scene& scene, double clearance);

/// Numbers of unordered pairs that count. Each pair is counted in exactly one field after
/// pairs_total: the first field that fits. verify/exact.h defines neighbours, their shared part and
/// the clearance D.
struct Accounting {
  std::uint64_t pairs_total = 0;         // computed from the sizes of the objects
  std::uint64_t ignored = 0;             // pairs of objects in AccountOptions::ignored
  std::uint64_t pairs_kept = 0;          // pairs in the list `kept` of account()
  std::uint64_t certified_by_boxes = 0;  // pairs whose boxes are more than D apart along an axis
  std::uint64_t neighbours = 0;          // neighbours that share only the shared part
  std::uint64_t certified_by_predicates = 0;  // pairs that exact predicates prove more than D apart
  std::uint64_t false_negatives = 0;          // missed pairs: all pairs of no other class
  std::vector<TrianglePair> examples;         // the first missed pairs in sorted order
  double ms = 0;                              // wall clock of the whole accounting
  FARCULL_FIELDS(pairs_total, ignored, pairs_kept, certified_by_boxes, certified_by_predicates,
                 neighbours, false_negatives)

  /// True iff the classes sum to pairs_total.
  bool adds_up() const;
};

struct AccountOptions {
  double clearance = 0;                  // world units, finite, >= 0
  std::size_t max_examples = 10;         // at most this many missed pairs are returned
  std::vector<ObjectPair> ignored = {};  // sorted, a < b; no kept pair may be of such objects
};

/// The two functions that account() calls: `decide` decides pairs, `overlapping` enumerates pairs.
/// Tests replace these by faulty functions, and check that account() notices the faults.
struct AccountingSteps {
  std::function<Collisions(const Scene&, std::span<const TrianglePair>, const ExactQuestion&)>
      decide = farcull::decide;
  std::function<PairSet(const Scene&, double clearance)> overlapping = pairs_with_overlapping_boxes;
};

/// Counts the pairs of each class. kept: the pairs that culling left to the exact tests, sorted,
/// each once, a < b. Each kept pair must count and must not be ignored. Memory O(triangles + kept).
/// Throws std::logic_error in these cases:
/// - `kept` is not as described above, so that the counts would be wrong.
/// - validate() would not accept the ranges of the scene.
/// - The clearance is negative or not finite.
/// - A pair is left undecided, or the classes do not sum to pairs_total.
/// - BoxPairs finds a different set of pairs with overlapping boxes.
Accounting account(const Scene& scene, std::span<const TrianglePair> kept,
                   const AccountOptions& options = {}, const AccountingSteps& steps = {});

}  // namespace farcull
