// What a run promises on a device: what the verdict about it allows. Twins: the same
// run where a probe has failed.
#include "experiments/method/device_verdict.h"
#include "experiments/record/output.h"
#include "experiments/record/tables.h"
#include "experiments/scenes/builtin/scenes.h"
#include "tests/lab/gl.h"
#include "tests/lab/unwrapped.h"

namespace farcull {
namespace {

RunOptions on_software(Method method) {
  RunOptions options;
  options.method = method;
  options.device = "software";
  options.resolution = method == Method::far ? 64 : 0;
  return options;
}

GlInfo software() {
  static const GlInfo info = GlContext("software").info();
  return info;
}

const std::vector<ProbeResult> kFailed = {{.assumption = "A4",
                                           .name = "a probe",
                                           .measured = 3,
                                           .bound = 1,
                                           .unit = "lost",
                                           .samples = 10,
                                           .pass = false,
                                           .note = "made to fail"}};

Scene scene() { return make_builtin_scene("two-spheres"); }

TEST(GlVerdict, RunsPromiseWhereTheProbesPass) {
  {
    Session session("software");
    const Record record = run(scene(), on_software(Method::far), session);
    EXPECT_TRUE(record.promise.holds) << record.promise.reason;
    ASSERT_TRUE(record.promise.verdict);
    EXPECT_TRUE(record.promise.verdict->holds);
    EXPECT_GT(record.promise.verdict->probes, 5u);
    const nlohmann::ordered_json json = to_json(scene(), record);
    EXPECT_EQ(json["promises"], true);
    EXPECT_EQ(json["verdict"]["holds"], true);
    const std::string table = lab::unwrapped(run_table(scene(), record));
    EXPECT_TRUE(has_text(table, "; promises to miss nothing\n"));
    EXPECT_TRUE(has_text(table, " pass on this device ("));
  }
}

TEST(GlVerdict, RunsPromiseNothingWhereAProbeFails) {
  const CacheFolder folder;
  {
    keep_verdict(software(), kFailed, 1);
    Session session("software");
    Record record = run(scene(), on_software(Method::far), session);
    EXPECT_FALSE(record.promise.holds);
    EXPECT_FALSE(record.collisions.pairs.empty());
    const nlohmann::ordered_json json = to_json(scene(), record);
    EXPECT_EQ(json["promises"], false);
    EXPECT_EQ(json["promise_reason"], "a probe fails on this device: A4 a probe: 3 lost, bound 1");
    EXPECT_EQ(json["verdict"]["failed"][0], "A4 a probe: 3 lost, bound 1");
    const std::string table = lab::unwrapped(run_table(scene(), record));
    EXPECT_FALSE(has_text(table, "promises to miss nothing"));
    EXPECT_TRUE(has_text(table, "\npromise    none: a probe fails on this device: A4 a probe"));
    // A miss still counts as one: the exit status asks the method, not the device. The twin: a
    // method that promises nothing by itself.
    EXPECT_FALSE(broken(record, false));
    record.verification->false_negatives = 1;
    EXPECT_TRUE(broken(record, false));
    record.options.method = Method::cullide;
    EXPECT_FALSE(broken(record, false));
    EXPECT_TRUE(broken(record, true));
  }
}

// The twin: without a failure the session keeps what it knows.
TEST(GlVerdict, ASessionThatForgetsItsDeviceForgetsItsVerdict) {
  const CacheFolder folder;
  Session session("software");
  EXPECT_TRUE(session.verdict().holds);
  keep_verdict(software(), kFailed, 1);
  EXPECT_TRUE(session.verdict().holds);
  session.forget_device();
  EXPECT_FALSE(session.verdict().holds);
}

TEST(GlVerdict, WhatUsesNoDeviceOrPromisesNothingAsksForNone) {
  const CacheFolder folder;
  Session session("software"), cpu("cpu");
  EXPECT_FALSE(run(scene(), on_software(Method::cullide), session).promise.verdict);
  RunOptions published = on_software(Method::far);
  published.radius.published = true;
  const Record record = run(scene(), published, session);
  EXPECT_FALSE(record.promise.verdict);
  EXPECT_FALSE(record.promise.holds);
  const Record on_cpu = run(scene(), on_software(Method::boxes), cpu);
  EXPECT_FALSE(on_cpu.promise.verdict);
  EXPECT_TRUE(on_cpu.promise.holds);
  EXPECT_FALSE(std::filesystem::exists(folder.path("farcull")));
}

std::vector<ProbeResult> run(const KernelProbeOptions& options) {
  return solid_kernel_probes(lab::context(), options);
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
    EXPECT_EQ(probed, (Names{"oriented boxes", "exact offsets"}));
  }
}

TEST(GlKernelProbe, KernelsWithoutWideningAreRejected) {
  EXPECT_EQ(failures({.bare = true}), (Names{"oriented boxes", "exact offsets"}));
}

// Solids that are not seen, since what is stored is another one.
TEST(GlKernelProbe, LateStoresAreRejected) {
  EXPECT_EQ(failures({.late_stores = true}), (Names{"oriented boxes", "exact offsets"}));
}

}  // namespace
}  // namespace farcull
