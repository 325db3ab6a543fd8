// Which program measured, on which machine, when.
#pragma once

#include <string>

namespace farcull {

struct Provenance {
  std::string started;  // UTC, ISO 8601
  std::string commit;   // of the program
  std::string gl_vendor, gl_renderer, gl_version;
  std::string cpu;           // model
  std::string cpu_features;  // as /proc/cpuinfo lists them
  unsigned cores = 0;
  std::string options;  // of the command line, as JSON
};

/// The provenance of this process. Opens the device to ask for its names; throws Error where there
/// is none.
Provenance provenance_now(const std::string& device, const std::string& options);

/// The time now: UTC, ISO 8601, in seconds.
std::string utc_now();

}  // namespace farcull
