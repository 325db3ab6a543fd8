// The canvas on the cores of the CPU: no device and no driver. Every thread draws all steps of a
// pass, in order, on its rows of the window, so any number of threads gives the same bits; so does
// every instruction set (core/native/lanes.h), since each operation is rounded once on all of them.
//
// For proxies it promises more than OpenGL does (docs/budget.md, "The canvas on the CPU"): samples
// lie at pixel centres, nothing is snapped, and the arithmetic is IEEE 754. Raw triangles follow
// OpenGL's rules (core/native/job.h) and promise nothing.
#pragma once

#include <cstdint>
#include <vector>

#include "core/canvas/canvas.h"
#include "core/native/job.h"

namespace farcull {

struct NativeCanvasOptions {
  int depth_bits = 32;  // 32: float; 24: rounded to the nearest multiple of 1 / (2^24 - 1)
  /// For raw triangles: every pixel that one touches has a fragment (core/native/job.h).
  bool conservative = false;
  unsigned threads = 0;  // 0: as many as there are cores
};

/// The limits of this canvas, for the budget.
RasterLimits native_limits(int depth_bits = 32);

class NativeCanvas final : public Canvas {
 public:
  /// `mode` and `solid` as in the fattener whose drawables will come. Throws std::logic_error where
  /// proxies come without their function on lanes, Error for other depth bits than 24 and 32.
  NativeCanvas(DepthMode mode, const SolidProgram& solid, const NativeCanvasOptions& options = {});

  const RasterLimits& limits() const override { return limits_; }
  /// Throws std::logic_error for drawables of the other mode and windows beyond 16380 px.
  void begin(const Window& window, const Drawables& drawables) override;
  std::vector<std::uint8_t> run(const Pass& pass) override;
  std::vector<float> samples(Verb verb, const std::vector<Draw>& draws) override;
  std::vector<float> depths(Verb verb, const std::vector<Draw>& draws) override;

 private:
  NativeJob job(NativeOutput output, float empty);
  void draw(const NativeJob& job, const Pass& pass);
  std::vector<float> gather(NativeOutput output, Verb verb, const std::vector<Draw>& draws,
                            float empty);

  DepthMode mode_;
  void (*draw_rows_)(const NativeJob& job);
  NativeCanvasOptions options_;
  RasterLimits limits_;
  Window window_;
  const Drawables* drawables_ = nullptr;  // the caller's, until the next begin
  std::vector<PixelRange> ranges_;        // per element
  std::vector<std::uint64_t> work_;       // per row: elements whose middle row is before it
  int stride_ = 0;
  std::vector<float> depth_;
};

}  // namespace farcull
