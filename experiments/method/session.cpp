// Contexts, canvases and devices are opened on demand.
#include "experiments/method/session.h"

#include <unistd.h>

#include <cstdio>

#include "experiments/method/kernel_probes.h"

namespace farcull {

Say say_on_stderr() {
  return [](const std::string& line) {
    std::fprintf(stderr, "%sfarcull: %s\n", ::isatty(STDERR_FILENO) ? "\r\033[K" : "",
                 line.c_str());
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

GlCanvas& Session::canvas(const Fattener& fattener, const GlCanvasOptions& options) {
  return canvases_
      .try_emplace({fattener.name, options.depth_format, options.query}, context(), fattener.mode,
                   fattener.solid, options)
      .first->second;
}

PairDevice& Session::pairs() {
  if (!pairs_)
    pairs_ =
        open_pair_device(device_, threads_, [this]() -> const GlContext& { return context(); });
  return *pairs_;
}

void Session::forget_device() {
  canvases_.clear();
  pairs_.reset();
  context_.reset();
  verdicts_.clear();  // another device may answer next time
}

}  // namespace farcull
