// What runs of one process share: the GL context, canvases, the device of FAR pairs, workspaces.
#pragma once

#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <thread>
#include <tuple>

#include "core/canvas/fatten.h"
#include "core/gl/base/context.h"
#include "core/gl/canvas/canvas.h"
#include "core/native/canvas.h"
#include "core/pairs/backend.h"
#include "core/pairs/pairs.h"
#include "core/sweep/sweep_prune.h"
#include "experiments/method/device_verdict.h"
#include "verify/exact.h"

namespace farcull {

/// Writes the line on standard error; a line of progress is cleared first.
Say say_on_stderr();

/// Which canvas draws, and why.
struct CanvasDevice {
  bool native = false;  // on the cores of the CPU (core/native/canvas.h); else on a GL device
  std::string reason;
};

/// Where FAR pairs runs.
struct PairDevice {
  std::unique_ptr<PairBackend> backend;  // keeps its buffers from call to call
  std::optional<GlInfo> gl;              // what answered; empty: the CPU
  std::string reason;                    // why this one
};

/// Each part is made when first needed, and kept from run to run. Not to be used by two threads at
/// once.
class Session {
 public:
  /// device: as RunOptions::device. Without one a fixed rule decides: GL where a hardware device
  /// answers, and for canvases keeps the assumptions; else the cores of the CPU (a software
  /// renderer is the same CPU by a longer way). threads: of the CPU, for far-pairs; 0: as many as
  /// there are cores. say: told in one line that the device is probed, and why; may be empty.
  explicit Session(std::string device, unsigned threads = 0, Say say = say_on_stderr())
      : device_(std::move(device)), threads_(threads), say_(std::move(say)) {}

  unsigned threads() const { return threads_; }
  /// The same as a number of threads.
  unsigned cpu_threads() const {
    return threads_ > 0 ? threads_ : std::thread::hardware_concurrency();
  }
  const GlContext& context();
  /// Whether the context's device keeps the assumptions; probed if no verdict is kept. GL state is
  /// not restored.
  const DeviceVerdict& verdict(Reliance reliance);
  /// Where the canvases are: on the cores of the CPU, or on the GL device of context().
  const CanvasDevice& canvas_device();
  /// The canvas for the drawables of this fattener, by its name. Only GL has query modes.
  Canvas& canvas(const Fattener& fattener, const GlCanvasOptions& options);
  /// The largest resolution of its canvases, in px.
  int max_resolution();
  /// Throws Error where a device that was named does not answer.
  PairDevice& pairs();
  PairWorkspace& pair_workspace() { return pair_workspace_; }
  /// From now on runs are frames of a scene, one after the other: far-pairs and the exact tests
  /// keep what did not move. Answers stay the same.
  void remember_frames() { frames_ = std::make_unique<FrameDecider>(); }
  /// Null where frames are not remembered.
  PairMemory* pair_memory() { return frames_ ? &pair_workspace_.memory : nullptr; }
  FrameDecider* frame_decider() { return frames_.get(); }
  SweepPrune& sweep() { return sweep_; }
  /// Drops the canvases, the pair device and the context, since after a failure nothing on a device
  /// is trusted; also what was kept of the last frame, which a device helped to find. Each is made
  /// again when it is next needed.
  void forget_device();

 private:
  CanvasDevice choose_device(const std::function<void()>& open, bool probe);

  std::string device_;
  unsigned threads_;
  Say say_;
  std::unique_ptr<GlContext> context_;
  std::map<Reliance, DeviceVerdict> verdicts_;
  std::optional<CanvasDevice> canvas_device_;
  std::map<std::tuple<std::string, DepthFormat, QueryMode, bool>, std::unique_ptr<Canvas>>
      canvases_;
  std::optional<PairDevice> pairs_;  // destroyed before context_, as canvases_
  PairWorkspace pair_workspace_;
  std::unique_ptr<FrameDecider> frames_;
  SweepPrune sweep_;
};

}  // namespace farcull
