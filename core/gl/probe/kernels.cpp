// Solids are drawn by a canvas, one to a pixel of a square window, and their entry and exit depths
// read back. Intervals and slices go to a compute shader as words, one invocation to a case.
#include "core/gl/probe/probe.h"

#include <bit>
#include <cmath>
#include <stdexcept>

#include "core/gl/probe/target.h"
#include "embedded/interval_glsl.h"
#include "embedded/pair_rows_glsl.h"
#include "embedded/probe_kernels_comp.h"

namespace farcull {
namespace {

using probe::bind_zeros;
using probe::words_of;

constexpr std::size_t kGroup = 64;  // local_size_x

// Runs `text` once for each of `count` cases of `in` words, each of which gives `out` words.
std::vector<std::uint32_t> compute(const GlContext& context, const std::string& name,
                                   const std::vector<std::string>& texts,
                                   const std::vector<std::uint32_t>& cases, std::size_t count,
                                   std::size_t out) {
  const GlCurrent current(context);
  const GlProgram program = gl_program("probe " + name, {}, {{GL_COMPUTE_SHADER, texts}});
  const GlBuffer input = gl_make<GlBuffer>(glGenBuffers);
  GlBuffer answers;
  gl_fill(input, cases.data(), cases.size() * sizeof(std::uint32_t));
  bind_zeros(answers, 1, out * count);
  glBindBufferBase(GL_SHADER_STORAGE_BUFFER, 0, input);
  glUseProgram(program);
  glUniform1ui(0, static_cast<GLuint>(count));
  glDispatchCompute(static_cast<GLuint>((count + kGroup - 1) / kGroup), 1, 1);
  return words_of(answers, out * count);
}

float value(std::uint32_t bits) { return std::bit_cast<float>(bits); }
std::uint32_t bits(float value) { return std::bit_cast<std::uint32_t>(value); }

}  // namespace

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
  // Hit by only one of the two is an answer that holds nothing.
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

std::vector<IntervalAnswer> device_intervals(const GlContext& context,
                                             std::span<const IntervalCase> cases,
                                             const std::string& before) {
  std::vector<std::uint32_t> words;
  for (const IntervalCase& c : cases) {
    for (const auto& corner : c.corners) {
      for (const float x : corner) words.push_back(bits(x));
      words.push_back(bits(c.widening));
    }
    words.insert(words.end(),
                 {static_cast<std::uint32_t>(c.i), static_cast<std::uint32_t>(c.j), 0, 0});
  }
  const std::vector<std::uint32_t> got = compute(
      context, "intervals",
      {before, embedded::interval_glsl, embedded::pair_rows_glsl, embedded::probe_kernels_comp},
      words, cases.size(), 12);
  std::vector<IntervalAnswer> out;
  for (std::size_t n = 0; n < cases.size(); ++n) {
    const std::uint32_t* w = &got[12 * n];
    out.push_back({{value(w[0]), value(w[1]), value(w[2])},
                   {value(w[4]), value(w[5]), value(w[6])},
                   value(w[3]),
                   value(w[7]),
                   w[10] == 1,
                   value(w[8]),
                   value(w[9])});
  }
  return out;
}

std::vector<SliceAnswer> device_slices(const GlContext& context, std::span<const SliceCase> cases) {
  std::vector<std::uint32_t> words;
  for (const SliceCase& c : cases)
    words.insert(words.end(),
                 {bits(c.z), bits(c.steps_per_px), static_cast<std::uint32_t>(c.first_step),
                  static_cast<std::uint32_t>(c.slices_per_step), bits(c.x), 0, 0, 0});
  const std::vector<std::uint32_t> got =
      compute(context, "slices",
              {"#define FAR_SLICES\n", embedded::interval_glsl, embedded::probe_kernels_comp},
              words, cases.size(), 2);
  std::vector<SliceAnswer> out;
  for (std::size_t n = 0; n < cases.size(); ++n)
    out.push_back(
        {static_cast<std::int32_t>(got[2 * n]), static_cast<std::int32_t>(got[2 * n + 1])});
  return out;
}

}  // namespace farcull
