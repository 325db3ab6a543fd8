// The canvas on the cores of the CPU: no device and no driver. Every thread draws all steps of a
// pass, in order, on its rows of the window, so any number of threads gives the same bits. So does
// every instruction set (lane_targets()), since all round each operation once.
//
// For proxies it guarantees more than OpenGL does (docs/budget.md, "The canvas on the CPU"):
// samples lie at pixel centres, nothing is snapped, and the arithmetic is IEEE 754. Raw triangles
// follow OpenGL's rules (draw_triangles_native) and give no guarantee.
//
// The job of one thread comes first. It is plain data, so that functions compiled for any
// instruction set can take it.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "core/canvas/canvas.h"

namespace farcull {

/// Extra columns and rows of the buffer, behind the window's last: a block begins inside the
/// window, but reads and writes back all its pixels. Without the extra columns it would write to
/// the next row, which may be another thread's.
inline constexpr int kNativeOverhang = 8;

/// run: a pass. values: the depths in px that a store leaves (the nearest) or an ask (the
/// farthest). depths: these values as the depth buffer holds them.
enum class NativeOutput : std::uint8_t { run, values, depths };

/// The rows [y0, y1) of a window, and the steps of a pass that a thread draws there, in order.
struct NativeJob {
  // The window.
  int width, height;  // px
  int stride;         // floats from row to row of the buffer; width + kNativeOverhang or more
  int y0, y1;
  float scale;        // of the depth map (depth_scale())
  bool fixed24;       // depths are held as whole multiples of 1 / (2^24 - 1), rounded
  bool conservative;  // triangles have a fragment in each pixel that they touch
  // The elements.
  const Drawables* drawables;
  const ProxyOutline* outlines;  // per proxy
  const PixelRange* ranges;      // per triangle
  // The pass.
  NativeOutput output;
  bool touching;
  const Step* steps;
  std::uint32_t step_count;
  const Draw* draws;
  float* depth;        // height + kNativeOverhang rows of stride floats
  std::uint8_t* seen;  // per slot; shared by all threads, which only ever write 1
};

/// `count` lines along the depth through one solid, for the solid's kernel on lanes. cx, cy: px;
/// hit: 0 or 1.
struct NativeLines {
  const Solid* solid;
  std::uint32_t count;
  const float* cx;
  const float* cy;
  std::uint8_t* hit;
  float* entry;
  float* exit;
};

/// Draws raw triangles by the fixed rules of OpenGL: corners snapped to 8 subpixel bits, pixel
/// centres inside by the top-left rule, depth interpolated from the corners. CULLIDE draws them.
/// They give no guarantee.
///
/// With `conservative`, as GL_NV_conservative_raster: a fragment in every pixel whose closed square
/// the snapped triangle touches, however small or thin it is. Its depth is that of the triangle's
/// plane at the pixel's centre, limited to the depths of its corners; if the triangle's image is a
/// segment or a point, the middle of these depths. So a fragment has one depth, but the triangle
/// has a range of depths in the pixel, so pairs can still be missed.
void draw_triangles_native(const NativeJob& job);
constexpr int kNativeSubpixelBits = 8;

// ---- the canvas ----

struct NativeCanvasOptions {
  int depth_bits = 32;  // 32: float; 24: rounded to the nearest multiple of 1 / (2^24 - 1)
  /// For raw triangles: a fragment in every pixel that one touches (draw_triangles_native).
  bool conservative = false;
  unsigned threads = 0;  // 0: as many as there are cores
};

/// The limits of this canvas, for the budget.
RasterLimits native_limits(int depth_bits = 32);

class NativeCanvas final : public Canvas {
 public:
  /// `mode` and `solid`: those of the fattener that makes the drawables. Throws std::logic_error if
  /// a solid for proxies has no function on lanes, Error for depth bits other than 24 and 32.
  NativeCanvas(DepthMode mode, const SolidProgram& solid, const NativeCanvasOptions& options = {});

  const RasterLimits& limits() const override { return limits_; }
  bool fits_proxies() const override { return true; }
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
  std::vector<PixelRange> ranges_;        // per triangle
  std::vector<ProxyOutline> outlines_;    // per proxy, if all are fitted
  std::vector<std::uint64_t> work_;       // per row: elements whose middle row is before it
  int stride_ = 0;
  std::vector<float> depth_;
};

// The instruction sets that the native canvas can use on this processor (lanes.cpp).

/// Best first, such as "AVX3", "AVX2", "SSE4", "SCALAR" or "EMU128"; the last is plain C++.
std::vector<std::string> lane_targets();
/// The instruction set in use.
std::string lane_target();
/// Uses another one of lane_targets() from now on, in all threads; "": the best. No bit of an
/// answer depends on it. Must not be called while something is drawn. Throws Error for an
/// instruction set that this processor lacks.
void use_lane_target(const std::string& name);

}  // namespace farcull
