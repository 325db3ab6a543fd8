// Probes the device assumptions A7, A8 and A10. A7: lost commands are noticed, and the next pass
// returns correct results. A8: after a barrier, later commands read what a dispatch or a draw
// wrote, and atomics neither lose nor repeat an update. (A weak barrier shows only on devices that
// reorder commands.) A10: the driver has no threads that are known to damage memory.
#include <algorithm>
#include <array>
#include <utility>

#include "core/gl/base/driver_fault.h"
#include "core/gl/probe/target.h"
#include "embedded/probe_frag.h"
#include "embedded/probe_memory_comp.h"

namespace farcull::probe {
namespace {

ProbeResult faults(const std::string& name, const GlContext& context, const ProbeOptions& options,
                   const GlCanvasOptions& kind) {
  // Stores proxy 0. Tests proxy 1, which is behind (seen), and proxy 2, in front (not seen).
  Drawables drawables;
  for (const float z : {0.0f, 10.0f, -10.0f}) {
    drawables.proxies.push_back(box(-20, -20, 20, 20));
    drawables.proxies.back().solid[0][2] = drawables.proxies.back().solid[0][3] = z;
    drawables.first.push_back(static_cast<std::uint32_t>(drawables.proxies.size()));
  }
  Pass pass;
  pass.slots = 2;
  pass.draws = {{0, 0}, {1, 0}, {2, 1}};
  pass.steps = {{Verb::store, 0, 1}, {Verb::ask, 1, 2}};
  const std::vector<std::uint8_t> right = {1, 0};
  using Kind = DriverFaultKind;
  using Named = std::pair<Kind, std::string>;
  const bool flags = kind.query == QueryMode::flags;
  const Named tried[] = {{Kind::lost_draw, "lost draw"},
                         flags ? Named(Kind::oversized_dispatch, "oversized dispatch")
                               : Named(Kind::lost_query, "lost query"),
                         flags ? Named(Kind::unfinished_item, "unfinished invocation")
                               : Named(Kind::blind_queries, "blind query")};
  Worst unnoticed;
  std::string note, refusal;
  for (const auto& [fault_kind, fault_name] : tried) {
    std::optional<DriverFault> fault;
    if (!options.skipped_faults) fault.emplace(fault_kind);
    GlCanvas canvas(context, DepthMode::fragment, depth_solid(), kind);
    canvas.begin(window(64, 64), drawables);
    if (fault) fault->strike();
    bool noticed = false;
    try {
      canvas.run(pass);
    } catch (const Error&) {
      noticed = true;
    }
    fault.reset();
    // The next pass must not fail, and must not return results of the faulty pass.
    bool recovered = false;
    try {
      canvas.begin(window(64, 64), drawables);
      recovered = canvas.run(pass) == right;
    } catch (const Error& error) {
      refusal = std::string("; ") + error.what();
    }
    unnoticed.count(!noticed);
    unnoticed.count(!recovered);
    note += (note.empty() ? "" : ", ") + fault_name + (noticed ? " noticed" : " NOT noticed") +
            (recovered ? "" : " (the next pass FAILS)");
  }
  return result("A7", name, unnoticed, 0, "unnoticed",
                note + "; the pass after each is counted, too" + refusal);
}

constexpr std::uint32_t kGroup = 64;      // local_size_x of probe_memory.comp
constexpr std::uint32_t kTakers = 65536;  // number of invocations, a power of two
constexpr std::uint32_t kSpread = 16;     // number of counters, as in probe_memory.comp

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

// Every invocation increments one counter, decrements another, sets its own bit, and sets a mark
// that it shares with one other invocation. Checks that a counter gives no number twice, that every
// bit is set, and that of two invocations exactly one finds the mark unset.
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

// Each invocation of a dispatch reads what another invocation of the previous dispatch wrote.
ProbeResult dispatches(const ProbeOptions& options) {
  constexpr std::uint32_t kLinks = 48;
  const GlProgram program = step_program(1, false);
  Random random(options.seed + 11);
  std::vector<std::uint32_t> expected(kTakers), next(kTakers);
  for (std::uint32_t& x : expected) x = static_cast<std::uint32_t>(random.word());
  GlBuffer buffers[2] = {gl_make<GlBuffer>(glGenBuffers), gl_make<GlBuffer>(glGenBuffers)};
  for (const GlBuffer& b : buffers) gl_fill(b, expected.data(), kTakers * sizeof(std::uint32_t));
  for (std::uint32_t link = 0; link < kLinks; ++link) {
    const auto salt = static_cast<std::uint32_t>(random.word());
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

// Checks that a dispatch reads the fragment counts that a draw wrote. Like all programs of the
// canvas that write to buffers, the drawing program has a discard. Without the discard, llvmpipe
// (Mesa 22.3.6) drops earlier work on a tile that a triangle covers, buffer writes included.
ProbeResult draws(const ProbeOptions& options) {
  constexpr int kSide = 512;
  constexpr std::uint32_t kPixels = kSide * kSide;
  const GlProgram count =
      proxy_program("count", {embedded::probe_frag}, {"FAR_COVERAGE", "FAR_DISCARD"});
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
    // Deliberate defect: the dispatch runs before the draw that writes the counts.
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

std::vector<ProbeResult> commands(const GlContext& context, const ProbeOptions& options) {
  std::vector<ProbeResult> out;
  on_canvases("A7", "faults are noticed", faults, context, options, out);
  return out;
}

std::vector<ProbeResult> memory(const GlContext&, const ProbeOptions& options) {
  return {atomics(options), dispatches(options), draws(options)};
}

// Counts the driver's threads that may write to freed memory. The damage itself is not measured.
std::vector<ProbeResult> driver(const GlContext& context, const ProbeOptions& options) {
  Worst threads;
  threads.add(driver_threads(context.info().renderer) + (options.one_thread ? 1 : 0));
  const std::string risk = risk_of_threads(context.info().renderer);
  return {result(
      "A10", "threads that may write to freed memory", threads, 0, "threads",
      risk.empty() ? "other damage that a driver may do to memory is not looked for" : risk)};
}

}  // namespace farcull::probe
