// Signals that end the program: a handler for as long as an object lives, and the line that a long
// run prints then.
#pragma once

#include <array>
#include <csignal>
#include <cstddef>

namespace farcull {

/// While it lives, SIGINT, SIGTERM and SIGHUP call the handler. Those that the caller had us ignore
/// (nohup) stay ignored. The destructor puts the handlers of before back.
class SignalGuard {
 public:
  explicit SignalGuard(void (*handler)(int)) {
    for (std::size_t i = 0; i < kSignals.size(); ++i) {
      ::sigaction(kSignals[i], nullptr, &before_[i]);
      if (before_[i].sa_handler == SIG_IGN) continue;
      struct sigaction action = {};
      action.sa_handler = handler;
      ::sigaction(kSignals[i], &action, nullptr);
    }
  }
  ~SignalGuard() {
    for (std::size_t i = 0; i < kSignals.size(); ++i)
      ::sigaction(kSignals[i], &before_[i], nullptr);
  }
  SignalGuard(const SignalGuard&) = delete;
  SignalGuard& operator=(const SignalGuard&) = delete;

  /// For a handler: ends the program as the signal would have.
  static void end_by(int signal) {
    std::signal(signal, SIG_DFL);
    std::raise(signal);
  }

 private:
  static constexpr std::array<int, 3> kSignals = {SIGINT, SIGTERM, SIGHUP};
  std::array<struct sigaction, 3> before_ = {};
};

/// While it lives, SIGINT, SIGTERM and SIGHUP print one line on standard error, "farcull:
/// interrupted: after DONE of WANTED WHAT; END", and end the program as they would have. Those that
/// the caller had us ignore (nohup) stay ignored. One at a time in a process.
class Interruptible {
 public:
  /// The texts have to outlive it. terminal: the line of progress is cleared first.
  Interruptible(long wanted, const char* what, const char* end, bool terminal);

  void done(long count);

 private:
  SignalGuard signals_;
};

}  // namespace farcull
