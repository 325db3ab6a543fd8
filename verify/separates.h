// Whether a translation separates two closed objects. World units. Preconditions of verify/exact.h.
#pragma once

#include "verify/convex_core.h"

namespace farcull {

/// True only if the insides of a, moved by the translation, and of b have no point in common. Uses
/// bounds of all roundings: false if the insides are too near to decide.
bool separates(const ClosedObject& a, const ClosedObject& b, const Vec3& translation);

}  // namespace farcull
