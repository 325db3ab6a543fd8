// Probes of the device assumptions A1 to A10: each tries to catch this device breaking one, and
// gives the worst that it measured beside the bound that the proofs rely on (docs/budget.md). A
// probe can refute an assumption, never prove it.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "core/gl/context.h"
#include "core/gl/probe_options.h"

namespace farcull {

/// Runs the probes in the order of the assumptions; `started`, where given, is called with the
/// assumption before each group. The same device and options give the same results. A probe that
/// breaks off by an Error fails; others go on. GL state is not kept.
std::vector<ProbeResult> run_probes(const GlContext& context, const ProbeOptions& options = {},
                                    const std::function<void(const std::string&)>& started = {});

}  // namespace farcull
