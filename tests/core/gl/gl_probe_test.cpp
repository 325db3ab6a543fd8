// Every probe of farcull doctor passes on the software device, and every one has a twin: a
// deliberate defect under which it must fail.
#include "core/gl/probe/probe.h"

#include "tests/lab/gl.h"

namespace farcull {
namespace {

const GlContext& context() {
  static const GlContext context("software");
  return context;
}

std::vector<ProbeResult> run(ProbeOptions options, const std::string& only) {
  options.only = only;
  return run_probes(context(), options);
}

std::set<std::string> failures(const ProbeOptions& options, const std::string& only) {
  std::set<std::string> out;
  for (const ProbeResult& r : run(options, only)) {
    EXPECT_EQ(r.assumption, only);
    if (!r.pass) out.insert(r.name);
  }
  return out;
}

using Names = std::set<std::string>;

// A third of the samples shows most of the defects.
const ProbeOptions kBrief{.brief = true};

TEST(GlProbe, EveryAssumptionIsProbedAndHolds) {
  std::set<std::string> probed;
  for (const ProbeResult& r : run({}, "")) {
    EXPECT_TRUE(r.pass) << r.assumption << " " << r.name << ": " << r.measured << " > " << r.bound
                        << " " << r.note;
    EXPECT_GT(r.samples, 0u) << r.name;
    EXPECT_LE(r.measured, r.bound) << r.name;
    EXPECT_FALSE(r.name.empty() || r.unit.empty() || r.note.empty()) << r.name;
    probed.insert(r.assumption);
  }
  EXPECT_EQ(probed,
            (std::set<std::string>{"A1", "A2", "A3", "A4", "A5", "A6", "A7", "A8", "A9", "A10"}));
}

// Displacements that are never zero: a probe whose edges all keep clear of pixel centres would
// measure none.
TEST(GlProbe, EdgesComeNearEnoughToMeasureSnapping) {
  const std::vector<ProbeResult> snapping = run({}, "A2");
  ASSERT_EQ(snapping.size(), 1u);
  EXPECT_GT(snapping[0].measured, 0.9 * 0x1p-9);  // half a step of the 8 bits that llvmpipe has
}

TEST(GlProbe, FailsWhereSnappingIsCoarserThanTheBound) {
  ProbeOptions options;  // it is seen in few of the samples
  options.snap_bits = 12;
  EXPECT_EQ(failures(options, "A2"), Names{"snapping"});
  // The sides of large proxies are displaced by snapping, too; the vertex term leaves it out.
  EXPECT_EQ(failures(options, "A1"), Names{"sides of large proxies"});
}

TEST(GlProbe, FailsWhereVertexArithmeticErrsMoreThanTheBound) {
  ProbeOptions options = kBrief;
  options.no_vertex_term = true;
  EXPECT_EQ(failures(options, "A1"), Names{"vertex arithmetic"});
  options.snap_bits = 12;
  EXPECT_EQ(failures(options, "A1"), (Names{"vertex arithmetic", "sides of large proxies"}));
}

TEST(GlProbe, FailsWhereATriangleOfTheSplitIsLost) {
  ProbeOptions options = kBrief;
  options.dropped_triangle = true;
  const Names failed = failures(options, "A3");
  EXPECT_TRUE(failed.count("split quadrilaterals cover once"));
  EXPECT_TRUE(failed.count("large quadrilaterals cover once"));
  EXPECT_TRUE(failed.count("abutting triangles cover once"));
  EXPECT_FALSE(failed.count("no area covers nothing"));
}

// Each defect, and the probes of its assumption that fail under it, and no others of it.
TEST(GlProbe, FailsUnderEachDefect) {
  struct Defect {
    bool ProbeOptions::*is;
    std::string assumption;
    Names failed;
  };
  for (const Defect& defect : std::vector<Defect>{
           {&ProbeOptions::fat_zero_area, "A3", {"no area covers nothing"}},
           {&ProbeOptions::shifted_pixel, "A9", {"gl_FragCoord names the pixel"}},
           {&ProbeOptions::exact_arithmetic, "A4", {"+ - *", "division", "precise"}},
           {&ProbeOptions::loose_text, "A4", {"precise"}},
           {&ProbeOptions::blind_queries,
            "A6",
            {"queries of single pixels", "areas, flags, 32F", "areas, occlusion queries, 32F",
             "areas, occlusion queries, 24 bits"}},
           {&ProbeOptions::skipped_faults,
            "A7",
            {"faults are noticed, flags, 32F", "faults are noticed, occlusion queries, 32F",
             "faults are noticed, occlusion queries, 24 bits"}},
           {&ProbeOptions::damaged_texel, "A5", {"texels of the depth buffer, 32F"}},
           {&ProbeOptions::plain_atomics, "A8", {"atomics"}},
           {&ProbeOptions::unordered_reads,
            "A8",
            {"dispatch after dispatch", "dispatch after draw"}},
           {&ProbeOptions::one_thread, "A10", {"threads that may write to freed memory"}}}) {
    ProbeOptions options = kBrief;
    options.*defect.is = true;
    EXPECT_EQ(failures(options, defect.assumption), defect.failed);
  }
}

TEST(GlProbe, FailsWhereOneBitIsDamaged) {
  ProbeOptions options = kBrief;
  options.damaged_operand = true;
  const Names failed = failures(options, "A4");
  EXPECT_TRUE(failed.count("min, max, abs, comparisons, buffer reads"));
  EXPECT_EQ(failures(options, "A9"), Names{"flat varyings and uniforms"});
}

TEST(GlProbe, FailsWhereTheDepthMapIsNotMonotone) {
  ProbeOptions options = kBrief;
  options.reversed_depth_map = true;
  EXPECT_EQ(failures(options, "A4"), (Names{"depth map, 32F", "depth map, 24 bits"}));
}

TEST(GlProbe, FailsWhereTheDepthTestKeepsTheFarthest) {
  const lab::ReversedDepth reversed;
  EXPECT_EQ(failures(kBrief, "A5"),
            (Names{"depth test, 32F", "depth test, 24 bits", "canvas, flags, 32F",
                   "canvas, occlusion queries, 32F", "canvas, occlusion queries, 24 bits"}));
}

}  // namespace
}  // namespace farcull
