// Independent accounting: what became of every pair of triangles of different objects, certified
// pair by pair.
//
// It shares no code with what culled: it makes its own boxes, enumerates the overlapping ones by
// its own algorithm (neither CGAL's join nor core's), and decides the rest with verify/exact. It
// knows nothing of offsets, views or budgets.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "core/scene.h"

namespace farcull {

/// Numbers of unordered pairs of triangles of different objects. Each pair is in exactly one class,
/// the first that fits, in the order of the fields.
struct Accounting {
  std::uint64_t pairs_total = 0;         // by combinatorics from the sizes of the objects
  std::uint64_t pairs_kept = 0;          // among the kept, whatever its boxes
  std::uint64_t certified_by_boxes = 0;  // closed boxes disjoint, by comparisons of doubles
  std::uint64_t neighbours =
      0;  // 0: neighbours exist only inside one object, whose pairs are not counted yet
  std::uint64_t certified_by_predicates = 0;  // boxes overlap, disjoint by exact predicates
  std::uint64_t false_negatives = 0;          // neither kept nor disjoint: missed
  std::vector<TrianglePair> examples;         // the first missed pairs in sorted order
  double ms = 0;                              // wall clock of the whole accounting

  /// True iff the classes sum to pairs_total. Not so by construction: the classes are counted, the
  /// total is computed.
  bool adds_up() const;
};

/// kept: what culling left to the exact tests; sorted, each pair once, a < b, of different objects
/// of the scene. Breaking that is a programmer's mistake that would be miscounted in silence, hence
/// std::logic_error; so is a scene whose ranges are not those of validate(). At most max_examples
/// missed pairs are returned. Memory O(triangles + kept).
Accounting account(const Scene& scene, std::span<const TrianglePair> kept,
                   std::size_t max_examples = 10);

}  // namespace farcull
