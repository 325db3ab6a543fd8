// `farcull clash --html`: one file with the parts, the list of pairs that are not clear, and the
// curves in which surfaces cross.
#pragma once

#include <string>

#include "experiments/method/clash.h"

namespace farcull {

/// unit: of the lengths; empty: not said. Throws Error as require_three() and require_page_size().
std::string clash_page(const Scene& scene, const ClashRecord& record, const std::string& unit);

/// Throws Error naming --html if no page can show the scene. To be called before the work.
void require_clash_page(const Scene& scene);

}  // namespace farcull
