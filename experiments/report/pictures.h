// Which pictures of scenes belong to what was measured.
#pragma once

#include <vector>

#include "experiments/report/chapter.h"

namespace farcull {

/// Of the study of accuracy: CULLIDE beside FAR on a scene, at a resolution where both were
/// measured and CULLIDE missed something. Empty where there is none.
std::vector<Picture> accuracy_pictures(const StoredStudy& stored);

}  // namespace farcull
