// Decides whether the distance of two triangles is at most a clearance. Filters in doubles answer
// first. If they leave a doubt, exact arithmetic answers. Triangles are as in verify/exact.h.
#pragma once

#include <array>
#include <cmath>
#include <stdexcept>
#include <string>

#include "core/scene/scene.h"
#include "verify/filter.h"

namespace farcull {

/// Throws std::logic_error naming `where` unless the clearance is finite and not negative.
inline void require_clearance(const char* where, double clearance) {
  if (!(clearance >= 0 && std::isfinite(clearance)))
    throw std::logic_error(std::string(where) + ": a clearance must be finite and not negative");
}

/// Returns whether the distance is at most the clearance, decided by exact arithmetic alone.
bool within_unfiltered(const std::array<Vec3, 3>& a, const std::array<Vec3, 3>& b,
                       double clearance);

/// Like within_unfiltered(), but faster. Precondition: filter_planes() answers `unknown`.
inline bool is_within_beyond_planes(const std::array<Vec3, 3>& a, const std::array<Vec3, 3>& b,
                                    double clearance) {
  const Triage triage = clearance > 0 ? filter_within(a, b, clearance) : Triage::unknown;
  return triage == Triage::unknown ? within_unfiltered(a, b, clearance) : triage == Triage::yes;
}

/// Returns whether the distance is at most the clearance, for any two triangles. Precondition: the
/// clearance passes require_clearance().
inline bool is_within(const std::array<Vec3, 3>& a, const std::array<Vec3, 3>& b,
                      double clearance) {
  const Triage triage = filter_planes(a, b, clearance);
  return triage == Triage::unknown ? is_within_beyond_planes(a, b, clearance)
                                   : triage == Triage::yes;
}

}  // namespace farcull
