// What the functions of the library do with their input and with errors.
#pragma once

#include <vector>

#include "core/base/error.h"
#include "core/base/floating_point.h"
#include "core/scene/scene.h"
#include "experiments/library/farcull.h"

namespace farcull {

inline constexpr unsigned kMostThreads = 1024;

/// The call with the floating-point environment of the proofs, the caller's restored afterwards.
/// Every Error that it throws becomes the one of the library.
template <class Call>
auto translated(const Call& call) {
  try {
    const FloatingPointGuard guard;
    return call();
  } catch (const Error& error) {
    throw ColliderError(error.what(), error.where, error.reason, error.remedy);
  }
}

/// Copies the input into the scene of the last call, whose memory is used again. self: every object
/// is tested against itself; self_objects: the same per object, empty or one for each. Throws Error
/// for input that is not as ColliderInput says.
void take(const ColliderInput& input, bool self, const std::vector<bool>& self_objects,
          Scene& scene);

}  // namespace farcull
