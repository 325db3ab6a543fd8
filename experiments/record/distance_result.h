// The outcome of `farcull check` about a certificate of distances, as text for people and as JSON.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

#include "core/scene/scene.h"
#include "verify/certificate/distance_certificate.h"

namespace farcull {

/// A certificate of distances with what its check found.
struct CheckedDistances {
  std::string file;
  DistanceCertificate certificate;
  DistanceCheck result;
};

/// "these 3 pairs of objects are at exactly these distances, ...": what is proved where everything
/// is.
std::string proved_text(const CheckedDistances& check);
/// The verdict with its reason, and the pair that it is about.
std::string verdict_text(const Scene& scene, const CheckedDistances& check);
/// The verdict and everything else.
std::string check_text(const Scene& scene, const CheckedDistances& check);
nlohmann::ordered_json check_json(const Scene& scene, const CheckedDistances& check);

}  // namespace farcull
