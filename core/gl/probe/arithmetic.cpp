// Probes assumptions A4 (shader arithmetic) and A9 (shader inputs). Also runs solids' kernels.
#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <stdexcept>

#include "core/gl/probe/probe.h"
#include "core/gl/probe/target.h"
#include "embedded/canvas_frag.h"
#include "embedded/probe_frag.h"

namespace farcull::probe {
namespace {

constexpr double kUnit = 0x1p-23;
constexpr double kSmallest = 0x1p-126;  // smaller results may be flushed to 0
constexpr double kLargest = 0x1.fffffep127;
constexpr int kWidth = 1024, kHeight = 512;
constexpr std::size_t kCases = static_cast<std::size_t>(kWidth) * kHeight;

using Operands = std::array<float, 4>;  // operands a, b and c; the fourth is unused

float from_bits(std::uint32_t bits) { return std::bit_cast<float>(bits); }

// Returns the error of `got` relative to the exact value head + tail, in units of 2^-23. |tail| is
// tiny. A flush to 0 or an overflow that GLSL permits counts as no error.
double units(float got, double head, double tail) {
  const double exact = std::abs(head);
  if (exact > kLargest) {
    const bool right = std::signbit(got) == std::signbit(head) && std::abs(got) >= kLargest;
    return right ? 0 : std::numeric_limits<double>::infinity();
  }
  // The subtraction got - head is exact if `got` is near `head`.
  const double error = std::abs((static_cast<double>(got) - head) - tail);
  if (exact < kSmallest) return error <= kSmallest ? 0 : std::numeric_limits<double>::infinity();
  return error / (exact * kUnit);
}

double sum_units(float got, double a, double b) {
  const double s = a + b;
  const double part = s - a;
  return units(got, s, (a - (s - part)) + (b - part));  // exact sum by Knuth's two-sum
}

double quotient_units(float got, double a, double b) {
  const double exact = std::abs(a / b);
  if (a == 0 || exact < kSmallest)
    return std::abs(got) <= 2 * kSmallest ? 0 : std::numeric_limits<double>::infinity();
  if (std::signbit(got) != (std::signbit(a) != std::signbit(b)))
    return std::numeric_limits<double>::infinity();
  // got * b is exact in double. If `got` is near a / b, got * b - a is also exact.
  return std::abs(static_cast<double>(got) * b - a) / (std::abs(a) * kUnit);
}

std::vector<Operands> make_operands(Random& random) {
  std::vector<Operands> out(kCases);
  for (std::size_t i = 0; i < kCases; ++i) {
    float a = random.normal(-126, 127), b = random.normal(-126, 127);
    switch (i % 8) {
      case 1:  // magnitudes that are typical of kernels
      case 2:
        a = random.normal(-24, 20);
        b = random.normal(-24, 20);
        break;
      case 3:  // cancellation, and comparisons of adjacent floats
        a = random.normal(-100, 100);
        b = neighbour(a, random.below(7) - 3);
        if (random.below(2)) b = -b;
        break;
      case 4:  // |b| is 2 to 2^31 times |a|, so (a - b) + b often differs from a
        a = random.normal(-40, 40);
        b = std::ldexp(random.normal(0, 0), 1 + random.below(30)) * a;
        break;
      case 5:  // quotients and products near powers of two
        a = neighbour(std::ldexp(1.0f, random.below(80) - 40), random.below(9) - 4);
        b = neighbour(std::ldexp(1.0f, random.below(80) - 40), random.below(9) - 4);
        break;
      case 6:  // quotients that are whole numbers, or adjacent to them
        b = random.normal(-30, 30);
        a = neighbour(b * static_cast<float>(1 + random.below(4095)), random.below(3) - 1);
        break;
      case 7:  // zeros and equal operands
        if (random.below(4) == 0) a = random.below(2) ? 0.0f : -0.0f;
        if (random.below(4) == 0) b = random.below(2) ? a : -a;
        break;
      default:
        break;
    }
    float c = a * b;
    // Outside this range, a * b may be flushed to 0 or overflow. Then c gets a random value.
    if (!(std::abs(c) > 0x1p-100f && std::abs(c) < 0x1p100f)) c = random.normal(-24, 20);
    out[i] = {a, b, neighbour(c, random.below(3) - 1), 0};
  }
  return out;
}

struct Arithmetic {
  Worst rounded, quotient, wrong, chain;
};

// Compares the results of probe_case() (probe.frag) with exact results for the operands.
void judge(const std::vector<Operands>& operands, const std::vector<std::uint32_t>& results,
           Arithmetic& out) {
  for (std::size_t i = 0; i < operands.size(); ++i) {
    const auto [a, b, c, unused] = operands[i];
    const std::uint32_t* r = &results[12 * i];
    const float sum = from_bits(r[0]), difference = from_bits(r[1]), product = from_bits(r[2]);
    out.rounded.add(sum_units(sum, a, b));
    out.rounded.add(sum_units(difference, a, -static_cast<double>(b)));
    out.rounded.add(units(product, double{a} * b, 0));  // exact: a double can hold the product
    const double divisor = std::abs(b), quotient = divisor > 0 ? std::abs(a) / divisor : kLargest;
    if (divisor >= 0x1p-126 && divisor <= 0x1p126 && quotient < 0x1p126)
      out.quotient.add(quotient_units(from_bits(r[3]), a, b));
    // Compares the second operation of a chain with the device's own result of the first.
    if (std::abs(difference) < kLargest && std::abs(difference) >= kSmallest)
      out.chain.add(sum_units(from_bits(r[4]), difference, b));
    if (std::abs(product) > 0x1p-90f && std::abs(product) < kLargest)
      out.chain.add(sum_units(from_bits(r[5]), product, -static_cast<double>(c)));
    out.wrong.count(from_bits(r[6]) != std::min(a, b));
    out.wrong.count(from_bits(r[7]) != std::max(a, b));
    out.wrong.count(r[8] != std::bit_cast<std::uint32_t>(std::abs(a)));
    const std::uint32_t order =
        (a < b) | (a <= b) << 1 | (a > b) << 2 | (a >= b) << 3 | (a == b) << 4 | (a != b) << 5;
    out.wrong.count(r[9] != order);
    out.wrong.count(r[10] != std::bit_cast<std::uint32_t>(a));
    out.wrong.count(r[11] != std::bit_cast<std::uint32_t>(c));
  }
}

void damage(float& x) { x = from_bits(std::bit_cast<std::uint32_t>(x) ^ 1u << 22); }

std::vector<ProbeResult> operations(const ProbeOptions& options) {
  const std::string loose = options.loose_text ? "#undef FAR_PRECISE\n#define FAR_PRECISE\n" : "";
  const GlProgram program =
      proxy_program("arithmetic", {loose, embedded::probe_frag}, {"FAR_ARITHMETIC"});
  Target target(kWidth, kHeight);
  target.upload({box(-0.5 * kWidth, -0.5 * kHeight, 0.5 * kWidth, 0.5 * kHeight)});
  GlBuffer input = gl_make<GlBuffer>(glGenBuffers), results;
  Arithmetic found;
  Random random(options.seed + 4);
  for (int round = 0; round < rounds(options, 2); ++round) {
    const std::vector<Operands> operands = make_operands(random);
    std::vector<Operands> sent = operands;
    if (options.damaged_operand) damage(sent[kCases / 2 + 1][0]);
    gl_fill(input, sent.data(), sent.size() * sizeof(Operands));
    bind_zeros(results, 3, 12 * kCases);
    glBindBufferBase(GL_SHADER_STORAGE_BUFFER, 2, input);
    target.start();
    target.use(program);
    target.draw(0, 1);
    judge(operands, words_of(results, 12 * kCases), found);
  }
  const std::string unit = "2^-23 of the result";
  return {result("A4", "+ - *", found.rounded, options.exact_arithmetic ? 0 : 1, unit,
                 "random operands of all sizes, cancelling ones, ends of binades"),
          result("A4", "division", found.quotient, options.exact_arithmetic ? 0 : 2.5, unit,
                 "divisors in [2^-126, 2^126], quotients below 2^126"),
          result("A4", "min, max, abs, comparisons, buffer reads", found.wrong, 0, "wrong results",
                 "neighbours, equal operands and zeros among them"),
          result("A4", "precise", found.chain, options.exact_arithmetic ? 0 : 1, unit,
                 "(a - b) + b and a * b - c, each step against what the step before gave")};
}

ProbeResult transport(const ProbeOptions& options) {
  constexpr int kSide = 256;
  constexpr std::size_t kSlots = static_cast<std::size_t>(kSide) * kSide;
  Random random(options.seed + 5);
  Target target(kSide, kSide);
  const GlProgram program = proxy_program("transport", {embedded::probe_frag});
  std::vector<Proxy> proxies = pixel_proxies(kSide);
  for (Proxy& proxy : proxies) {
    for (auto& row : proxy.solid) {
      for (float& value : row) value = random.below(16) ? random.normal(-126, 127) : -0.0f;
    }
  }
  std::array<float, 256> values{};
  for (float& value : values) value = random.normal(-126, 127);
  std::vector<Proxy> sent = proxies;
  if (options.damaged_operand) damage(sent[kSlots / 2].solid[3][1]);
  target.upload(sent);
  target.start();
  GlBuffer varyings, uniforms;
  bind_zeros(varyings, 2, 20 * kSlots);
  bind_zeros(uniforms, 3, values.size());
  target.use(program);
  glUniform4fv(glGetUniformLocation(program, "u_values"), 64, values.data());
  target.draw(0, kSlots);
  Worst wrong;
  const std::vector<std::uint32_t> got = words_of(varyings, 20 * kSlots);
  for (std::size_t i = 0; i < got.size(); ++i) {
    const float value = proxies[i / 20].solid[i % 20 / 4][i % 4];
    wrong.count(got[i] != std::bit_cast<std::uint32_t>(value));
  }
  const std::vector<std::uint32_t> back = words_of(uniforms, values.size());
  for (std::size_t i = 0; i < values.size(); ++i)
    wrong.count(back[i] != std::bit_cast<std::uint32_t>(values[i]));
  return result("A9", "flat varyings and uniforms", wrong, 0, "wrong words",
                "every word of 65,536 proxies as the canvas passes them on, and 256 of uniforms");
}

// Runs canvas.frag on ascending depths. Checks that the mapped depths do not decrease, that entries
// are mapped into [1/4, 3/4], and that exits are mapped to at most 3/4 + kAskedBehind. If an entry
// and an exit have the same depth, the exit must not be mapped before the entry.
ProbeResult depth_map(const ProbeOptions& options, DepthBuffer format) {
  constexpr int kSide = 256;
  constexpr std::size_t kPixels = static_cast<std::size_t>(kSide) * kSide;
  Random random(options.seed + 6);
  Target target(kSide, kSide, format);
  const GlProgram store = proxy_program("store", {kDepthSolid, embedded::canvas_frag});
  const GlProgram ask = proxy_program("ask", {kDepthSolid, embedded::canvas_frag}, {ask_define()});
  Worst wrong;
  for (const float reach : {3.0f, 130.0f, 8200.0f, 1048576.0f}) {
    std::vector<float> z;
    while (z.size() < kPixels) {
      const float base = z.size() % 3 == 0 ? random.in_float(-1.25 * reach, 1.25 * reach)
                                           : random.normal(-60, 0) * reach;
      for (int k = 0; k < 4 && z.size() < kPixels; ++k)
        z.push_back(neighbour(base, k));  // adjacent floats
    }
    std::sort(z.begin(), z.end());
    std::vector<Proxy> proxies = pixel_proxies(kSide);
    for (std::size_t i = 0; i < kPixels; ++i)
      proxies[i].solid[0][2] = proxies[i].solid[0][3] = z[i];
    target.upload(proxies);
    const auto depths = [&](GLuint program) {
      target.start();
      Target::depth_test(GL_LESS, true);
      target.use(program, (options.reversed_depth_map ? -0.25f : 0.25f) / reach);
      target.draw(0, kPixels);
      return target.depths();
    };
    const std::vector<std::uint32_t> entry = depths(store), exit = depths(ask);
    const bool floats = format == DepthBuffer::float32;
    // The bits of 1/4 and 3/4. Floats hold both exactly; fixed point may err by at most 2^-24.
    const std::uint32_t least = floats ? std::bit_cast<std::uint32_t>(0.25f) : 0x3fffff00u;
    const std::uint32_t most = floats ? std::bit_cast<std::uint32_t>(0.75f) : 0xc0000100u;
    const std::uint32_t behind = floats ? std::bit_cast<std::uint32_t>(0.75f + kAskedBehind)
                                        : most + static_cast<std::uint32_t>(kAskedBehind * 0x1p32);
    for (std::size_t i = 0; i < kPixels; ++i) {
      wrong.count(entry[i] < least || entry[i] > most || exit[i] < entry[i] || exit[i] > behind ||
                  (i > 0 && (entry[i] < entry[i - 1] || exit[i] < exit[i - 1])));
    }
  }
  return result(
      "A4", format == DepthBuffer::float32 ? "depth map, 32F" : "depth map, 24 bits", wrong, 0,
      "wrong depths",
      "canvas.frag on sorted depths, neighbouring floats among them: order, range, an exit "
      "not before an entry at the same depth");
}

}  // namespace

std::vector<ProbeResult> arithmetic(const GlContext&, const ProbeOptions& options) {
  std::vector<ProbeResult> out = operations(options);
  out.push_back(transport(options));
  out.push_back(depth_map(options, DepthBuffer::float32));
  out.push_back(depth_map(options, DepthBuffer::fixed24));
  return out;
}

}  // namespace farcull::probe

