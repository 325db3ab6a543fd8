// The certificate of the answers of `farcull distance`.
#pragma once

#include "experiments/method/distances.h"
#include "verify/certificate/distance_certificate.h"

namespace farcull {

/// What the record answers about the scene, in the form that a stranger can check. Times, and which
/// object is inside another, are no part of it.
DistanceCertificate certificate_of(const Scene& scene, const DistanceRecord& record);

}  // namespace farcull
