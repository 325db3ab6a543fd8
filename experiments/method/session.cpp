// Opens devices, contexts and canvases when they are needed.
#include "experiments/method/session.h"

#include <cstdio>

#include "core/base/error.h"
#include "core/base/text.h"
#include "experiments/method/options.h"

namespace farcull {

Say say_on_stderr() {
  return [](const std::string& line) {
    std::fprintf(stderr, "%sfarcull: %s\n", is_terminal(stderr) ? "\r\033[K" : "", line.c_str());
  };
}

const GlContext& Session::context() {
  if (!context_) context_ = std::make_unique<GlContext>(device_ == "gl" ? "" : device_);
  return *context_;
}

const DeviceVerdict& Session::verdict() {
  if (!verdict_) {
    const Probes probes = [this] { return all_probes(context(), {}, true); };
    verdict_ = device_verdict(context().info(), probes, say_);
  }
  return *verdict_;
}

const CanvasDevice& Session::canvas_device() {
  if (!canvas_device_) canvas_device_ = choose_device();
  return *canvas_device_;
}

// Chooses GL or the CPU. Without a named device, GL is chosen only if a GPU passes the probes.
CanvasDevice Session::choose_device() {
  const std::string named = spelled("{device} ") + device_;
  if (is_cpu(device_)) return {true, named};
  if (!device_.empty()) return {false, named};
  try {
    if (!GlContext::hardware_listed()) return {true, "no GPU was found"};
    if (context().info().kind != "hardware") return {true, "no GPU could be opened"};
    if (!verdict().holds) return {true, "the GPU failed a probe"};
    return {false, "a GPU answered"};
  } catch (const Error& error) {
    return {true, "no GPU can be used: " + error.where + ": " + error.reason};
  }
}

Canvas& Session::canvas(const Fattener& fattener, const GlCanvasOptions& options) {
  std::unique_ptr<Canvas>& canvas =
      canvases_[{fattener.name, options.depth_format, options.query, options.conservative}];
  if (canvas) return *canvas;
  if (canvas_device().native) {
    canvas = std::make_unique<NativeCanvas>(
        fattener.mode, fattener.solid,
        NativeCanvasOptions{.depth_bits = options.depth_format == DepthFormat::fixed24 ? 24 : 32,
                            .conservative = options.conservative,
                            .threads = threads_});
  } else {
    canvas = gl_canvas(context(), fattener.mode, fattener.solid, options);
  }
  return *canvas;
}

int Session::max_resolution() {
  if (canvas_device().native) return native_limits().max_resolution;
  return gl_canvas(context(), DepthMode::fixed, {})->limits().max_resolution;
}

void Session::forget_device() {
  canvases_.clear();
  context_.reset();
  verdict_.reset();  // the next context may be on another device
  canvas_device_.reset();
  frame_memory_ = {};
  if (frames_) remember_frames();
}

}  // namespace farcull
