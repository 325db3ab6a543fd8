// Derives from question and answers what account_distances() has to prove about the pairs of
// triangles of two objects.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "core/scene/scene.h"
#include "verify/certificate/integer_distance.h"
#include "verify/certificate/integers.h"
#include "verify/distance_question.h"

namespace farcull {

/// Distances below a length, or at most the length.
enum class Bound : std::uint8_t { below, at_most };

/// Pairs of triangles should have been answered if their distance is below `length`, or at most
/// `length`, as `bound` says.
struct Threshold {
  std::optional<Length> length;  // none: infinite, all of them
  Bound bound = Bound::below;
};
/// Whether the distance is the root, rounded to the nearest double; of two equally near ones, the
/// even one.
bool is_rounded_root(double distance, const Fraction& squared);

class DistanceClaims {
 public:
  /// Throws std::logic_error as account_distances().
  DistanceClaims(const Scene& scene, std::span<const ClaimedDistance> answers,
                 const DistanceQuestion& question);

  /// The distance within which every pair of the objects a <= b had to be answered.
  Threshold threshold(std::uint32_t a, std::uint32_t b) const;
  /// The answers of the objects a <= b.
  std::span<const ClaimedDistance> of(std::uint32_t a, std::uint32_t b) const;
  /// Whether objects a <= b are asked about.
  bool asked(std::uint32_t a, std::uint32_t b) const;
  /// How many answers cannot be right, by themselves or among all the others.
  std::uint64_t wrong(unsigned threads) const;

 private:
  struct Farthest {  // the last neighbour of an object
    std::size_t answers = 0;
    Fraction squared;
    std::uint32_t other = 0;
  };
  void find_farthest();
  bool wrong(std::size_t answer) const;
  bool wrong_inside(const ClaimedDistance& claim, const Fraction& squared) const;

  const Scene& scene_;
  std::span<const ClaimedDistance> answers_;
  DistanceQuestion question_;
  Threshold within_;
  std::vector<std::optional<Fraction>> squares_;  // of the answers
  std::vector<Farthest> farthest_;                // of each object; of `nearest`
  IntegerInside insides_;
};

}  // namespace farcull