// The functions below run kernels on test cases. A canvas draws each case's solid in its own pixel
// of a square window. Entry and exit depths, or visibility, are read back.
namespace farcull {

std::vector<SolidAnswer> device_solids(const GlContext& context, const SolidProgram& solid,
                                       std::span<const SolidCase> cases) {
  if (cases.size() != kSolidCases) throw std::logic_error("device_solids: not as many cases");
  Drawables drawables;
  std::vector<Draw> draws;
  for (std::size_t i = 0; i < cases.size(); ++i) {
    drawables.proxies.push_back(probe::pixel_box(static_cast<int>(i), kSolidSide));
    drawables.proxies.back().solid = cases[i].solid;
    drawables.first.push_back(static_cast<std::uint32_t>(i + 1));
    draws.push_back({static_cast<std::uint32_t>(i), 0});
  }
  const GlCurrent current(context);
  GlCanvas canvas(context, DepthMode::fragment, solid);
  canvas.begin(probe::window(kSolidSide, kSolidSide), drawables);
  const std::vector<float> entry = canvas.samples(Verb::store, draws);
  const std::vector<float> exit = canvas.samples(Verb::ask, draws);
  std::vector<SolidAnswer> out;
  // samples() returns NaN where no fragment was drawn. An answer with one NaN counts as wrong.
  for (std::size_t i = 0; i < cases.size(); ++i)
    out.push_back({!std::isnan(entry[i]) || !std::isnan(exit[i]), entry[i], exit[i]});
  return out;
}

std::vector<std::uint8_t> device_seen(const GlContext& context, const SolidProgram& solid,
                                      std::span<const SolidCase> stored,
                                      std::span<const SolidCase> asked, double depth) {
  constexpr auto kCases = static_cast<std::uint32_t>(kSolidCases);
  Drawables drawables;
  Pass pass;
  pass.slots = kCases;
  pass.steps = {{Verb::store, 0, kCases}, {Verb::ask, kCases, kCases}};
  for (const std::span<const SolidCase> cases : {stored, asked}) {
    if (cases.size() != kSolidCases) throw std::logic_error("device_seen: not as many cases");
    for (std::uint32_t i = 0; i < kCases; ++i) {
      pass.draws.push_back({static_cast<std::uint32_t>(drawables.proxies.size()), i});
      drawables.proxies.push_back(probe::pixel_box(static_cast<int>(i), kSolidSide));
      drawables.proxies.back().solid = cases[i].solid;
      drawables.first.push_back(static_cast<std::uint32_t>(drawables.proxies.size()));
    }
  }
  const GlCurrent current(context);
  std::vector<std::uint8_t> out(kCases, 1);
  for (const probe::Configuration& configuration : probe::kConfigurations) {
    GlCanvas canvas(context, DepthMode::fragment, solid, configuration.options);
    canvas.begin(probe::window(kSolidSide, kSolidSide, depth), drawables);
    const std::vector<std::uint8_t> seen = canvas.run(pass);
    for (std::uint32_t i = 0; i < kCases; ++i) out[i] = out[i] != 0 && seen[i] != 0;
  }
  return out;
}

}  // namespace farcull
