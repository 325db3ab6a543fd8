// Asks the device, the CPU and the clock.
#include "experiments/studies/provenance.h"

#include <chrono>
#include <ctime>

#include "commit.h"
#include "core/gl/context.h"
#include "experiments/system/machine.h"

namespace farcull {

std::string utc_now() {
  const std::time_t seconds =
      std::chrono::system_clock::to_time_t(std::chrono::system_clock::now());
  std::tm utc = {};
  ::gmtime_r(&seconds, &utc);
  char text[32];
  std::strftime(text, sizeof text, "%Y-%m-%dT%H:%M:%SZ", &utc);
  return text;
}

Provenance provenance_now(const std::string& device, const std::string& options) {
  const GlInfo gl = GlContext(device).info();
  return {.started = utc_now(),
          .commit = FARCULL_COMMIT,
          .gl_vendor = gl.vendor,
          .gl_renderer = gl.renderer,
          .gl_version = gl.version,
          .cpu = cpu_model(),
          .cpu_features = cpu_features(),
          .cores = usable_cores(),
          .options = options};
}

}  // namespace farcull
