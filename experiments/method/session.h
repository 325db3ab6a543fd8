// The session: the GL context, canvases and memories that the runs of one process share.
#pragma once

#include <map>
#include <memory>
#include <optional>
#include <string>
#include <thread>
#include <tuple>

#include "core/boxes/frames.h"
#include "core/canvas/fatten.h"
#include "core/gl/base/context.h"
#include "core/gl/canvas/canvas.h"
#include "core/native/canvas.h"
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

/// Each part is made when first needed, and kept from run to run. Not to be used by two threads at
/// once.
class Session {
 public:
  /// device: as RunOptions::device. If it is empty, GL is used if a hardware device answers and
  /// keeps the assumptions; else the cores of the CPU are used, since a software renderer would use
  /// the same cores more slowly. threads: of the CPU; 0: as many as there are cores. say: receives
  /// a line if the device is probed, as in device_verdict(); may be empty.
  explicit Session(std::string device, unsigned threads = 0, Say say = say_on_stderr())
      : device_(std::move(device)), threads_(threads), say_(std::move(say)) {}

  unsigned threads() const { return threads_; }
  /// The number of threads; if it was given as 0, the number of cores.
  unsigned cpu_threads() const {
    return threads_ > 0 ? threads_ : std::thread::hardware_concurrency();
  }
  const GlContext& context();
  /// Whether the context's device keeps the assumptions; probes the device if no verdict is kept.
  /// Does not restore the GL state.
  const DeviceVerdict& verdict();
  /// The device on which canvases draw: the cores of the CPU, or the GL device of context().
  const CanvasDevice& canvas_device();
  /// The canvas for the drawables of this fattener. There is one for each name of a fattener and
  /// each set of options. Only GL has query modes.
  Canvas& canvas(const Fattener& fattener, const GlCanvasOptions& options);
  /// The largest resolution of the session's canvases, in px.
  int max_resolution();
  /// From now on runs are frames of a scene, one after the other: boxes and the exact tests
  /// reuse their results about triangles that did not move. Answers stay the same.
  void remember_frames() { frames_ = std::make_unique<FrameDecider>(); }
  /// Null if frames are not remembered.
  FrameMemory* frame_memory() { return frames_ ? &frame_memory_ : nullptr; }
  FrameDecider* frame_decider() { return frames_.get(); }
  SweepPrune& sweep() { return sweep_; }
  /// Drops the canvases and the context, since the contents of a device are unknown after a
  /// failure. Also drops the results of the last frame. Each is made again when it is next needed.
  void forget_device();

 private:
  CanvasDevice choose_device();

  std::string device_;
  unsigned threads_;
  Say say_;
  std::unique_ptr<GlContext> context_;
  std::optional<DeviceVerdict> verdict_;
  std::optional<CanvasDevice> canvas_device_;
  std::map<std::tuple<std::string, DepthFormat, QueryMode, bool>, std::unique_ptr<Canvas>>
      canvases_;
  FrameMemory frame_memory_;
  std::unique_ptr<FrameDecider> frames_;
  SweepPrune sweep_;
};

}  // namespace farcull
