// Decides by probes whether a device keeps the assumptions A1 to A10 (docs/reliability.md). The
// guarantee of far depends on these assumptions. The probes run once for each device, driver and
// build of farcull. A file keeps the results.
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

// Probes of assumption A4. Each kernel that farcull uses runs on the device. The answers of the
// kernels are compared with rational bounds (verify/kernel_check.h).

/// A kernel of an offset: its program, two functions that make test cases (fattened triangles, and
/// solids with random floats), and the check of an answer.
struct SolidKernel {
  const char* name;
  SolidProgram program;
  Solid (*fatten)(const KernelTriangle&);
  Solid (*adversarial)(std::uint64_t seed, std::uint64_t index, float cx, float cy);
  void (*check)(const SolidCase&, const SolidAnswer&, bool ordinary, KernelTally&);
};
/// Returns the kernels of the two offsets.
std::vector<SolidKernel> solid_kernels();

/// `bare` and `late_stores` are deliberate defects. Tests use them to check that the probes fail.
struct KernelProbeOptions {
  std::uint64_t seed = 1;
  bool bare = false;         // the kernels do not widen intervals (FAR_WIDEN)
  bool late_stores = false;  // the probe stores the solid of the next case
};

/// Probes the kernels of the two offsets. A probe fails if a solid was lost, if too many answers
/// are too wide, if nothing was checked, or if an Error is thrown. Makes the context current.
std::vector<ProbeResult> solid_kernel_probes(const GlContext& context,
                                             const KernelProbeOptions& options = {});

/// Runs run_probes() and the probes of kernels. Returns the results in the order of the
/// assumptions. started: as for run_probes(). brief: run_probes() takes about a third of the
/// samples.
std::vector<ProbeResult> all_probes(const GlContext& context,
                                    const std::function<void(const std::string&)>& started = {},
                                    bool brief = false);

/// Returns the current UTC time, such as 2026-01-31T12:00:00Z.
std::string utc_now();

struct DeviceVerdict {
  bool holds = false;               // every probe passed
  std::vector<std::string> failed;  // failed probes, as in "A2 snapping: 0.0078 px, bound 0.0039"
  std::string problem;              // which probe did not finish, and why; empty: all finished
  std::string made;                 // time of the probes, in the form of utc_now()
  std::size_t probes = 0;           // how many probes ran
  double ms = 0;                    // time of the probes
  bool remembered = false;          // true: the verdict was read from the file
  std::string file;                 // file of the verdict; empty: not stored in a file
  std::string note;                 // why the file could not be written
};

/// Returns the result of the probes in one sentence, without a full stop.
std::string to_string(const DeviceVerdict& verdict);

/// Names and values of everything that can change the results of probes: the device, its driver,
/// threads and limits, the sources of kernels and probes, the processor (for a software device),
/// and the environment variables that drivers read.
using VerdictInputs = std::vector<std::pair<std::string, std::string>>;
VerdictInputs verdict_inputs(const GlInfo& device);

using Probes = std::function<std::vector<ProbeResult>()>;

/// Receives a line of text for the user.
using Say = std::function<void(const std::string& line)>;

/// Returns the verdict that a file has for the device. If there is no such file, runs `probes`,
/// then stores and returns their verdict. A file that is damaged, belongs to another user, or has
/// other inputs is ignored and replaced. Errors of the file system do not throw. Exceptions of
/// `probes` are passed on. say: gets a line before the probes run, and a line if storing fails.
DeviceVerdict device_verdict(const GlInfo& device, const Probes& probes, const Say& say = {});

/// Makes a verdict from the results of probes. Replaces the older file of the verdict. If a probe
/// did not finish and no probe failed, only removes the older file.
DeviceVerdict keep_verdict(const GlInfo& device, const std::vector<ProbeResult>& results,
                           double ms);

}  // namespace farcull
