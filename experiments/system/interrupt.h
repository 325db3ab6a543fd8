// The line that a long run prints when a signal ends it.
#pragma once

#include "experiments/system/signals.h"

namespace farcull {

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
