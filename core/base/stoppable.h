// A call in a thread of its own, which another thread can stop.
#pragma once

#include <chrono>
#include <exception>
#include <functional>
#include <memory>

namespace farcull {

/// Thrown within a call that was stopped. It is no Error: nothing is wrong.
class Stopped : public std::exception {
 public:
  const char* what() const noexcept override { return "stopped"; }
};

/// Throws Stopped where the calling thread works for a StoppableCall that was asked to stop. Else
/// it does nothing. Each step that is divided among threads (core/base/parallel.h) begins with it.
void stop_point();

/// Runs `work` in a thread of its own. The threads that help with it in for_chunks() see the same
/// request to stop. Signals are left to the threads of the caller. The thread starts with the
/// floating-point environment of the thread that constructs the object.
class StoppableCall {
 public:
  /// Throws std::system_error where no thread can be started; nothing has run then.
  explicit StoppableCall(std::function<void()> work);
  /// Waits until the work has ended.
  ~StoppableCall();
  StoppableCall(const StoppableCall&) = delete;
  StoppableCall& operator=(const StoppableCall&) = delete;

  /// Asks the work to stop at its next stop_point(). It may end otherwise before it gets there.
  void stop();
  /// Waits until the work has ended, but no longer than this. Whether it has ended.
  bool wait_for(std::chrono::milliseconds most);
  /// Waits until the work has ended. Throws what it threw: Stopped where it was stopped.
  void finish();

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace farcull
