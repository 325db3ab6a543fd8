// The pairs of tests/cases/libraries.txt: each is one at which a library erred, minimized by the
// study "libraries".
#pragma once

#include "experiments/peers/runner.h"
#include "experiments/suite/reader.h"
#include "tests/lab/test.h"

namespace farcull {

inline std::string library_examples_file() {
  return std::string(FARCULL_TEST_DIR) + "/cases/libraries.txt";
}

/// Asks a method of farcull about all of them, on a device: no answer differs from the label.
inline void expect_right_on_examples(const std::string& method, const std::string& device) {
  ::setenv("FARCULL_CONTEST_DEVICE", device.c_str(), 1);
  ::setenv("FARCULL_CONTESTANTS", FARCULL_CONTESTANTS_FOLDER, 1);
  const Invitation invitation = invite_known(known_contestant(method));
  ASSERT_TRUE(invitation.invited) << invitation.missing;
  const SuitePairs examples = read_pairs(library_examples_file());
  const PairsAnswer answer = ask_pairs(*invitation.invited, examples.pairs);
  for (const SuitePair& pair : examples.pairs) {
    EXPECT_EQ(to_string(answer.answers[pair.id].outcome), collides(pair.kind) ? "meets" : "apart")
        << method << " on " << device << ", pair " << pair.id << ", line " << pair.line << ": "
        << answer.answers[pair.id].reason;
  }
}

}  // namespace farcull
