// A test of faults expects this of every outcome, and prints these numbers.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>
#include <vector>

#include "tests/faults/gl_calls.h"

namespace farcull::lab {

/// The answer is right, or there is an error; the next answer is right; no call hangs.
inline void expect_no_wrong_answer(const char* what, const std::vector<GlFaultOutcome>& outcomes) {
  std::size_t threw = 0, wrong = 0, next_wrong = 0, slow = 0;
  double longest = 0;
  for (const GlFaultOutcome& o : outcomes) {
    threw += o.threw;
    longest = std::max(longest, o.seconds);
    if (!o.threw && !o.right) {
      ++wrong;
      ADD_FAILURE() << what << " " << o.at << ", " << o.function << ": a wrong answer";
    }
    if (!o.next_right) {
      ++next_wrong;
      ADD_FAILURE() << what << " " << o.at << ", " << o.function << ": the next answer is wrong"
                    << (o.next_error.empty() ? "" : ": ") << o.next_error
                    << "; before it: " << o.error;
    }
    slow += o.seconds > 60;
  }
  EXPECT_EQ(slow, 0u) << what;
  std::printf(
      "%s: %zu tried, %zu errors, %zu wrong answers, %zu wrong next answers, longest %.1f s\n",
      what, outcomes.size(), threw, wrong, next_wrong, longest);
}

}  // namespace farcull::lab
