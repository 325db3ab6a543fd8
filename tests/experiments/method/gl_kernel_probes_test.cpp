// The probes of the shipped kernels pass on the default device, and each rejects a kernel that is
// wrong on purpose.
#include <gtest/gtest.h>

#include <set>

#include "experiments/method/device_verdict.h"
#include "tests/core/gl/gl_lab.h"

namespace farcull {
namespace {

std::vector<ProbeResult> run(const KernelProbeOptions& options) {
  std::vector<ProbeResult> out = pair_kernel_probes(lab::context(), options);
  for (ProbeResult& r : solid_kernel_probes(lab::context(), options)) out.push_back(std::move(r));
  return out;
}

std::set<std::string> failures(const KernelProbeOptions& options) {
  std::set<std::string> out;
  for (const ProbeResult& r : run(options))
    if (!r.pass) out.insert(r.name);
  return out;
}

using Names = std::set<std::string>;

TEST(GlKernelProbe, ShippedKernelsHoldTheRationalBounds) {
  for (const std::uint64_t seed : {1u, 5u}) {
    std::set<std::string> probed;
    for (const ProbeResult& r : run({.seed = seed})) {
      EXPECT_TRUE(r.pass) << r.name << ": " << r.measured << " of " << r.samples << " lost; "
                          << r.note;
      EXPECT_GT(r.samples, 10'000u) << r.name;
      EXPECT_EQ(r.assumption, "A4");
      probed.insert(r.name);
    }
    EXPECT_EQ(probed, (Names{"intervals of FAR pairs", "depth slices, float to int",
                             "oriented boxes", "exact offsets"}));
  }
}

TEST(GlKernelProbe, KernelsWithoutWideningAreRejected) {
  EXPECT_EQ(failures({.brief = true, .bare = true}),
            (Names{"intervals of FAR pairs", "oriented boxes", "exact offsets"}));
}

// And solids that are not seen, since what is stored is another one.
TEST(GlKernelProbe, ReversedSlicesAreRejected) {
  EXPECT_EQ(failures({.brief = true, .reversed_slices = true, .late_stores = true}),
            (Names{"depth slices, float to int", "oriented boxes", "exact offsets"}));
}

}  // namespace
}  // namespace farcull
