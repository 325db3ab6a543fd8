// `farcull doctor`: the native canvas and the devices of this machine, a probe for each assumption
// that the proofs make of them, and whether FAR pairs is faster on the chosen device or on the CPU.
#pragma once

#include <string>
#include <vector>

#include "core/gl/probe/probe.h"

namespace farcull {

/// For each of lane_targets() the kernels of both offsets: answers that lose a part of the exact
/// solid, and answers that differ from those of the scalar text. Then points of triangles that got
/// no sample, or samples that do not bound them (experiments/lemma/lemma.h). The instruction
/// set that was in use is in use afterwards.
std::vector<ProbeResult> native_probes();

struct DoctorArguments {
  std::string device;
  std::string json;
};

/// Prints the findings. 0: every assumption holds on the native canvas and on the chosen device; 1:
/// one does not. Without OpenGL the native canvas is all that is looked at. Throws Error where a
/// device that is named does not answer.
int doctor_command(const DoctorArguments& arguments);

}  // namespace farcull
