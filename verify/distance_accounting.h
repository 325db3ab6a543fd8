// Independent accounting for distances: every pair of triangles is proved to be no nearer than the
// answer allows.
//
// It shares no code with what culled, nor with what computed the answers (verify/closest.h): it
// makes its own boxes, and decides what they leave, and each answer, in the integers that
// certificates are checked with (verify/certificate/integer_distance.h).
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
/// because of it, or if it should be an answer itself. It is *earlier* if it is as near as the
/// answer about its objects and comes before it, so that it should be the answer.
struct DistanceAccounting {
  std::uint64_t pairs_total = 0;   // by combinatorics
  std::uint64_t answers = 0;       // pairs that the answers name
  std::uint64_t objects_meet = 0;  // after an answer that is 0, or of objects whose last neighbour
                                   // is at distance 0: nothing is nearer than 0
  std::uint64_t farther_by_boxes = 0;  // by the gaps between their boxes
  std::uint64_t farther_by_planes =
      0;                               // some two parallel planes between them are far enough apart
  std::uint64_t neighbours = 0;        // of one object, which do not count
  std::uint64_t farther_by_exact = 0;  // by the squares of distances, in integers
  std::uint64_t nearer = 0;            // missed
  std::uint64_t earlier = 0;           // the answer is not the first of the nearest pairs
  std::vector<TrianglePair> examples;  // the first missed ones
  /// Answers whose distance, nearest points or features are not those of their triangles, whose
  /// `inside` is not that of their objects, or that are beyond `within`, or not asked for.
  std::uint64_t wrong = 0;
  double ms = 0;
  FARCULL_FIELDS(pairs_total, answers, objects_meet, farther_by_boxes, farther_by_planes,
                 neighbours, farther_by_exact, nearer, earlier, wrong)
  /// True iff the classes sum to pairs_total. Not so by construction: the total is computed.
  bool adds_up() const;
  /// No pair was missed, no answer is wrong or not the first.
  bool holds() const { return nearer == 0 && earlier == 0 && wrong == 0; }
};

/// answers: sorted by objects, then by pairs, each once. Throws std::logic_error where they are
/// not, where one names triangles that are not those of its objects, or where the classes do not
/// add up. Memory O(triangles + answers).
DistanceAccounting account_distances(const Scene& scene, std::span<const ClaimedDistance> answers,
                                     const DistanceQuestion& question);

}  // namespace farcull
