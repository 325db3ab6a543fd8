// What `farcull check` does with one scene.
#pragma once

#include <optional>
#include <span>
#include <string>

#include "experiments/record/check_result.h"

namespace farcull {

/// Checks what is given: a certificate, a list of pairs, or both. clearance: that is asked about;
/// file: the name of the certificate, as it is printed, "" for none; rows: of the list, those that
/// are about this scene. With a list the verdict is about both: a list alone is proved or refuted.
/// Throws Error where the list names objects or triangles that the scene has not.
/// Precondition: certificate or list is there.
SceneCheck check_scene_with(double clearance, const std::string& file,
                            const std::optional<Certificate>& certificate, const Scene& scene,
                            const GivenList* list, std::span<const ListedPair> rows);

}  // namespace farcull
