// The clock of a GL device. For core/gl/*.cpp alone.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "core/gl/objects.h"

namespace farcull {

/// Notes when the device gets to a place in its work, where it has a clock (GL_TIMESTAMP). Nothing
/// is waited for, and no answer depends on it. A context must be current in every call.
class GlClock {
 public:
  /// For `stamps` places.
  explicit GlClock(std::size_t stamps);
  /// Forgets all places.
  void forget();
  void stamp(std::size_t place);
  /// ms on the device between two places; negative where they are not known. The device must have
  /// finished what it was told. Throws Error where a stamp was lost.
  double between(std::size_t from, std::size_t to) const;

 private:
  bool ticks_ = false;
  std::vector<GlQuery> stamps_;
};

}  // namespace farcull
