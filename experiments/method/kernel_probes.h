// A4, the shipped kernels: each runs on the device as its method runs it, and its answers are
// compared with rational bounds (verify/kernel_check.h).
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "core/gl/base/context.h"
#include "core/gl/probe/probe.h"
#include "verify/kernel_check.h"

namespace farcull {

/// A kernel of an offset: its program, fattened triangles and solids made of floats to ask it
/// about, and the check of an answer.
struct SolidKernel {
  const char* name;
  SolidProgram program;
  Solid (*fatten)(const KernelTriangle&);
  Solid (*adversarial)(std::uint64_t seed, std::uint64_t index, float cx, float cy);
  void (*check)(const SolidCase&, const SolidAnswer&, bool ordinary, KernelTally&);
};
/// Of both offsets.
std::vector<SolidKernel> solid_kernels();

/// All but the first two are deliberate defects, so that tests can see the probes fail.
struct KernelProbeOptions {
  std::uint64_t seed = 1;
  bool brief = false;            // about a third of the samples
  bool bare = false;             // kernels that widen nothing
  bool reversed_slices = false;  // depth slices from far to near
  bool late_stores = false;      // what is stored is another solid than what is asked
};

/// What FAR pairs relies on: far_bounds, far_margin, far_strip and far_depths on triangles of every
/// kind, far_slice, and the conversion of a float to an integer. All functions here make the
/// context current while they run.
std::vector<ProbeResult> pair_kernel_probes(const GlContext& context,
                                            const KernelProbeOptions& options = {});
/// solid_interval of both offsets, which drawing relies on besides.
std::vector<ProbeResult> solid_kernel_probes(const GlContext& context,
                                             const KernelProbeOptions& options = {});

/// run_probes and the kernels above, in the order of the assumptions; `started` as for run_probes.
std::vector<ProbeResult> all_probes(const GlContext& context,
                                    const std::function<void(const std::string&)>& started = {});
/// Brief ones of what drawing relies on.
std::vector<ProbeResult> drawing_probes(const GlContext& context);

}  // namespace farcull
