// Independent accounting: each pair of triangles that counts is kept, proved apart, or missed. A
// pair counts if its triangles are of different objects, or of one object marked `self`.
//
// The accounting shares no code with what culled: it makes its own boxes, finds the pairs whose
// boxes overlap by its own algorithm (neither CGAL's join nor core's), and decides the pairs that
// were not kept with verify/exact. It knows nothing of offsets, views or budgets.
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

/// The number of pairs, and the sum of their hashes, which does not depend on their order. Two
/// different sets of the same size have equal sums with a probability of 2^-64.
struct PairSet {
  std::uint64_t count = 0;
  std::uint64_t sum = 0;

  void add(const TrianglePair& pair);
  bool operator==(const PairSet&) const = default;
};

/// The pairs that count and whose boxes overlap (are not farther apart than the clearance along any
/// axis), as the certificate enumerates them (verify/certificate/box_pairs.h).
PairSet pairs_with_overlapping_boxes(const Scene& scene, double clearance);

/// Numbers of unordered pairs that count. Each pair is in exactly one class, the first that fits,
/// in the order of the fields. verify/exact.h defines neighbours, their shared part and the
/// clearance D.
struct Accounting {
  std::uint64_t pairs_total = 0;         // by combinatorics from the sizes of the objects
  std::uint64_t ignored = 0;             // of two objects in AccountOptions::ignored
  std::uint64_t pairs_kept = 0;          // in `kept`, whether or not the boxes overlap
  std::uint64_t certified_by_boxes = 0;  // pairs whose closed boxes are more than D apart along an
                                         // axis; the gap is rounded, but not for D = 0
  std::uint64_t neighbours = 0;          // neighbours whose intersection is only the shared part
  std::uint64_t certified_by_predicates = 0;  // farther than D apart by exact predicates
  std::uint64_t false_negatives = 0;          // pairs in no other class: missed
  std::vector<TrianglePair> examples;         // the first missed pairs in sorted order
  double ms = 0;                              // wall clock of the whole accounting
  FARCULL_FIELDS(pairs_total, ignored, pairs_kept, certified_by_boxes, certified_by_predicates,
                 neighbours, false_negatives)

  /// True iff the classes sum to pairs_total, which is computed from the sizes of the objects
  /// alone.
  bool adds_up() const;
};

struct AccountOptions {
  double clearance = 0;                  // world units, finite, >= 0
  std::size_t max_examples = 10;         // missed pairs that are returned, at most
  std::vector<ObjectPair> ignored = {};  // sorted, a < b; no kept pair is of two such objects
};

/// The two functions that account() calls to decide and to enumerate. Tests replace them by faulty
/// ones, which account() has to notice.
struct AccountingSteps {
  std::function<Collisions(const Scene&, std::span<const TrianglePair>, const ExactQuestion&)>
      decide = farcull::decide;
  std::function<PairSet(const Scene&, double clearance)> overlapping = pairs_with_overlapping_boxes;
};

/// kept: the pairs that culling left to the exact tests; sorted, each pair once, a < b; they count
/// and are not ignored. Throws std::logic_error if `kept` is not so (the counts would be wrong
/// without notice), if validate() would not accept the ranges of the scene, or if the clearance is
/// negative or not finite. Also throws it if the accounting itself fails: a pair is left undecided,
/// the classes do not sum to pairs_total, or the pairs whose boxes overlap are not those that the
/// certificate's own enumeration finds. Memory O(triangles + kept).
Accounting account(const Scene& scene, std::span<const TrianglePair> kept,
                   const AccountOptions& options = {}, const AccountingSteps& steps = {});

}  // namespace farcull
