// Implements Canvas with OpenGL 4.3. Draws proxies or triangles from storage buffers into a depth
// texture. The result for a slot comes from an occlusion query, or from a flag that the fragment
// shader sets.
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
/// - flags: a visible fragment sets the flag of its slot. For proxies, the shader compares depths.
///   This needs float32, because equal depths may differ in a 24-bit texture. For triangles, the
///   early depth test decides.
/// - occlusion: a GL_ANY_SAMPLES_PASSED query for each slot, as in the papers.
enum class QueryMode { flags, occlusion };

/// Returns the macro definition with which canvas.frag tests visibility. behind: the slack.
inline std::string ask_define(float behind = kAskedBehind) {
  return "FAR_ASK uintBitsToFloat(" + std::to_string(std::bit_cast<std::uint32_t>(behind)) + "u)";
}

struct GlCanvasOptions {
  DepthFormat depth_format = DepthFormat::float32;
  QueryMode query = QueryMode::flags;
  /// True: a triangle gets a fragment in each pixel that it touches. Needs the GL extension
  /// GL_NV_conservative_raster or GL_INTEL_conservative_rasterization. Only for DepthMode::fixed.
  bool conservative = false;
  /// Largest allowed size of a storage block in bytes. 0: the limit of the device.
  long storage_limit = 0;
};

struct CanvasState;

class GlCanvas final : public Canvas {
 public:
  /// mode, solid: members of the fattener that makes the drawables. Throws Error if the options
  /// contradict each other or the device does not support them. The context must outlive the
  /// canvas. Each function makes the context current during the call. If begin(), run(), samples()
  /// or depths() throws, all data on the device are deleted. After that, run(), samples() and
  /// depths() throw std::logic_error until begin() is called again.
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
  CanvasWork earlier_;                  // work of all deleted states
};

std::unique_ptr<Canvas> gl_canvas(const GlContext& context, DepthMode mode,
                                  const SolidProgram& solid, const GlCanvasOptions& options = {});

}  // namespace farcull
