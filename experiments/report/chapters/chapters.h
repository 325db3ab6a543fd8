// The chapter of a study by the name of the study.
#pragma once

#include "experiments/report/chapters/chapter.h"

namespace farcull {

/// A finding that is_broken() stands before all others. Throws Error for a study that this program
/// does not report.
Chapter chapter_of(const StoredStudy& stored);

}  // namespace farcull
