// Each probe counts what may not happen at all, so its bound is 0.
#include "experiments/lemma/native_probes.h"

#include <fmt/format.h>

#include <bit>

#include "core/native/canvas.h"
#include "core/native/lanes.h"
#include "experiments/lemma/lemma.h"
#include "offsets/fit.h"
#include "offsets/minkowski.h"
#include "offsets/obb.h"
#include "verify/kernel_check.h"

namespace farcull {
namespace {

constexpr std::size_t kCases = 6000;
constexpr std::uint64_t kPoints = 60'000;
constexpr std::uint64_t kSeed = 1;

using Check = void (*)(const SolidCase&, const SolidAnswer&, bool ordinary, KernelTally&);
using Fatten = Solid (*)(const KernelTriangle&);
using Adversarial = Solid (*)(std::uint64_t seed, std::uint64_t index, float cx, float cy);

struct Kernel {
  const char* name;
  SolidProgram program;
  Fatten fatten;
  Adversarial adversarial;
  Check check;
};

std::vector<Kernel> kernels() {
  return {{"oriented boxes", obb_fattener().solid,
           [](const KernelTriangle& t) { return obb_of(t.corners, t.radius); }, adversarial_box,
           check_box},
          {"exact offsets", minkowski_fattener().solid,
           [](const KernelTriangle& t) {
             return minkowski_solid(t.corners[0], t.corners[1], t.corners[2], t.radius);
           },
           adversarial_minkowski, check_minkowski}};
}

bool same(const SolidAnswer& a, const SolidAnswer& b) {
  const auto bits = [](float x) { return std::bit_cast<std::uint32_t>(x); };
  return a.hit == b.hit &&
         (!a.hit || (bits(a.entry) == bits(b.entry) && bits(a.exit) == bits(b.exit)));
}

SolidAnswer on_lanes(const SolidProgram& program, const SolidCase& c) {
  SolidAnswer answer{};
  std::uint8_t hit = 0;
  program.lines_native({&c.solid, 1, &c.cx, &c.cy, &hit, &answer.entry, &answer.exit});
  answer.hit = hit != 0;
  return answer;
}

// Half of the solids are fattened triangles, half are made of floats directly.
ProbeResult probe(const Kernel& kernel, const std::string& target) {
  KernelTally tally;
  std::uint64_t different = 0;
  for (std::size_t i = 0; i < kCases; ++i) {
    SolidCase c{static_cast<float>(i % 97) - 48.5f, static_cast<float>(i % 89) - 44.5f, {}};
    bool ordinary = false;
    if (i % 2 == 0) {
      const KernelTriangle t = kernel_triangle(kSeed, i, c.cx, c.cy);
      ordinary = t.ordinary;
      c.solid = kernel.fatten(t);
    } else {
      c.solid = kernel.adversarial(kSeed, i, c.cx, c.cy);
    }
    const SolidAnswer answer = on_lanes(kernel.program, c);
    SolidAnswer scalar{};
    scalar.hit = kernel.program.interval(c.cx, c.cy, c.solid, scalar.entry, scalar.exit);
    kernel.check(c, answer, ordinary, tally);
    different += !same(answer, scalar);
  }
  return {.assumption = "A4",
          .name = fmt::format("{}, lanes of {}", kernel.name, target),
          .measured = static_cast<double>(tally.lost + different),
          .unit = "lost or other bits",
          .samples = tally.checked,
          .pass = tally.checked > 0 && tally.lost == 0 && different == 0,
          .note = {}};
}

// Lemmas 1 and 2 on the native canvas, with both offsets.
std::vector<ProbeResult> lemma_probes() {
  LemmaSettings settings;
  settings.points = kPoints;
  settings.seed = kSeed;
  settings.displace = true;
  settings.radius = [](const Budget& budget, double) { return budget.radius(); };
  LemmaRow sum;
  for (const Fattener& fattener : {obb_fattener(), minkowski_fattener()}) {
    NativeCanvas canvas(fattener.mode, fattener.solid);
    const LemmaRow total = lemma_total(lemma_experiment(canvas, fattener, settings));
    sum.points += total.points;
    sum.no_sample += total.no_sample;
    sum.not_bounding += total.not_bounding;
  }
  const auto result = [&sum](const char* assumption, const char* name, std::uint64_t found) {
    return ProbeResult{.assumption = assumption,
                       .name = name,
                       .measured = static_cast<double>(found),
                       .unit = "points",
                       .samples = sum.points,
                       .pass = sum.points > 0 && found == 0,
                       .note = {}};
  };
  return {result("A3", "points of triangles whose pixel got no sample", sum.no_sample),
          result("A5", "points that their samples do not bound", sum.not_bounding)};
}

}  // namespace

std::vector<ProbeResult> native_probes() {
  struct Restore {
    std::string target = lane_target();
    ~Restore() { use_lane_target(target); }
  };
  std::vector<ProbeResult> out;
  {
    const Restore restore;
    for (const std::string& target : lane_targets()) {
      use_lane_target(target);
      for (const Kernel& kernel : kernels()) out.push_back(probe(kernel, target));
    }
  }
  for (ProbeResult& r : lemma_probes()) out.push_back(std::move(r));
  return out;
}

}  // namespace farcull
