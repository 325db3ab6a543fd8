// `farcull doctor`.
#pragma once

#include "experiments/command/options.h"

namespace farcull {

/// Declares the command on the program's options; run() runs it.
class DoctorCommand {
 public:
  CLI::App* add_to(CLI::App& app);
  /// The exit status: 0 every assumption holds on the device, 1 one does not. Throws Error where
  /// the arguments are bad or there is no device.
  int run() const;

 private:
  Text device_, json_;
};

}  // namespace farcull
