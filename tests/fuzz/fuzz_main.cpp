// The entry that libFuzzer calls; FARCULL_FUZZ_TARGET is the target that this program runs.
#include <cstdio>
#include <cstdlib>

#include "tests/fuzz/target.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  try {
    farcull::FARCULL_FUZZ_TARGET(data, size);
  } catch (const farcull::FuzzFinding& finding) {
    std::fprintf(stderr, "finding: %s\n", finding.what.c_str());
    std::abort();
  }
  return 0;
}
