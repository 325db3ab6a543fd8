// The lemma experiment (experiments/lemma/lemma.h) as a point of a study: one generator on one
// canvas.
#pragma once

#include "experiments/measure/lab.h"
#include "experiments/studies/counts.h"
#include "experiments/studies/point.h"

namespace farcull {

/// Runs the generator of the point. Left out where the window is larger than the device can draw.
/// The counts are LemmaCounts. Throws Error for faults of the device.
PointResult measure_lemma(const LemmaPoint& point, Lab& lab);

}  // namespace farcull
