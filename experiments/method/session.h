// What runs of one process share: the GL context, canvases, the device of FAR pairs, workspaces.
#pragma once

#include <map>
#include <memory>
#include <optional>
#include <string>
#include <tuple>

#include "core/canvas/fatten.h"
#include "core/gl/canvas.h"
#include "core/gl/context.h"
#include "core/pairs/view.h"
#include "core/sweep/sweep_prune.h"
#include "experiments/method/device_verdict.h"
#include "experiments/method/pair_device.h"

namespace farcull {

/// Writes the line on standard error; a line of progress is cleared first.
Say say_on_stderr();

/// Each part is made when first needed, and kept from run to run. Not to be used by two threads at
/// once.
class Session {
 public:
  /// device: as RunOptions::device, or "gl": GL even where only a software renderer answers.
  /// threads: of the CPU, for far-pairs; 0: as many as there are cores.
  /// say: told in one line that the device is probed, and why; may be empty.
  explicit Session(std::string device, unsigned threads = 0, Say say = say_on_stderr())
      : device_(std::move(device)), threads_(threads), say_(std::move(say)) {}

  unsigned threads() const { return threads_; }
  const GlContext& context();
  /// Whether the context's device keeps the assumptions; probed where no verdict is kept. GL state
  /// is not kept.
  const DeviceVerdict& verdict(Reliance reliance);
  /// The canvas for the drawables of this fattener, by its name.
  GlCanvas& canvas(const Fattener& fattener, const GlCanvasOptions& options);
  PairDevice& pairs();
  PairScene& pair_workspace() { return pair_workspace_; }
  SweepPrune& sweep() { return sweep_; }
  /// Drops the canvases, the pair device and the context: after a failure nothing that lies on a
  /// device is believed. Each is made again when it is next needed.
  void forget_device();

 private:
  std::string device_;
  unsigned threads_;
  Say say_;
  std::unique_ptr<GlContext> context_;
  std::map<Reliance, DeviceVerdict> verdicts_;
  std::map<std::tuple<std::string, DepthFormat, QueryMode>, GlCanvas> canvases_;
  std::optional<PairDevice> pairs_;  // these two go before the context
  PairScene pair_workspace_;
  SweepPrune sweep_;
};

}  // namespace farcull
