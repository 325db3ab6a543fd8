// Predicts how many colliding pairs a method that draws will miss. docs/misses.md derives the
// formula.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>

#include "core/scene/scene.h"
#include "experiments/method/plan.h"

namespace farcull {

/// The number of missed pairs, if all positions of the pixel grid are equally likely.
struct MissPrediction {
  std::uint64_t colliding = 0;  // number of colliding pairs
  double missed = 0;            // mean number of missed pairs
  double deviation = 0;         // standard deviation of the number of missed pairs

  /// The interval in which the misses of one run are expected. On each side it includes two
  /// standard deviations and the error of the model.
  double low() const;
  double high() const;
  /// True if at most 40 % of the pairs are expected to be missed. Beyond, runs were outside the
  /// interval more often than it says (docs/results/misses.md).
  bool judged() const { return missed <= 0.4 * static_cast<double>(colliding); }
};

/// Returns why there is no prediction for these options, for example because the method misses
/// nothing. Returns "" if there is a prediction.
std::string why_unpredicted(const RunOptions& options);

/// The predicted misses of a plan, or why there is no prediction. For a method that guarantees to
/// miss nothing, `predicted` and `why_not` are empty.
struct MissesOfPlan {
  std::optional<MissPrediction> predicted;
  std::string why_not;
};
/// Finds the colliding pairs by exact tests, and predicts the misses.
MissesOfPlan misses_of(const Scene& scene, const Plan& plan);
/// Returns a line of text: "misses     46 of 203 colliding pairs expected, 30 to 70".
/// Returns "" for a method with a guarantee.
std::string misses_line(const MissesOfPlan& misses);

/// Determines how close centre_probability() is to its upper bound min(1, area, width, height). An
/// infinite value gives the bound itself. The value was fitted to random triangles on random grids.
constexpr double kMissSharpness = 3.5;
/// Returns the probability that a region contains a pixel centre, if all positions of the grid are
/// equally likely. area: px^2. width, height: px. radius: px, of a disc by which the region was
/// fattened; area, width and height are those of the fattened region.
double centre_probability(double area, double width, double height, double radius = 0,
                          double sharpness = kMissSharpness);

/// Returns the prediction for a plan; nothing if too many images of triangles overlap. colliding:
/// the colliding pairs of the scene, without ignored pairs. Precondition: why_unpredicted(options)
/// is empty, and no object is tested against itself.
std::optional<MissPrediction> predict_misses(const Scene& scene, const DrawPlan& work,
                                             const RunOptions& options,
                                             std::span<const TrianglePair> colliding,
                                             double sharpness = kMissSharpness);

}  // namespace farcull
