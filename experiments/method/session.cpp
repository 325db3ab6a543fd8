// Contexts, canvases and devices are opened on demand.
#include "experiments/method/session.h"

#include <cstdio>

#include "core/base/error.h"
#include "core/base/text.h"
#include "core/gl/pairs/pairs.h"
#include "core/pairs/backend.h"
#include "experiments/method/device_verdict.h"
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

const DeviceVerdict& Session::verdict(Reliance reliance) {
  const auto known = verdicts_.find(reliance);
  if (known != verdicts_.end()) return known->second;
  const Probes probes = [this, reliance] {
    return reliance == Reliance::pairs ? pair_probes(context()) : drawing_probes(context());
  };
  return verdicts_.emplace(reliance, device_verdict(context().info(), reliance, probes, say_))
      .first->second;
}

const CanvasDevice& Session::canvas_device() {
  if (!canvas_device_) canvas_device_ = choose_device([] {}, true);
  return *canvas_device_;
}

// Chooses GL or the CPU. `open` makes what is needed on the GL device. If it fails and no device
// was named, the CPU is taken.
CanvasDevice Session::choose_device(const std::function<void()>& open, bool probe) {
  const std::string named = spelled("{device} ") + device_;
  if (is_cpu(device_)) return {true, named};
  if (!device_.empty()) {
    open();
    return {false, named};
  }
  const std::string rule = spelled("no {device}: GL where hardware answers, else the CPU; ");
  try {
    if (!GlContext::hardware_listed()) return {true, rule + "EGL lists no hardware device"};
    if (context().info().kind != "hardware")
      return {true, rule + "no hardware device could be opened"};
    if (probe && !verdict(Reliance::drawing).holds)
      return {true, rule + "the hardware failed a probe"};
    open();
    return {false, rule + "hardware answered"};
  } catch (const Error& error) {
    return {true, rule + error.where + ": " + error.reason};
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

PairDevice& Session::pairs() {
  if (pairs_) return *pairs_;
  PairDevice made;
  const auto open = [&] {
    made.backend = gl_pair_backend(context());
    made.gl = context().info();
  };
  made.reason = choose_device(open, false).reason;
  if (!made.gl) made.backend = cpu_pair_backend(threads_);
  return pairs_.emplace(std::move(made));
}

void Session::forget_device() {
  canvases_.clear();
  pairs_.reset();
  context_.reset();
  verdicts_.clear();  // another device may answer next time
  canvas_device_.reset();
  pair_workspace_.memory = {};
  if (frames_) remember_frames();
}

}  // namespace farcull
