// Independent accounting for distances: every pair of triangles is proved to be no nearer than the
// answer allows.
//
// The accounting shares no code with what culled, nor with what computed the answers
// (verify/closest.h). Its boxes are those of the checker of certificates; pairs that boxes do not
// prove far apart, and each answer, it decides in integers (verify/certificate/integer_distance.h).
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/base/fields.h"
#include "core/scene/scene.h"
#include "verify/distance_question.h"

namespace farcull {

/// Counts of all pairs of triangles that were asked about. Each pair is in one class, the first
/// that fits, and is counted when it is decided. A pair is *nearer* if an answer should be nearer
/// because of this pair, or if the pair should be an answer itself. A pair is *earlier* if it is as
/// near as the answer about its objects but comes before that answer, so it should be the answer.
struct DistanceAccounting {
  std::uint64_t pairs_total = 0;   // by combinatorics
  std::uint64_t answers = 0;       // pairs that the answers name
  std::uint64_t objects_meet = 0;  // come after an answer of distance 0, or are of objects whose
                                   // kth neighbour is at distance 0: nothing is nearer than 0
  std::uint64_t farther_by_boxes = 0;   // by the gaps between their boxes
  std::uint64_t farther_by_planes = 0;  // by two parallel planes between them, far enough apart
  std::uint64_t neighbours = 0;         // in one object (verify/exact.h); no answers
  std::uint64_t farther_by_exact = 0;   // by the squares of distances, in integers
  std::uint64_t nearer = 0;             // missed
  std::uint64_t earlier = 0;            // the answer is not the first of the nearest pairs
  std::vector<TrianglePair> examples;   // the first missed ones
  /// Answers that are wrong about the distance, nearest points or features of their triangles or
  /// about `inside` of their objects, or that are beyond `within` or not asked for.
  std::uint64_t wrong = 0;
  double ms = 0;
  FARCULL_FIELDS(pairs_total, answers, objects_meet, farther_by_boxes, farther_by_planes,
                 neighbours, farther_by_exact, nearer, earlier, wrong)
  /// True iff the classes sum to pairs_total. This is a real check: the total is computed from the
  /// sizes of the objects.
  bool adds_up() const;
  /// True iff no pair was missed, no answer is wrong, and each is the first of the nearest pairs.
  bool holds() const { return nearer == 0 && earlier == 0 && wrong == 0; }
};

/// answers: sorted by objects, then by pairs, each once. Throws std::logic_error if they are not,
/// if an answer names triangles that its objects do not have, or if the classes do not add up.
/// Memory O(triangles + answers).
DistanceAccounting account_distances(const Scene& scene, std::span<const ClaimedDistance> answers,
                                     const DistanceQuestion& question);

}  // namespace farcull
