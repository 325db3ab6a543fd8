// Words for stages, which people read in tables, JSON, progress messages and the library.
#pragma once

#include "core/base/stage.h"

namespace farcull {

/// Returns a name such as "cull triangles z, round 2".
std::string name_of(const Stage& stage);
/// Returns the reason in words, without a full stop; empty for Reason::none.
std::string reason_of(const Stage& stage);
/// Returns "objects", "clusters of 32" (or another number) or "triangles"; empty for kNoLevel.
std::string level_name(std::uint32_t level);
std::string to_string(Unit unit);
/// Returns why a run used no device. Precondition: the run used no device.
std::string no_device_reason(const std::vector<Stage>& trace);
/// Returns the step's own text, or words for its stage such as "culling along z, round 2".
std::string text_of(const ProgressStep& step);

}  // namespace farcull
