// Which program measured, on which machine, when.
#pragma once

#include <string>

namespace farcull {

struct Provenance {
  std::string started;  // UTC, ISO 8601
  std::string commit;   // of the program
  /// Of GL. Where the native canvas draws, gl_renderer is "native" with the instruction set, as in
  /// "native (AVX3)", and the other two are empty.
  std::string gl_vendor, gl_renderer, gl_version;
  std::string cpu;           // model
  std::string cpu_features;  // as /proc/cpuinfo lists them
  unsigned cores = 0;
  std::string options;  // of the command line, as JSON
};

/// Vendor and version of the driver for people; "none" on the native canvas.
std::string driver_text(const Provenance& provenance);

/// The provenance of this process, with the device that Session chooses. A GL device is opened to
/// ask for its names; throws Error where the one that was named does not answer.
Provenance provenance_now(const std::string& device, const std::string& options);

/// The time now: UTC, ISO 8601, in seconds.
std::string utc_now();

}  // namespace farcull
