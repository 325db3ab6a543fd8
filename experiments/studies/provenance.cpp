// Asks the device, the CPU and the clock.
#include "experiments/studies/provenance.h"

#include <chrono>
#include <ctime>

#include "commit.h"
#include "core/native/lanes.h"
#include "experiments/method/session.h"
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
  Provenance out{.started = utc_now(),
                 .commit = FARCULL_COMMIT,
                 .gl_vendor = {},
                 .gl_renderer = {},
                 .gl_version = {},
                 .cpu = cpu_model(),
                 .cpu_features = cpu_features(),
                 .cores = usable_cores(),
                 .options = options};
  Session session(device);
  if (session.canvas_device().native) {
    out.gl_renderer = "native (" + lane_target() + ")";
  } else {
    const GlInfo& gl = session.context().info();
    out.gl_vendor = gl.vendor;
    out.gl_renderer = gl.renderer;
    out.gl_version = gl.version;
  }
  return out;
}

std::string driver_text(const Provenance& provenance) {
  if (provenance.gl_vendor.empty() && provenance.gl_version.empty()) return "none";
  return provenance.gl_vendor + ", " + provenance.gl_version;
}

}  // namespace farcull
