// What the probes of kernels share; nothing else includes this.
#pragma once

#include <functional>
#include <string>

#include "core/base/error.h"
#include "experiments/method/kernel_probes.h"
#include "verify/kernel_check.h"

namespace farcull::kernel_probe {

inline const std::string kUnit = "lost";

/// A probe whose measured value is how much was lost; answers that are loose too often fail it as
/// well. One that breaks off by an Error fails.
inline ProbeResult result(const std::string& name, const std::string& tried,
                          const std::function<KernelTally()>& run) {
  ProbeResult out{.assumption = "A4", .name = name, .unit = kUnit, .note = {}};
  try {
    const KernelTally t = run();
    const bool loose = static_cast<double>(t.loose) > kLooseShare * static_cast<double>(t.ordinary);
    out.measured = static_cast<double>(t.lost);
    out.samples = t.checked;
    out.pass = t.checked > 0 && t.lost == 0 && !loose;
    out.note = tried;
    if (t.ordinary > 0) {
      out.note += "; " + std::to_string(t.loose) + " of " + std::to_string(t.ordinary) +
                  " ordinary ones wider than exact by 0.1 px" + (loose ? ": TOO MANY" : "");
    }
  } catch (const Error& error) {
    out.note = error.what();
    out.broke_off = true;
  }
  return out;
}

}  // namespace farcull::kernel_probe
