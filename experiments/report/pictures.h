// Which pictures of scenes belong to what was measured.
#pragma once

#include <vector>

#include "experiments/picture.h"
#include "experiments/report/chapter.h"

namespace farcull {

/// Of the study of accuracy: CULLIDE beside FAR on a scene, at a resolution where both were
/// measured and CULLIDE missed something. Empty where there is none.
std::vector<Picture> accuracy_pictures(const StoredStudy& stored);

/// What the drawn picture says of itself: its caption gets the counts of its panels, and where the
/// rows have others, these as well. Findings to be added, each is_broken(): panels whose method
/// promises, and missed a pair. Precondition: `drawn` has the panels of the picture.
std::vector<std::string> add_counts(Picture& picture, const std::vector<PanelResult>& drawn);

}  // namespace farcull
