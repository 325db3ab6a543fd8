// The certificate of a run.
#pragma once

#include "experiments/method/run.h"
#include "verify/certificate/certificate.h"

namespace farcull {

/// The claims of the run about every pair of the scene, with their evidence. Times are left out, so
/// the same run gives the same text.
Certificate certificate_of(const Scene& scene, const Record& record);

}  // namespace farcull
