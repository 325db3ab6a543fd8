// A canvas without a GPU that satisfies the device assumptions (docs/reliability.md). If the
// assumptions allow several results, the canvas takes the worst result for culling. It models the
// steps of a coordinate through a rasterizer, without the terms of the error budget.
#pragma once

#include <cstdint>
#include <vector>

#include "core/canvas/canvas.h"

namespace farcull {

struct WorstCanvasOptions {
  int subpixel_bits = 8;
  /// 32: depths are stored as computed floats. 24: depths are rounded to multiples of 2^-24.
  int depth_bits = 32;
  int max_resolution = 16370;
  /// True: the canvas gives only the guarantees of core/native/canvas.h. Corners are not moved, but
  /// the floats that compare a pixel centre with an edge are rounded as badly as IEEE 754 allows.
  bool exact_samples = false;
  /// An asked depth lies this far behind D(exit), the mapped exit depth, as on a GL device. Tests
  /// set a smaller value, to show that culling then misses pairs.
  float asked_behind = kAskedBehind;
  /// 0: each program rounds depths the worst way: stored depths up, asked depths down. Otherwise a
  /// seed: each program rounds each depth up or down at random.
  std::uint64_t rounding_seed = 0;
};

/// How the canvas draws (A1 to A6 are the device assumptions):
/// - Proxies (A1 to A4). The vertex stage, the division by w, the viewport transform and snapping
///   round the corners of a quadrilateral. A pixel gets a fragment only if its centre is strictly
///   inside the quadrilateral for all these roundings.
/// - Solids (SolidProgram::interval_worst). A fragment is discarded if any rounding discards it.
///   The entry is the latest, and the exit the earliest, over all roundings.
/// - Depths (A4, A5). Storing and asking are two programs. Each program rounds the depths, and
///   converts them to 24 bits, in its own direction. With exact_samples both programs round to
///   nearest, as the native canvas does. A query sees exactly the fragments that pass (A6).
/// - Triangles (fixed depth) are sampled at pixel centres without displacement. Both programs round
///   depths alike. The assumptions do not cover triangles.
class WorstCanvas final : public Canvas {
 public:
  explicit WorstCanvas(const SolidProgram& solid, const WorstCanvasOptions& options = {});

  const RasterLimits& limits() const override { return limits_; }
  void begin(const Window& window, const Drawables& drawables) override;
  std::vector<std::uint8_t> run(const Pass& pass) override;
  std::vector<float> samples(Verb verb, const std::vector<Draw>& draws) override;
  std::vector<float> depths(Verb verb, const std::vector<Draw>& draws) override;

 private:
  bool covers(const Proxy& proxy, double orientation, double cx, double cy) const;
  void rasterize(std::uint32_t element, Verb verb, const auto& visit) const;
  float held(float z) const;
  float held(float z, Verb verb) const;

  SolidProgram solid_;
  WorstCanvasOptions options_;
  RasterLimits limits_;
  Window window_;
  const Drawables* drawables_ = nullptr;  // the caller's object, valid until the next begin()
};

}  // namespace farcull
