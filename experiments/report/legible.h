// What a figure leaves out so that it can be read.
#pragma once

#include "experiments/report/chapters/chapter.h"

namespace farcull {

/// The figure as it is drawn. Series that have the same points in every panel become one, named
/// "A = B". Panels without a value, and those in which all values are the same,
/// are left out, and the caption says so with the value; if that is all of them, they stay.
/// Drawings stay as well.
Figure legible(Figure figure);

}  // namespace farcull
