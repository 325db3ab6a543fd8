// The groups of probes by assumption. For core/gl/probe*.cpp alone.
#pragma once

#include <vector>

#include "core/gl/context.h"
#include "core/gl/probe_options.h"

namespace farcull::probe {

std::vector<ProbeResult> edges(const GlContext& context, const ProbeOptions& options);     // A1, A2
std::vector<ProbeResult> coverage(const GlContext& context, const ProbeOptions& options);  // A3, A9
std::vector<ProbeResult> arithmetic(const GlContext& context,
                                    const ProbeOptions& options);  // A4, A9
std::vector<ProbeResult> depth_tests(const GlContext& context, const ProbeOptions& options);  // A5
std::vector<ProbeResult> queries(const GlContext& context, const ProbeOptions& options);      // A6
std::vector<ProbeResult> commands(const GlContext& context, const ProbeOptions& options);     // A7
std::vector<ProbeResult> pair_commands(const GlContext& context,
                                       const ProbeOptions& options);                     // A7
std::vector<ProbeResult> memory(const GlContext& context, const ProbeOptions& options);  // A8
std::vector<ProbeResult> driver(const GlContext& context, const ProbeOptions& options);  // A10
/// One of A5.
ProbeResult texels(const ProbeOptions& options);

}  // namespace farcull::probe
