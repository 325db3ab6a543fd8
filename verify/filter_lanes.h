// filter_planes() (verify/filter.h) for many pairs, several at once on the lanes of this processor.
#pragma once

#include <span>

#include "core/scene/scene.h"
#include "verify/filter_bounds.h"

namespace farcull {

/// answers[i]: that of filter_planes() about the triangles of pairs[i], a before b, and the
/// clearance; the same on every instruction set (core/native/lanes.h). As many answers as pairs.
/// Fast where successive pairs have the same a. Preconditions as of verify/filter.h; every index is
/// in range.
void filter_pairs(const Scene& scene, std::span<const TrianglePair> pairs, double clearance,
                  std::span<Triage> answers);

}  // namespace farcull
