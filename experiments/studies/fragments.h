// The number of fragments that an offset makes of a scene.
#pragma once

#include <cstdint>
#include <string>

#include "core/scene/scene.h"
#include "experiments/method/run.h"

namespace farcull {

/// One drawing of every triangle that takes part, in each view of a run of FAR.
struct Fragments {
  std::uint64_t covered = 0;   // pixel centres in the closed proxies: what the fragment program is
                               // run for
  std::uint64_t solid = 0;     // of them, those whose line along the depth meets the solid: what is
                               // stored or asked
  std::uint64_t elements = 0;  // proxies drawn
};

/// Counts on the CPU, from the record's views and radii and the function that the shaders run
/// (SolidProgram::interval), so that the count depends on the device through its budget alone. The
/// rasterizer's snapping of corners is left out: a pixel centre within a snap of a proxy's edge may
/// be counted otherwise than it is drawn. offset: obb or exact, by itself, whatever a run tries
/// before it. Precondition: record is of `far` with fragment depth on this scene.
Fragments count_fragments(const Scene& scene, const Record& record, const std::string& offset);

}  // namespace farcull
