// `farcull doctor`: the devices of this machine, a probe for each assumption that the proofs make
// of one, and whether FAR pairs is faster on it or on the CPU.
#pragma once

#include <string>

namespace farcull {

struct DoctorArguments {
  std::string device;
  std::string json;
};

/// Prints the findings. 0: every assumption holds on the chosen device; 1: one does not. Throws
/// Error where there is no device at all.
int doctor_command(const DoctorArguments& arguments);

}  // namespace farcull
