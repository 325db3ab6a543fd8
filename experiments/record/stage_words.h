// The words for stages that people read in tables, JSON, the terminal's progress and the library.
#pragma once

#include "core/base/stage.h"

namespace farcull {

/// "cull triangles z, round 2".
std::string name_of(const Stage& stage);
/// The reason in words, without a full stop; empty for Reason::none.
std::string reason_of(const Stage& stage);
/// "objects", "clusters of 32", "triangles"; empty for kNoLevel.
std::string level_name(std::uint32_t level);
/// "triangles", "pairs" or "".
std::string to_string(Unit unit);
/// Why a run used no device. Precondition: the run used none.
std::string no_device_reason(const std::vector<Stage>& trace);
/// "culling along z, round 2", or the text of the step.
std::string text_of(const ProgressStep& step);

}  // namespace farcull
