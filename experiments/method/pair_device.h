// Where FAR pairs runs: on the cores of the CPU, or on a GL device.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "core/gl/base/context.h"
#include "core/pairs/backend.h"

namespace farcull {

struct PairDevice {
  std::unique_ptr<PairBackend> backend;  // keeps its buffers from call to call
  std::optional<GlInfo> gl;              // what answered; empty: the CPU
  std::string reason;                    // why this one
};

PairDevice cpu_pair_device(unsigned threads, const std::string& reason);
/// The context must outlive the result.
PairDevice gl_pair_device(const GlContext& context, const std::string& reason);

/// device: "native" or "cpu"; "gl"; "hardware", "software" or a number as for GlContext; or "",
/// which decides by a fixed rule: GL where a hardware device answers, else the CPU (a software
/// renderer is the same CPU by a longer way). threads: of the CPU; 0 for as many as there are
/// cores.
///
/// `context` makes the GL context for `device`, or gives the one that there is; asked only where GL
/// may be taken. It must outlive the result. Throws Error where a device that was named does not
/// answer.
PairDevice open_pair_device(const std::string& device, unsigned threads,
                            const std::function<const GlContext&()>& context);

}  // namespace farcull
