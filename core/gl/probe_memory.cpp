// A8: values that a dispatch or a draw wrote are seen after the barrier, and atomics neither lose
// nor double. A missing or weak barrier shows only on devices that reorder: these probes can
// refute, on the device that they run on. And A5's texels: a shader reads the depth that was
// stored, to the bit. And A10: the driver has no threads that are known to damage memory.
#include <algorithm>
#include <array>

#include "core/gl/driver_threads.h"
#include "core/gl/probe_groups.h"
#include "core/gl/probe_target.h"
#include "embedded/probe_coverage_frag.h"
#include "embedded/probe_depth_frag.h"
#include "embedded/probe_memory_comp.h"
#include "embedded/probe_texel_comp.h"

namespace farcull::probe {
namespace {

constexpr std::uint32_t kGroup = 64;      // local_size_x
constexpr std::uint32_t kTakers = 65536;  // a power of two
constexpr std::uint32_t kSpread = 16;     // counters, as in the text

GlProgram step_program(int step, bool plain) {
  std::vector<std::string> defines = {"FAR_STEP " + std::to_string(step)};
  if (plain) defines.emplace_back("FAR_PLAIN");
  return gl_program("probe memory", defines, {{GL_COMPUTE_SHADER, {embedded::probe_memory_comp}}});
}

void run(GLuint program, GLuint from, GLuint to, std::uint32_t count, std::uint32_t salt = 0) {
  glUseProgram(program);
  glUniform1ui(0, count);
  glUniform1ui(1, salt);
  glBindBufferBase(GL_SHADER_STORAGE_BUFFER, 0, from);
  glBindBufferBase(GL_SHADER_STORAGE_BUFFER, 1, to);
  glDispatchCompute((count + kGroup - 1) / kGroup, 1, 1);
}

// Every ticket of every counter is taken once, every bit is set, and of two invocations one alone
// finds its mark unset.
ProbeResult atomics(const ProbeOptions& options) {
  const GlProgram program = step_program(0, options.plain_atomics);
  Worst wrong;
  constexpr std::uint32_t kRounds = 4, kEach = kTakers / kSpread;
  constexpr std::size_t kWords = 2 * kSpread + kTakers / 32 + kTakers / 2;
  for (std::uint32_t round = 0; round < kRounds; ++round) {
    std::vector<std::uint32_t> start(kWords, 0);
    std::fill_n(start.begin() + kSpread, kSpread, kEach);
    const GlBuffer shared = gl_make<GlBuffer>(glGenBuffers);
    gl_fill(shared, start.data(), start.size() * sizeof(std::uint32_t));
    GlBuffer taken;
    bind_zeros(taken, 1, std::size_t{3} * kTakers);
    run(program, shared, taken, kTakers);
    const std::vector<std::uint32_t> tickets = words_of(taken, std::size_t{3} * kTakers);
    const std::vector<std::uint32_t> after = words_of(shared, kWords);
    std::array<std::vector<std::uint32_t>, kSpread> up, down;
    for (std::uint32_t w = 0; w < kTakers; ++w) {
      up[w % kSpread].push_back(tickets[3 * w]);
      down[w % kSpread].push_back(tickets[3 * w + 1]);
    }
    for (std::uint32_t k = 0; k < kSpread; ++k) {
      std::sort(up[k].begin(), up[k].end());
      std::sort(down[k].begin(), down[k].end());
      for (std::uint32_t n = 0; n < kEach; ++n) {
        wrong.count(up[k][n] != n);
        wrong.count(down[k][n] != n + 1);
      }
      wrong.count(after[k] != kEach);
      wrong.count(after[kSpread + k] != 0);
    }
    for (std::uint32_t i = 0; i < kTakers / 32; ++i)
      wrong.count(after[2 * kSpread + i] != 0xffffffff);
    for (std::uint32_t w = 0; w < kTakers; w += 2)
      wrong.count(tickets[3 * w + 2] + tickets[3 * (w + 1) + 2] != 1);
  }
  return result("A8", "atomics", wrong, 0, "wrong words",
                "65,536 invocations, 4 times: tickets up and down of 16 counters, each taken once; "
                "bits; one winner of two");
}

// Each dispatch reads what others of the one before wrote, in another order.
ProbeResult dispatches(const ProbeOptions& options) {
  constexpr std::uint32_t kLinks = 48;
  const GlProgram program = step_program(1, false);
  Random random(options.seed + 11);
  std::vector<std::uint32_t> expected(kTakers), next(kTakers);
  for (std::uint32_t& x : expected) x = static_cast<std::uint32_t>(random.bits());
  GlBuffer buffers[2] = {gl_make<GlBuffer>(glGenBuffers), gl_make<GlBuffer>(glGenBuffers)};
  for (const GlBuffer& b : buffers) gl_fill(b, expected.data(), kTakers * sizeof(std::uint32_t));
  for (std::uint32_t link = 0; link < kLinks; ++link) {
    const auto salt = static_cast<std::uint32_t>(random.bits());
    const std::uint32_t from = link % 2, to = options.unordered_reads ? from : 1 - from;
    run(program, buffers[from], buffers[to], kTakers, salt);
    glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT);
    for (std::uint32_t w = 0; w < kTakers; ++w) {
      const std::uint32_t other = (w * 40503u + salt) & (kTakers - 1);
      next[w] = expected[other] * 1664525u + (w ^ salt);
    }
    expected.swap(next);
  }
  const std::vector<std::uint32_t> got = words_of(buffers[kLinks % 2], kTakers);
  Worst wrong;
  for (std::uint32_t w = 0; w < kTakers; ++w) wrong.count(got[w] != expected[w]);
  return result("A8", "dispatch after dispatch", wrong, 0, "wrong words",
                "48 in a chain, each reads what other groups of the one before wrote");
}

// A draw counts the fragments of each pixel, a dispatch reads the counts. The program has a
// discard, as all programs of the canvas that write to buffers: without one, llvmpipe (Mesa 22.3.6)
// drops what a tile was to do before a triangle that covers all of it, buffer writes included.
ProbeResult draws(const ProbeOptions& options) {
  constexpr int kSide = 512;
  constexpr std::uint32_t kPixels = kSide * kSide;
  const GlProgram count = proxy_program("count", {embedded::probe_coverage_frag}, {"FAR_DISCARD"});
  const GlProgram copy = step_program(2, false);
  Target target(kSide, kSide);
  constexpr double kHalf = 0.5 * kSide;
  target.upload(std::vector<Proxy>(4, box(-kHalf, -kHalf, kHalf, kHalf)));
  Worst wrong;
  for (std::uint32_t layers = 1; layers <= 4; ++layers) {
    GlBuffer counts, copied;
    bind_zeros(copied, 1, kPixels);
    bind_zeros(counts, 2, kPixels);
    target.start();
    target.use(count);
    // The twin's dispatch goes before the draw that it should follow.
    if (options.unordered_reads) run(copy, counts, copied, kPixels);
    glUseProgram(count);
    glBindBufferBase(GL_SHADER_STORAGE_BUFFER, 2, counts);
    target.draw(0, layers);
    glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT);
    if (!options.unordered_reads) run(copy, counts, copied, kPixels);
    for (const std::uint32_t n : words_of(copied, kPixels)) wrong.count(n != layers);
  }
  return result("A8", "dispatch after draw", wrong, 0, "wrong words",
                "fragments of 1 to 4 layers counted by atomics, read by a dispatch");
}

}  // namespace

