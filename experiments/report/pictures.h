// Compares the pictures of a report with the rows that they show.
#pragma once

#include <vector>

#include "experiments/picture/panel.h"
#include "experiments/report/chapters/chapter.h"

namespace farcull {

/// Adds the counts of the drawn panels to the caption, and where the rows have others, these as
/// well. The result is a broken promise for each panel whose method promises and missed a pair.
/// Precondition: `drawn` has the panels of the picture (std::logic_error otherwise).
std::vector<Finding> add_counts(Picture& picture, const std::vector<PanelResult>& drawn);

}  // namespace farcull
