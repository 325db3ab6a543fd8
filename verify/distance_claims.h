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

/// Which distances: those below a length, or at most the length.
enum class Bound : std::uint8_t { below, at_most };

/// Every pair of triangles whose distance is below `length`, or at most `length`, as `bound` says,
/// has to be among the answers.
struct Threshold {
  std::optional<Length> length;  // none: infinite, so all pairs
  Bound bound = Bound::below;
};
/// Whether the distance is the root of `squared`, rounded to the nearest double (to the even one of
/// two equally near doubles).
bool is_rounded_root(double distance, const Fraction& squared);

class DistanceClaims {
 public:
  /// Throws std::logic_error as account_distances().
  DistanceClaims(const Scene& scene, std::span<const ClaimedDistance> answers,
                 const DistanceQuestion& question);

  /// Within this distance every pair of triangles of the objects a <= b has to be an answer.
  Threshold threshold(std::uint32_t a, std::uint32_t b) const;
  /// The answers of the objects a <= b.
  std::span<const ClaimedDistance> of(std::uint32_t a, std::uint32_t b) const;
  /// Whether objects a <= b are asked about.
  bool asked(std::uint32_t a, std::uint32_t b) const;
  /// How many answers are wrong, in themselves or because of other answers (not one of the k
  /// nearest).
  std::uint64_t wrong(unsigned threads) const;

 private:
  struct Farthest {  // the kth nearest neighbour of an object
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
  std::vector<Farthest> farthest_;                // of each object; filled for `nearest` alone
  IntegerInside insides_;
};

}  // namespace farcull