ProbeResult texels(const ProbeOptions& options) {
  constexpr int kSide = 256;
  constexpr std::uint32_t kPixels = kSide * kSide;
  Random random(options.seed + 12);
  Target target(kSide, kSide, DepthBuffer::float32);
  const GlProgram store = proxy_program("depth", {embedded::probe_depth_frag});
  const GlProgram read =
      gl_program("probe texels", {}, {{GL_COMPUTE_SHADER, {embedded::probe_texel_comp}}});
  std::vector<Proxy> proxies;
  std::vector<float> depths;
  for (std::uint32_t i = 0; i < kPixels; ++i) {
    proxies.push_back(pixel_box(static_cast<int>(i), kSide));
    // Those of the depth map, its ends, control items', and small ones.
    float d = random.in_float(0.25, 0.75);
    if (i % 4 == 1) d = neighbour(random.below(2) ? 0.25f : 0.75f, random.below(9) - 4);
    if (i % 4 == 2) d = random.in_float(0, 1);
    if (i % 64 == 3) d = random.below(2) ? 0.0f : 1.0f;
    depths.push_back(d);
    proxies.back().solid[4][2] = d;
  }
  target.upload(proxies);
  target.start();
  Target::depth_test(GL_LEQUAL, true);
  target.use(store);
  target.draw(0, kPixels);
  glBindFramebuffer(GL_FRAMEBUFFER, 0);
  GlBuffer got;
  bind_zeros(got, 1, kPixels);
  glUseProgram(read);
  glUniform1ui(0, kPixels);
  glUniform1ui(1, kSide);
  glUniform1i(2, 0);
  glActiveTexture(GL_TEXTURE0);
  glBindTexture(GL_TEXTURE_2D, target.depth_texture());
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_NEAREST);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_COMPARE_MODE, GL_NONE);
  glDispatchCompute(kPixels / kGroup, 1, 1);
  Worst wrong;
  const std::vector<std::uint32_t> words = words_of(got, kPixels);
  for (std::uint32_t i = 0; i < kPixels; ++i) {
    const std::uint32_t kept =
        std::bit_cast<std::uint32_t>(depths[i]) ^ (options.damaged_texel && i == 77 ? 1u : 0u);
    wrong.count(words[i] != kept);
  }
  return result("A5", "texels of the depth buffer, 32F", wrong, 0, "wrong texels",
                "a shader reads what a draw stored, to the bit");
}

std::vector<ProbeResult> memory(const GlContext&, const ProbeOptions& options) {
  return {atomics(options), dispatches(options), draws(options)};
}

// Memory that a driver damages cannot be seen from outside. Of one fault the cause is known.
std::vector<ProbeResult> driver(const GlContext& context, const ProbeOptions& options) {
  Worst threads;
  threads.add(driver_threads(context.info().renderer) + (options.one_thread ? 1 : 0));
  const std::string risk = risk_of_threads(context.info().renderer);
  return {result(
      "A10", "threads that may write to freed memory", threads, 0, "threads",
      risk.empty() ? "other damage that a driver may do to memory is not looked for" : risk)};
}

}  // namespace farcull::probe
