// The sentences of the study "libraries".
#pragma once

#include "experiments/report/chapters/rows.h"

namespace farcull {

/// Adds what farcull's own methods answered, a broken promise among it; what the other contestants
/// got wrong of pairs of triangles, and of meshes; and which contestants have rows of two versions
/// of their library.
void find_in_libraries(const Rows& rows, Chapter& chapter);

}  // namespace farcull
