// The canvas on the CPU, without device and driver. Every thread draws all steps of a pass, in
// order, in its own rows of the window. So the results do not depend on the number of threads. Each
// operation is rounded once, so all instruction sets (lane_targets()) give the same bits, too.
//
// For proxies this canvas guarantees more than OpenGL (docs/budget.md, "The canvas on the CPU"):
// samples lie at pixel centres, corners are not snapped, and the arithmetic is IEEE 754. Raw
// triangles follow OpenGL's rules (draw_triangles_native) and give no guarantee.
//
// NativeJob, the work of one thread, is plain data, because functions compiled for different
// instruction sets use it.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "core/canvas/canvas.h"

namespace farcull {

/// The depth buffer has this many extra columns and rows. A block of pixels may begin inside the
/// window and end outside. A block is read and written as a whole. Without extra columns, such a
/// block would include pixels of the next row, which may belong to another thread.
inline constexpr int kNativeOverhang = 8;

/// The output of a job. run: the slots that are seen in a pass. values: depths in px, the nearest
/// of each pixel for Verb::store, the farthest for Verb::ask. depths: the same depths, as the depth
/// buffer holds them (mapped and rounded).
enum class NativeOutput : std::uint8_t { run, values, depths };

/// The work of one thread: it draws the steps of a pass, in order, in rows [y0, y1) of a window.
struct NativeJob {
  int width, height;  // px
  int stride;         // floats from row to row of the buffer; at least width + kNativeOverhang
  int y0, y1;
  float scale;        // scale of the depth map (depth_scale())
  bool fixed24;       // the buffer rounds depths to multiples of 1 / (2^24 - 1)
  bool conservative;  // triangles have a fragment in each pixel that they touch
  const Drawables* drawables;
  const ProxyOutline* outlines;  // one per proxy
  const PixelRange* ranges;      // one per triangle
  NativeOutput output;
  bool touching;
  const Step* steps;
  std::uint32_t step_count;
  const Draw* draws;
  float* depth;        // height + kNativeOverhang rows of stride floats
  std::uint8_t* seen;  // one per slot; threads only write 1, so their order is irrelevant
};

/// `count` lines in depth direction at (cx, cy) px, and a kernel's results. hit: 0 or 1.
struct NativeLines {
  const Solid* solid;
  std::uint32_t count;
  const float* cx;
  const float* cy;
  std::uint8_t* hit;
  float* entry;
  float* exit;
};

/// Draws raw triangles, as CULLIDE does, by OpenGL's rules: corners are snapped to 8 subpixel bits,
/// the top-left rule decides on pixel centres that lie on an edge, and depth is interpolated from
/// the corners. Raw triangles give no guarantee.
///
/// With `conservative`, as in GL_NV_conservative_raster, a triangle has a fragment in every pixel
/// whose closed square the snapped triangle touches. The fragment's depth is the depth of the
/// triangle's plane at the pixel centre, clamped to the range of the corners' depths. If the image
/// of the triangle is a segment or a point, the depth is the middle of that range. A fragment has
/// one depth, but the triangle has a range of depths in the pixel, so pairs can still be missed.
void draw_triangles_native(const NativeJob& job);
constexpr int kNativeSubpixelBits = 8;

struct NativeCanvasOptions {
  int depth_bits = 32;  // 32: float; 24: rounded to the nearest multiple of 1 / (2^24 - 1)
  /// Raw triangles have a fragment in every pixel that they touch (draw_triangles_native).
  bool conservative = false;
  unsigned threads = 0;  // 0: one per core
};

RasterLimits native_limits(int depth_bits = 32);

class NativeCanvas final : public Canvas {
 public:
  /// `mode` and `solid` are those of the fattener that makes the drawables. Throws std::logic_error
  /// if proxies are drawn and the solid has no function for lanes. Throws Error for depth bits
  /// other than 24 and 32.
  NativeCanvas(DepthMode mode, const SolidProgram& solid, const NativeCanvasOptions& options = {});

  const RasterLimits& limits() const override { return limits_; }
  bool fits_proxies() const override { return true; }
  /// Throws std::logic_error for drawables of another mode, and for a side above 16380 px.
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
  const Drawables* drawables_ = nullptr;  // the caller keeps them until the next begin()
  std::vector<PixelRange> ranges_;        // one per triangle
  std::vector<ProxyOutline> outlines_;    // one per proxy; empty if the drawables contain outlines
  std::vector<std::uint64_t> work_;       // work_[y]: number of elements with middle row < y
  int stride_ = 0;
  std::vector<float> depth_;
};

// The functions below list and select instruction sets for the canvas on the CPU (lanes.cpp).

/// Returns the names of usable instruction sets, the best first, such as "AVX3", "AVX2" or "SSE4".
/// "SCALAR" and "EMU128" are plain C++.
std::vector<std::string> lane_targets();
std::string lane_target();
/// Selects one of lane_targets() for all threads. An empty name selects the best. The results do
/// not depend on the selection. Must not be called during a draw. Throws Error for an instruction
/// set that this processor lacks.
void use_lane_target(const std::string& name);

}  // namespace farcull
