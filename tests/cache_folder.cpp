// Verdicts about devices that tests make are kept in the build tree, once for all of them; the
// user's own are neither read nor written.
#include <cstdlib>

namespace {

[[maybe_unused]] const int kSet = ::setenv("XDG_CACHE_HOME", FARCULL_TEST_CACHE, 1);

}  // namespace
