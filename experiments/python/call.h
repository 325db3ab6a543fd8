// How the binding calls the library: beside the interpreter, which goes on and can stop it.
#pragma once

#include <pybind11/pybind11.h>

#include <atomic>
#include <functional>
#include <optional>
#include <string>
#include <utility>

#include "core/base/progress.h"

namespace farcull::python {

namespace py = pybind11;

/// Runs `work` in a thread of its own, without the lock of the interpreter, with the floating-point
/// environment of the proofs. The calling thread
/// releases the lock and looks for signals every 50 ms: where a handler of Python raises, as that
/// of Ctrl-C does, the work is asked to stop, and its exception is thrown when the work has ended.
/// `work` must not touch Python. What it throws is thrown here. Precondition: the lock is held.
void beside(const std::function<void()>& work);

/// The value of the work.
template <class Work>
auto answer_beside(const Work& work) {
  std::optional<decltype(work())> out;
  beside([&] { out.emplace(work()); });
  return std::move(*out);
}

/// Marks what one call at a time may use, as long as this lives. Throws farcull.Error where it is
/// marked: by another thread, or by a call of this one, which a signal handler interrupts.
class Turn {
 public:
  Turn(std::atomic_flag& used, const char* name);
  ~Turn() { used_.clear(); }
  Turn(const Turn&) = delete;
  Turn& operator=(const Turn&) = delete;

 private:
  std::atomic_flag& used_;
};

/// Stops all calls that are running, and waits until they have ended. Calls that begin later are
/// stopped as well. For the end of the interpreter. Precondition: the lock is held.
void end_calls();

/// Lets a run stop between its stages.
Progress stopping_progress();

/// Throws an exception of the package, farcull.Error or farcull.InputError. input: what the caller
/// gave is wrong.
[[noreturn]] void raise(const std::string& where, const std::string& reason,
                        const std::string& remedy, bool input);

/// Makes exceptions of farcull those of the package: an Error is an InputError where it names a
/// parameter, else an Error; std::bad_alloc is a MemoryError.
void register_exceptions();

}  // namespace farcull::python
