// Predicts how many colliding pairs are missed by methods that draw triangles on a pixel grid.
// docs/misses.md derives the formula.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>

#include "core/scene/scene.h"
#include "experiments/method/plan.h"

namespace farcull {

/// Predicted number of missed pairs. All positions of the pixel grid are assumed equally likely.
struct MissPrediction {
  std::uint64_t colliding = 0;  // number of colliding pairs in the scene
  double missed = 0;            // mean number of missed pairs
  double deviation = 0;         // standard deviation of the number of missed pairs

  /// Bounds of the interval in which the number of missed pairs of one run is expected. The margin
  /// on each side is the error of the model plus two standard deviations.
  double low() const;
  double high() const;
  /// True if at most 40 % of the pairs are expected to be missed. Beyond, runs were outside the
  /// interval more often than it says (docs/results/misses.md).
  bool judged() const { return missed <= 0.4 * static_cast<double>(colliding); }
};

/// Returns why there is no prediction for these options, for example because the method misses no
/// pair. Returns "" if there is a prediction.
std::string why_unpredicted(const RunOptions& options);

/// The predicted misses of a plan, or why there is no prediction. If the method guarantees to miss
/// no pair or draws nothing, both members are empty.
struct MissesOfPlan {
  std::optional<MissPrediction> predicted;
  std::string why_not;
};
/// Finds the colliding pairs by exact tests. Then predicts how many of these pairs are missed.
MissesOfPlan misses_of(const Scene& scene, const Plan& plan);
/// Returns a line of text: "misses     46 of 203 colliding pairs expected, 30 to 70".
/// Returns "" for a method with a guarantee.
std::string misses_line(const MissesOfPlan& misses);

/// Default of the parameter `sharpness` of centre_probability(). A larger value gives a probability
/// closer to its upper bound min(1, area, width, height). The value was fitted to random triangles.
constexpr double kMissSharpness = 3.5;
/// Returns the probability that a region contains a pixel centre, if all positions of the grid are
/// equally likely. area: px^2. width, height: px. radius: px, radius of the disc by which the
/// region was dilated; 0: not dilated. area, width and height are those of the dilated region.
double centre_probability(double area, double width, double height, double radius = 0,
                          double sharpness = kMissSharpness);

/// Returns the prediction for a plan. Returns nothing if too many projected triangles overlap.
/// colliding: the colliding pairs of the scene, without ignored pairs. Preconditions:
/// why_unpredicted(options) is "", and no object is tested against itself.
std::optional<MissPrediction> predict_misses(const Scene& scene, const DrawPlan& work,
                                             const RunOptions& options,
                                             std::span<const TrianglePair> colliding,
                                             double sharpness = kMissSharpness);

}  // namespace farcull
