// Options of FAR pairs on OpenGL.
#pragma once

#include <cstddef>

namespace farcull {

struct GlPairOptions {
  /// Bytes that the masks and lists of one part of the window may take; more split the window, down
  /// to single pixels. The pairs of a portion, and the further tests of a level, may take as many
  /// each. The answer does not depend on it.
  std::size_t memory = std::size_t{256} << 20;
  /// Bytes; as if a storage block held no more than this. 0: the device's own limit.
  long storage_limit = 0;
  /// Counts are read between the steps, also where they are foreseen or could be guessed. It takes
  /// more time; the answer does not depend on it. For tests of the steps.
  bool step_by_step = false;
};

}  // namespace farcull
