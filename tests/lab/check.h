// `farcull check` as a function, for its tests.
#pragma once

#include "experiments/command/check.h"
#include "tests/lab/test.h"

namespace farcull {

/// The command's status and what it printed.
struct ProgramAnswer {
  int status = -1;
  std::string text;
  std::string line() const { return text.substr(0, text.find('\n')); }
};

inline ProgramAnswer check(const CheckArguments& arguments) {
  testing::internal::CaptureStdout();
  ProgramAnswer answer;
  try {
    answer.status = run_check(arguments);
  } catch (...) {
    testing::internal::GetCapturedStdout();
    throw;
  }
  answer.text = testing::internal::GetCapturedStdout();
  return answer;
}

}  // namespace farcull
