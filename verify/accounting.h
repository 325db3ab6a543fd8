// Independent accounting: the fate of every pair of triangles that counts, certified pair by pair.
// Those of different objects count, and those of one object where it is `self`.
//
// It shares no code with what culled: it makes its own boxes, enumerates the overlapping ones by
// its own algorithm (neither CGAL's join nor core's), and decides the rest with verify/exact. It
// knows nothing of offsets, views or budgets.
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

/// Numbers of unordered pairs that count. Each pair is in exactly one class, the first that fits,
/// in the order of the fields. Neighbours, their shared part and a clearance D are those of
/// verify/exact.h.
struct Accounting {
  std::uint64_t pairs_total = 0;         // by combinatorics from the sizes of the objects
  std::uint64_t ignored = 0;             // of two objects that nobody asks about
  std::uint64_t pairs_kept = 0;          // among the kept, whatever its boxes
  std::uint64_t certified_by_boxes = 0;  // closed boxes farther than D apart along an axis, by
                                         // differences in double; for D = 0 by comparisons
  std::uint64_t neighbours = 0;          // neighbours whose intersection is only the shared part
  std::uint64_t certified_by_predicates = 0;  // farther than D apart by exact predicates
  std::uint64_t false_negatives = 0;          // none of these: missed
  std::vector<TrianglePair> examples;         // the first missed pairs in sorted order
  double ms = 0;                              // wall clock of the whole accounting
  FARCULL_FIELDS(pairs_total, ignored, pairs_kept, certified_by_boxes, certified_by_predicates,
                 neighbours, false_negatives)

  /// True iff the classes sum to pairs_total. Not so by construction: each class is counted where
  /// its pairs are decided, the total is computed.
  bool adds_up() const;
};

struct AccountOptions {
  double clearance = 0;                  // world units, finite, >= 0
  std::size_t max_examples = 10;         // missed pairs that are returned, at most
  std::vector<ObjectPair> ignored = {};  // sorted, a < b; none of the kept pairs is of such two
};

/// kept: the pairs that culling left to the exact tests; sorted, each pair once, a < b, pairs of
/// the scene that count and are not ignored. Breaking that is a programmer's mistake that would be
/// miscounted in silence, hence std::logic_error; so is a scene whose ranges are not those of
/// validate(), and a clearance that is negative or not finite. std::logic_error as well where the
/// accounting itself fails: a pair is left undecided, the classes do not sum to pairs_total, or the
/// pairs whose boxes overlap are not those that the certificate's own enumeration finds. Memory
/// O(triangles + kept).
Accounting account(const Scene& scene, std::span<const TrianglePair> kept,
                   const AccountOptions& options = {});

/// The two functions that account() calls to decide and to enumerate.
struct AccountingSteps {
  std::function<Collisions(const Scene&, std::span<const TrianglePair>, const ExactQuestion&)>
      decide;
  std::function<PairSet(const Scene&, double clearance)> overlapping;
};

/// account() with these in place of decide() and pairs_with_overlapping_boxes(): account() must
/// notice a faulty one.
Accounting account(const Scene& scene, std::span<const TrianglePair> kept,
                   const AccountOptions& options, const AccountingSteps& steps);

}  // namespace farcull
