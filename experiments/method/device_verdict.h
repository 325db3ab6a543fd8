// Decides whether a device keeps the assumptions A1 to A10, on which the guarantee of far depends
// (docs/reliability.md), as far as probes can tell. The probes run once for a device, a driver and
// a build of farcull; a file keeps their results.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "core/gl/base/context.h"
#include "core/gl/probe/probe.h"
#include "verify/kernel_check.h"

namespace farcull {

// Probes of assumption A4, on the kernels that farcull uses: each kernel runs on the device as its
// method runs it, and its answers are compared with rational bounds (verify/kernel_check.h).

/// A kernel of an offset: its program, functions that make its test cases (fattened triangles, and
/// solids with random floats), and the check of an answer.
struct SolidKernel {
  const char* name;
  SolidProgram program;
  Solid (*fatten)(const KernelTriangle&);
  Solid (*adversarial)(std::uint64_t seed, std::uint64_t index, float cx, float cy);
  void (*check)(const SolidCase&, const SolidAnswer&, bool ordinary, KernelTally&);
};
/// The kernels of both offsets.
std::vector<SolidKernel> solid_kernels();

/// The members after the first are deliberate defects, so that tests can see the probes fail.
struct KernelProbeOptions {
  std::uint64_t seed = 1;
  bool bare = false;         // kernels that widen nothing
  bool late_stores = false;  // stores another solid than the one it asks about
};

/// Probes solid_interval of both offsets. A probe fails if anything was lost, if answers are loose
/// too often, if nothing was checked, or if it breaks off with an Error. All functions here make
/// the context current while they run.
std::vector<ProbeResult> solid_kernel_probes(const GlContext& context,
                                             const KernelProbeOptions& options = {});

/// Runs run_probes() and the probes of kernels, in the order of the assumptions. started: as for
/// run_probes(). brief: run_probes() takes about a third of the samples.
std::vector<ProbeResult> all_probes(const GlContext& context,
                                    const std::function<void(const std::string&)>& started = {},
                                    bool brief = false);

// ---- the verdict ----

/// The time now: UTC, ISO 8601, in seconds.
std::string utc_now();

struct DeviceVerdict {
  bool holds = false;               // every probe passed
  std::vector<std::string> failed;  // failed probes, as in "A2 snapping: 0.0078 px, bound 0.0039"
  std::string problem;              // which probe did not finish, and why; then no guarantee
  std::string made;                 // when the probes ran, as in 2026-01-31T12:00:00Z
  std::size_t probes = 0;           // how many ran
  double ms = 0;                    // time of the probes
  bool remembered = false;          // read from the file; no probe ran now
  std::string file;                 // file of the verdict; empty: it is not stored
  std::string note;                 // why the file could not be written
};

/// One sentence without a full stop: what the probes found.
std::string to_string(const DeviceVerdict& verdict);

/// Names and values of all that code generation and arithmetic on this device depend on: the
/// device, its driver, threads and limits, the sources of kernels and probes, the features of the
/// processor (for a software device), and the variables of the environment that drivers read.
using VerdictInputs = std::vector<std::pair<std::string, std::string>>;
VerdictInputs verdict_inputs(const GlInfo& device);

/// Runs the probes that a verdict rests on.
using Probes = std::function<std::vector<ProbeResult>()>;

/// Receives a line before probes run, and one if their verdict cannot be kept.
using Say = std::function<void(const std::string& line)>;

/// Returns the kept verdict. If there is none, runs `probes` and keeps their verdict by
/// keep_verdict(). A file that is damaged, belongs to another user, or has other inputs is ignored
/// and written anew. Errors of the file system do not throw; what `probes` throws passes through.
DeviceVerdict device_verdict(const GlInfo& device, const Probes& probes, const Say& say = {});

/// Makes a verdict from the results of probes and keeps it in place of an older one. Keeps nothing
/// if a probe broke off and none failed. If the verdict does not hold, first removes the older one.
DeviceVerdict keep_verdict(const GlInfo& device, const std::vector<ProbeResult>& results,
                           double ms);

}  // namespace farcull
