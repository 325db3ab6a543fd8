// What a long run says when a signal ends it.
#pragma once

#include <csignal>

#include <array>

namespace farcull {

/// While it lives, SIGINT, SIGTERM and SIGHUP print one line on standard error, "farcull:
/// interrupted: after DONE of WANTED WHAT; END", and end the program as they would have. Those that
/// the caller had us ignore (nohup) stay ignored. One at a time in a process.
class Interruptible {
 public:
  /// The texts have to outlive it. terminal: the line of progress is cleared first.
  Interruptible(long wanted, const char* what, const char* end, bool terminal);
  ~Interruptible();
  Interruptible(const Interruptible&) = delete;
  Interruptible& operator=(const Interruptible&) = delete;

  void done(long count);

 private:
  static constexpr std::array<int, 3> kSignals = {SIGINT, SIGTERM, SIGHUP};
  std::array<struct sigaction, 3> before_ = {};
};

}  // namespace farcull
