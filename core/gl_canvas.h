// The canvas on OpenGL 4.3: a depth texture, proxies or triangles fetched from storage buffers, and
// the full-visibility query either as an occlusion query per slot or as a flag that the fragment
// program raises.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "core/canvas.h"
#include "core/gl_context.h"

namespace farcull {

enum class DepthFormat { float32, fixed24 };
/// flags: an asked fragment raises its slot's flag. Proxies compare with the stored depth in the
/// shader (float32 only: a comparison with a texel of a 24-bit texture loses equal depths);
/// triangles at fixed depth rely on early fragment tests. occlusion: GL_ANY_SAMPLES_PASSED, many in
/// flight, as published.
enum class QueryMode { flags, occlusion };

/// Faults for tests and `farcull doctor`, each applied to the next pass; a pass must notice every
/// one (assumption A7), and begin() come again after it.
enum class Fault {
  none,
  lost_draw,              // the draw call of a step never runs
  oversized_dispatch,     // a compute dispatch beyond the device's limit
  unfinished_invocation,  // a compute invocation ends early
  lost_query,             // an occlusion query is never issued
  blind_query,            // the occlusion queries of a batch answer zero
};

struct GlCanvasOptions {
  DepthFormat depth_format = DepthFormat::float32;
  QueryMode query = QueryMode::flags;
  bool reversed_depth_test = false;  // a deliberate defect, for the twins of the reliability tests
  long storage_limit =
      0;  // bytes; as if a storage block held no more than this. 0: the device's own limit
};

class GlCanvas final : public Canvas {
 public:
  /// `mode` and `solid` as in the fattener whose drawables will come. Throws Error where the
  /// options do not go together or the device refuses. The context must outlive the canvas, which
  /// makes it current for each of its calls. After any exception of begin(), run(), samples() or
  /// depths() all that lies on the device is dropped; the next begin() makes it anew, and the
  /// others throw std::logic_error before it.
  GlCanvas(const GlContext& context, DepthMode mode, const SolidProgram& solid,
           const GlCanvasOptions& options = {});
  ~GlCanvas() override;

  const RasterLimits& limits() const override;
  void begin(const Window& window, const Drawables& drawables) override;
  std::vector<std::uint8_t> run(const Pass& pass) override;
  std::vector<float> samples(Verb verb, const std::vector<Draw>& draws) override;

  std::vector<float> depths(Verb verb, const std::vector<Draw>& draws) override;

  void inject(Fault fault);

 private:
  struct State;
  void forget();
  void require_begun(const char* function) const;
  template <class Work>
  auto guarded(const Work& work);

  const GlContext& context_;
  DepthMode mode_;
  std::string solid_;  // GLSL
  GlCanvasOptions options_;
  RasterLimits limits_;
  Fault fault_ = Fault::none;
  std::unique_ptr<State> state_;  // null after a failure
};

}  // namespace farcull
