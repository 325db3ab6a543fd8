// Tests on each instruction set that this processor has.
#pragma once

#include "core/native/canvas.h"
#include "tests/lab/test.h"

namespace farcull {

/// Uses an instruction set until the end of its scope.
struct UseLanes {
  explicit UseLanes(const std::string& name) { use_lane_target(name); }
  ~UseLanes() { use_lane_target(""); }
};

/// Does the work on every instruction set of this processor.
template <class Work>
void on_every_target(const Work& work) {
  const std::vector<std::string> targets = lane_targets();
  ASSERT_GE(targets.size(), 1u);
  for (const std::string& target : targets) {
    SCOPED_TRACE("lanes of " + target);
    const UseLanes use(target);
    EXPECT_EQ(lane_target(), target);
    work();
  }
}

}  // namespace farcull
