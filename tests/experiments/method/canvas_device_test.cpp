// Which canvas draws, with --device and without it, and what the native canvas says of itself.
// gl_methods_test.cpp tests that GL draws where it is named.
#include "experiments/record/output.h"
#include "experiments/record/tables.h"
#include "experiments/scenes/builtin/scenes.h"
#include "tests/lab/test.h"
#include "tests/lab/unwrapped.h"

namespace farcull {
namespace {

RunOptions far_on(const std::string& device) {
  RunOptions options{.method = Method::far};
  options.resolution = 64;
  options.device = device;
  return options;
}

TEST(CanvasDevice, WithoutADeviceTheRuleIsSaidAndNativeDrawsWhereNoHardwareAnswers) {
  Session session("", 0, Say());
  const CanvasDevice& chosen = session.canvas_device();
  EXPECT_TRUE(has_text(chosen.reason, "GPU")) << chosen.reason;
  bool hardware = false;
  try {
    hardware = GlContext::hardware_listed();
  } catch (const Error&) {  // no EGL
  }
  if (!hardware) {
    EXPECT_TRUE(chosen.native);
  }
  const Record record = run(make_builtin_scene("two-spheres"), far_on(""), session);
  EXPECT_EQ(record.found.device.cpu, chosen.native);
  EXPECT_EQ(record.found.device.gl.has_value(), !chosen.native);
  EXPECT_EQ(record.found.device.note, chosen.reason);
}

TEST(CanvasDevice, UnknownNamesAreRefusedAndSaid) {
  for (const char* name : {"nativ", "CPU", "gpu", "-1", "native "})
    EXPECT_THROW(validate(far_on(name)), Error) << name;
  for (const char* name : {"", "native", "cpu", "gl", "software", "hardware", "0", "12"})
    EXPECT_NO_THROW(validate(far_on(name))) << name;
}

// One way to ask: neither the query mode nor the depth format changes the pairs of FAR, and the
// record says what drew.
TEST(CanvasDevice, QueryModesAndDepthFormatsWorkOnTheNativeCanvasAndAreSaid) {
  const Scene scene = make_builtin_scene("crowd");
  Session session("native");
  const Record usual = run(scene, far_on("native"), session);
  ASSERT_FALSE(usual.collisions.pairs.empty());
  RunOptions asked = far_on("native"), coarse = asked;
  asked.query = QueryMode::occlusion;
  coarse.depth_format = DepthFormat::fixed24;
  for (const RunOptions& options : {far_on("native"), asked, coarse}) {
    const Record record = run(scene, options, session);
    EXPECT_EQ(record.collisions.pairs, usual.collisions.pairs);
    EXPECT_EQ(record.verification->false_negatives, 0u);
    EXPECT_TRUE(record.promise.holds);
    EXPECT_FALSE(record.promise.verdict) << "nothing rests on a device";
    const bool bits24 = options.depth_format == DepthFormat::fixed24;
    const nlohmann::ordered_json json = to_json(scene, record);
    EXPECT_EQ(json["device"], (nlohmann::ordered_json{{"cpu", "--device native"},
                                                      {"lanes", lane_target()},
                                                      {"depth_bits", bits24 ? 24 : 32}}));
    EXPECT_EQ(json["query"], nullptr);
    EXPECT_EQ(json["depth_format"], bits24 ? "24" : "32f");
    const std::string table = lab::unwrapped(run_table(scene, record));
    EXPECT_TRUE(has_text(table, "lanes of " + lane_target()));
    EXPECT_FALSE(has_text(table, "occlusion queries"));
  }
  RunOptions both = coarse;
  both.query = QueryMode::flags;
  EXPECT_THROW(validate(both), Error) << "as on GL: options are checked before a device is chosen";
}

}  // namespace
}  // namespace farcull
