// A handler of the signals that end a program, for as long as an object lives.
#pragma once

#include <csignal>

#include <array>
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

}  // namespace farcull
