// Predicts how many colliding pairs a method that draws misses, before anything is drawn. The
// formula is derived in docs/misses.md.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>

#include "core/scene/scene.h"
#include "experiments/method/plan.h"

namespace farcull {

/// How many pairs are missed, if all positions of the pixel grid are equally likely.
struct MissPrediction {
  std::uint64_t colliding = 0;  // pairs
  double missed = 0;            // on average
  double deviation = 0;         // standard deviation over the positions

  /// The interval for the misses of one run: two deviations and the error of the model either way.
  double low() const;
  double high() const;
};

/// Why there is no prediction for a method with these options; empty if there is one. A method with
/// a guarantee misses nothing and needs none.
std::string why_unpredicted(const RunOptions& options);

/// The misses of a plan, or why they are not predicted. For a method that guarantees to miss
/// nothing, both are empty.
struct MissesOfPlan {
  std::optional<MissPrediction> predicted;
  std::string why_not;
};
/// Finds the colliding pairs by exact tests, and predicts the misses.
MissesOfPlan misses_of(const Scene& scene, const Plan& plan);
/// A line for people: "misses     46 of 203 colliding pairs expected, 30 to 70"; empty for a method
/// with a guarantee.
std::string misses_line(const MissesOfPlan& misses);

/// How closely centre_probability() follows its bound min(1, area, width, height); infinite: it
/// equals the bound. Fitted to random triangles on random grids, not to any scene.
constexpr double kMissSharpness = 3.5;
/// The probability that a region holds a pixel centre, if all positions of the grid are equally
/// likely. The region was fattened by a disc of `radius` px; area (px^2), width and height (px)
/// include this.
double centre_probability(double area, double width, double height, double radius = 0,
                          double sharpness = kMissSharpness);

/// The prediction for a plan; empty if too many images of triangles overlap to go through them.
/// colliding: the colliding pairs of the scene, without ignored ones. Precondition:
/// why_unpredicted(options) is empty and no object is tested against itself.
std::optional<MissPrediction> predict_misses(const Scene& scene, const DrawPlan& work,
                                             const RunOptions& options,
                                             std::span<const TrianglePair> colliding,
                                             double sharpness = kMissSharpness);

}  // namespace farcull
