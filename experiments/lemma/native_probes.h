// Probes of the native canvas: its kernels on every instruction set of this processor, and the
// lemmas on it.
#pragma once

#include <vector>

#include "core/gl/probe/probe.h"

namespace farcull {

/// For each of lane_targets() the kernels of both offsets: answers that lose a part of the exact
/// solid, and answers that differ from those of the scalar text. Then points of triangles that got
/// no sample, or samples that do not bound them (experiments/lemma/lemma.h). The instruction
/// set that was in use is in use afterwards.
std::vector<ProbeResult> native_probes();

}  // namespace farcull
