// The entries of a certificate of distances in the numbers of its scene. For its checker.
#pragma once

#include <string>
#include <vector>

#include "core/scene/scene.h"
#include "verify/certificate/distance_certificate.h"
#include "verify/certificate/fraction.h"

namespace farcull {

/// An entry with its triangles as the scene numbers them.
struct Listed {
  TrianglePair pair;
  Length length;
};

/// Entry by entry. Throws Error naming `name` where one names what the scene does not have.
std::vector<Listed> located(const DistanceCertificate& certificate, const Scene& scene,
                            const std::string& name);

}  // namespace farcull
