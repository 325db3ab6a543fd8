// Implements Canvas with OpenGL 4.3. Draws proxies or triangles from storage buffers into a depth
// texture. Each slot (index of a result of a pass) has an occlusion query, or a flag that the
// fragment program sets.
#pragma once

#include <bit>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "core/canvas/canvas.h"
#include "core/gl/base/context.h"

namespace farcull {

enum class DepthFormat { float32, fixed24 };
/// How the canvas decides whether a slot is seen in a visibility test (Verb::ask).
/// - flags: a fragment that is seen sets its slot's flag. The shader compares the depths of proxies
///   (float32 only: equal depths may differ in a 24-bit texture). For triangles at fixed depth,
///   early fragment tests decide.
/// - occlusion: a GL_ANY_SAMPLES_PASSED query for each slot, as published.
enum class QueryMode { flags, occlusion };

/// Returns the define for a canvas.frag that tests visibility. behind: the slack, as exact bits.
inline std::string ask_define(float behind = kAskedBehind) {
  return "FAR_ASK uintBitsToFloat(" + std::to_string(std::bit_cast<std::uint32_t>(behind)) + "u)";
}

struct GlCanvasOptions {
  DepthFormat depth_format = DepthFormat::float32;
  QueryMode query = QueryMode::flags;
  /// True: triangles have a fragment in each pixel that they touch. Needs GL_NV_conservative_raster
  /// or GL_INTEL_conservative_rasterization.
  bool conservative = false;
  /// Largest size of a storage block in bytes. 0: the device's own limit.
  long storage_limit = 0;
};

struct CanvasState;

class GlCanvas final : public Canvas {
 public:
  /// `mode` and `solid` are those of the fattener that makes the drawables. Throws Error if the
  /// options contradict each other or the device refuses. The context must outlive the canvas. Each
  /// call makes the context current. If begin(), run(), samples() or depths() throws, all data on
  /// the device are deleted. The other functions then throw std::logic_error until the next
  /// begin().
  GlCanvas(const GlContext& context, DepthMode mode, const SolidProgram& solid,
           const GlCanvasOptions& options = {});
  ~GlCanvas() override;

  const RasterLimits& limits() const override { return limits_; }
  void begin(const Window& window, const Drawables& drawables) override;
  std::vector<std::uint8_t> run(const Pass& pass) override;
  std::vector<float> samples(Verb verb, const std::vector<Draw>& draws) override;
  std::vector<float> depths(Verb verb, const std::vector<Draw>& draws) override;

  CanvasWork work() const override;

 private:
  void forget();
  void require_begun(const char* function) const;
  template <class Work>
  auto guarded(const Work& work);

  const GlContext& context_;
  DepthMode mode_;
  std::string solid_;  // GLSL
  GlCanvasOptions options_;
  RasterLimits limits_;
  std::unique_ptr<CanvasState> state_;  // null after a failure
  CanvasWork earlier_;                  // work of states that were deleted
};

std::unique_ptr<Canvas> gl_canvas(const GlContext& context, DepthMode mode,
                                  const SolidProgram& solid, const GlCanvasOptions& options = {});

}  // namespace farcull
