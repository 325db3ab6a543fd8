// Checks answers about distances independently: proves that every pair of triangles is no nearer
// than the answers allow.
//
// The accounting shares no code with the culling, nor with verify/closest.h, which computed the
// answers. The boxes are those of the checker of certificates. Each answer is decided in integers
// (verify/certificate/integer_distance.h). Each pair that neither boxes nor planes prove far enough
// apart is also decided in integers.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/base/fields.h"
#include "core/scene/scene.h"
#include "verify/certificate/integer_distance.h"
#include "verify/certificate/integers.h"

namespace farcull {

/// An answer about the objects a <= b. It claims that `pair` is the first of the nearest pairs of
/// their triangles. For a question of kind `all`, it claims that `pair` is within the distance
/// asked for. If a == b, neighbours (verify/exact.h) do not count.
struct ClaimedDistance {
  std::uint32_t a = 0, b = 0;  // indices of the objects
  TrianglePair pair;           // a triangle of a and one of b
  double distance = 0;         // the root of `squared`, rounded to the nearest double
  std::string squared;  // the square of the distance, "numerator/denominator" in lowest terms
  std::array<Vec3, 2> points;  // nearest points of a and of b, each coordinate rounded once
  std::array<std::uint8_t, 2> features{};     // features of the points, numbered as in
                                              // verify/certificate/integer_distance.h
  InsideClaim inside = InsideClaim::unknown;  // unknown if not asked, if a == b, or at distance 0
};

struct DistanceQuestion {
  /// objects: the nearest pair of every two objects, and the nearest pair within each `self`
  /// object.
  /// nearest: the nearest pair of each object with each of its k nearest other objects. If objects
  /// are equally far away, those with lower indices count as nearer.
  /// all: every pair of triangles within the distance, of different objects or of a `self` object.
  enum class Kind : std::uint8_t { objects, nearest, all };
  Kind kind = Kind::objects;
  std::size_t k = 1;
  /// Pairs farther apart than this are not asked for. World units, >= 0; finite with `all`.
  double within = std::numeric_limits<double>::infinity();
  bool inside = false;   // asks whether one of two disjoint objects is in the other; not for `all`
  unsigned threads = 0;  // 0: as many as there are cores; changes no answer
};

/// Counts of all pairs of triangles that were asked about. Each pair is in one class: the first
/// that fits. A pair is *nearer* if it is nearer than the answer about its objects, or if it should
/// be an answer but is none. A pair is *earlier* if it is as near as the answer about its objects
/// and comes before the answer in order, so it should be the answer.
struct DistanceAccounting {
  std::uint64_t pairs_total = 0;        // computed from the sizes of the objects
  std::uint64_t answers = 0;            // pairs that the answers name
  std::uint64_t objects_meet = 0;       // pairs that come after an answer of distance 0, or whose
                                        // objects have their kth neighbour at distance 0
  std::uint64_t farther_by_boxes = 0;   // proved far enough apart by gaps between boxes
  std::uint64_t farther_by_planes = 0;  // proved far enough apart by two parallel planes
  std::uint64_t neighbours = 0;         // neighbours in one object (verify/exact.h); never answers
  std::uint64_t farther_by_exact = 0;   // proved far enough apart in integers
  std::uint64_t nearer = 0;             // missed pairs
  std::uint64_t earlier = 0;            // pairs that should be answers in place of later pairs
  std::vector<TrianglePair> examples;   // the first missed pairs
  /// Number of wrong answers. An answer is wrong if it is not asked for, if its distance is beyond
  /// `within`, or if its distance, nearest points, features or `inside` are wrong.
  std::uint64_t wrong = 0;
  double ms = 0;
  FARCULL_FIELDS(pairs_total, answers, objects_meet, farther_by_boxes, farther_by_planes,
                 neighbours, farther_by_exact, nearer, earlier, wrong)
  /// True iff the classes sum to pairs_total.
  bool adds_up() const;
  /// True iff no pair was missed, no answer is wrong, and each answer is the first of the nearest
  /// pairs.
  bool holds() const { return nearer == 0 && earlier == 0 && wrong == 0; }
};

/// Checks the answers and counts the pairs by class. answers: sorted by objects, then by pairs,
/// each once. Throws std::logic_error if answers are unsorted or repeated, if an answer names
/// triangles that its objects lack, or if the classes do not add up. Memory O(triangles + answers).
DistanceAccounting account_distances(const Scene& scene, std::span<const ClaimedDistance> answers,
                                     const DistanceQuestion& question);

// ---- The declarations below are for distance_accounting.cpp and its tests. They derive from
// question and answers what has to be proved about the triangles of two objects.

/// below: distances less than a length. at_most: distances up to and including the length.
enum class Bound : std::uint8_t { below, at_most };

/// Every pair of triangles whose distance is below `length` (at_most: at most `length`) has to be
/// among the answers.
struct Threshold {
  std::optional<Length> length;  // none: the length is infinite
  Bound bound = Bound::below;
};
/// True if the distance is the root of `squared`, rounded to the nearest double, ties to even.
bool is_rounded_root(double distance, const Fraction& squared);

class DistanceClaims {
 public:
  /// Throws std::logic_error as account_distances() does.
  DistanceClaims(const Scene& scene, std::span<const ClaimedDistance> answers,
                 const DistanceQuestion& question);

  /// Returns the threshold within which each pair of triangles of the objects a <= b has to be an
  /// answer.
  Threshold threshold(std::uint32_t a, std::uint32_t b) const;
  /// Returns the answers about the objects a <= b.
  std::span<const ClaimedDistance> of(std::uint32_t a, std::uint32_t b) const;
  /// True if the question is about the objects a <= b.
  bool asked(std::uint32_t a, std::uint32_t b) const;
  /// Returns the number of wrong answers. An answer may be wrong in itself, or because other
  /// answers show that neither of its objects has the other one among its k nearest.
  std::uint64_t wrong(unsigned threads) const;

 private:
  struct Farthest {  // the kth nearest neighbour of an object; known iff answers == k
    std::size_t answers = 0;
    Fraction squared;
    std::uint32_t other = 0;
  };
  void find_farthest();
  bool wrong(std::size_t answer) const;

  const Scene& scene_;
  std::span<const ClaimedDistance> answers_;
  DistanceQuestion question_;
  Threshold within_;
  std::vector<std::optional<Fraction>> squares_;  // one for each answer
  std::vector<Farthest> farthest_;  // one for each object; empty unless the question is `nearest`
  IntegerInside insides_;
};

}  // namespace farcull
