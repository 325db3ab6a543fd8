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

/// Returns a function that clears the progress line, then writes a line to standard error.
Say say_on_stderr();

/// The kind of canvas that draws, and why it was chosen.
struct CanvasDevice {
  bool native = false;  // true: the cores of the CPU (core/native/canvas.h); false: a GL device
  std::string reason;
};

/// Makes devices, contexts and canvases when a run first needs them, and keeps them for later runs.
/// Two threads must not use a Session at once.
class Session {
 public:
  /// device: as RunOptions::device; "": GL if a hardware device keeps the assumptions
  /// (device_verdict.h), else the cores of the CPU. threads: number of CPU threads; 0: as many as
  /// there are cores. say: as in device_verdict(); may be empty.
  explicit Session(std::string device, unsigned threads = 0, Say say = say_on_stderr())
      : device_(std::move(device)), threads_(threads), say_(std::move(say)) {}

  unsigned threads() const { return threads_; }
  /// Returns the given number of threads, or the number of cores if 0 was given.
  unsigned cpu_threads() const {
    return threads_ > 0 ? threads_ : std::thread::hardware_concurrency();
  }
  const GlContext& context();
  /// Returns whether the device of context() keeps the assumptions of the guarantee. Probes the
  /// device if no file has a verdict. Does not restore the GL state.
  const DeviceVerdict& verdict();
  const CanvasDevice& canvas_device();
  /// Returns the canvas for this fattener and these options. The first call makes the canvas. A
  /// canvas on the CPU does not use options.query.
  Canvas& canvas(const Fattener& fattener, const GlCanvasOptions& options);
  /// Returns the largest resolution that a canvas supports, in px.
  int max_resolution();
  /// Declares that the following runs are consecutive frames of one scene. The method `boxes` and
  /// the exact tests then reuse results for triangles that did not move. The answers are the same.
  void remember_frames() { frames_ = std::make_unique<FrameDecider>(); }
  /// Returns null if remember_frames() was not called.
  FrameMemory* frame_memory() { return frames_ ? &frame_memory_ : nullptr; }
  FrameDecider* frame_decider() { return frames_.get(); }
  SweepPrune& sweep() { return sweep_; }
  /// Drops the canvases, the context and the results of the last frame. Call this after a failure,
  /// since the contents of a device are then unknown.
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
