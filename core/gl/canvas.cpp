// GlCanvas owns a CanvasState and forgets it after any failure, so that nothing that lies on the
// device is believed then.
#include "core/gl/canvas.h"

#include <algorithm>
#include <bit>
#include <stdexcept>
#include <utility>

#include "core/base/error.h"
#include "core/gl/canvas_state.h"

namespace farcull {

// Runs `work` with the context current and the state there; after a failure nothing that lies on
// the device is believed.
template <class Work>
auto GlCanvas::guarded(const Work& work) {
  const GlCurrent current(context_);
  try {
    if (!state_) state_ = std::make_unique<CanvasState>(context_, mode_, solid_, options_);
    return work();
  } catch (...) {
    forget();
    throw;
  }
}

GlCanvas::GlCanvas(const GlContext& context, DepthMode mode, const SolidProgram& solid,
                   const GlCanvasOptions& options)
    : context_(context), mode_(mode), solid_(solid.glsl), options_(options) {
  if (options.query == QueryMode::flags && options.depth_format == DepthFormat::fixed24) {
    throw Error("{query}",
                "flags cannot be used with a 24-bit depth buffer: a comparison in the shader loses "
                "equal depths",
                "use {query} occlusion or {depth_format} 32f");
  }
  if (options.conservative && mode == DepthMode::fragment)
    throw std::logic_error("GlCanvas: proxies are not drawn conservatively");
  const GlCurrent current(context);
  const GlInfo& info = context.info();
  limits_.subpixel_bits = info.subpixel_bits;
  limits_.depth_bits = options.depth_format == DepthFormat::float32 ? 32 : 24;
  GLint framebuffer[2] = {0, 0};
  glGetIntegerv(GL_MAX_FRAMEBUFFER_WIDTH, &framebuffer[0]);
  glGetIntegerv(GL_MAX_FRAMEBUFFER_HEIGHT, &framebuffer[1]);
  // A window is up to five pixels wider than its resolution (fit_window), and its viewport side a
  // power of two.
  const int viewport = static_cast<int>(std::bit_floor(static_cast<unsigned>(info.max_viewport)));
  limits_.max_resolution =
      std::min({viewport, info.max_texture_size, framebuffer[0], framebuffer[1]}) - 2 * kBorder - 6;
  guarded([] { return 0; });
}

GlCanvas::~GlCanvas() { forget(); }

const RasterLimits& GlCanvas::limits() const { return limits_; }

// Everything on the device is deleted, or where the context cannot be had, left to go with it.
void GlCanvas::forget() {
  if (state_) earlier_ += std::exchange(state_->work, {});
  try {
    const GlCurrent current(context_);
    for (const GLenum target : {GL_PRIMITIVES_GENERATED, GL_ANY_SAMPLES_PASSED}) {
      GLint open = 0;
      glGetQueryiv(target, GL_CURRENT_QUERY, &open);
      if (open != 0) glEndQuery(target);
    }
    state_.reset();
    // Errors of the deleted objects concern nobody. A lost context may report errors without end.
    for (int i = 0; i < 16 && glGetError() != GL_NO_ERROR; ++i) {
    }
  } catch (const Error&) {
    static_cast<void>(state_.release());
  }
}

CanvasWork GlCanvas::work() const {
  CanvasWork all = earlier_;
  if (state_) all += state_->work;
  return all;
}

void GlCanvas::require_begun(const char* function) const {
  if (state_ && state_->begun) return;
  throw std::logic_error(std::string("GlCanvas::") + function +
                         ": begin() must come first, and again after any exception");
}

void GlCanvas::begin(const Window& window, const Drawables& drawables) {
  if (drawables.mode != mode_)
    throw std::logic_error("GlCanvas::begin: drawables of another depth mode");
  if (state_) state_->begun = false;
  guarded([&] { state_->begin(window, drawables); });
}

std::vector<std::uint8_t> GlCanvas::run(const Pass& pass) {
  require_begun("run");
  if (pass.steps.empty()) return std::vector<std::uint8_t>(pass.slots);
  return guarded([&] { return state_->run(pass); });
}

std::vector<float> GlCanvas::depths(Verb verb, const std::vector<Draw>& draws) {
  require_begun("depths");
  return guarded([&] { return state_->depths(verb, draws); });
}

std::vector<float> GlCanvas::samples(Verb verb, const std::vector<Draw>& draws) {
  if (mode_ != DepthMode::fragment) throw std::logic_error("GlCanvas::samples: proxies only");
  require_begun("samples");
  return guarded([&] { return state_->samples(verb, draws); });
}

std::unique_ptr<Canvas> gl_canvas(const GlContext& context, DepthMode mode,
                                  const SolidProgram& solid, const GlCanvasOptions& options) {
  return std::make_unique<GlCanvas>(context, mode, solid, options);
}

}  // namespace farcull
