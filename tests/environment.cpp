// The environment of all tests, set before main and before any thread. Verdicts about devices are
// kept in the build tree, once for all tests; the user's own are neither read nor written. Mesa's
// llvmpipe draws without threads, which may damage memory (docs/drivers.md), unless the caller says
// otherwise. Messages name parameters as on the command line.
#include <algorithm>
#include <cstdlib>
#include <string>

#include "core/base/error.h"

namespace {

[[maybe_unused]] const int kSet =
    ::setenv("XDG_CACHE_HOME", FARCULL_TEST_CACHE, 1) | ::setenv("LP_NUM_THREADS", "0", 0);

[[maybe_unused]] const int kSpelled = [] {
  farcull::spell_parameters([](const std::string& name) {
    if (name == "doctor" || name == "run") return "farcull " + name;
    std::string out = "--" + name;
    std::replace(out.begin(), out.end(), '_', '-');
    return out;
  });
  return 0;
}();

}  // namespace
