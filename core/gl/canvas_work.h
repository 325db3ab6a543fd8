// What the GL canvas asks of its device.
#pragma once

#include <cstdint>

namespace farcull {

/// Counts of the last pass; uploaded_bytes is of the last begin().
struct GlCanvasWork {
  std::uint64_t draws = 0;           // draw calls
  std::uint64_t state_changes = 0;   // changes of program, target or depth test: between steps
  std::uint64_t queries = 0;         // occlusion queries, and one that counts primitives
  std::uint64_t readbacks = 0;       // answers that are read: the report, then each query
  std::uint64_t uploaded_bytes = 0;  // of elements
};

}  // namespace farcull
