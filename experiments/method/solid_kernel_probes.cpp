// The probes of A4 for the kernels of both offsets, by the canvas's fragment program, each on
// fattened triangles and on solids made of floats; and the sets of probes that commands run.
#include <algorithm>
#include <utility>

#include "core/gl/probe/probe.h"
#include "experiments/method/kernel_probes_parts.h"
#include "offsets/fit.h"
#include "offsets/minkowski.h"
#include "offsets/obb.h"

namespace farcull {
namespace {

using Check = void (*)(const SolidCase&, const SolidAnswer&, bool ordinary, KernelTally&);
using Fatten = Solid (*)(const KernelTriangle&);
using Adversarial = Solid (*)(std::uint64_t seed, std::uint64_t index, float cx, float cy);

// Fattened triangles of every kind, then solids made of floats directly.
KernelTally solids(const GlContext& context, const KernelProbeOptions& options, SolidProgram solid,
                   Fatten fatten, Adversarial adversarial, Check check) {
  if (options.bare) solid.glsl = "#define FAR_WIDEN 0.0f\n" + solid.glsl;
  KernelTally tally;
  for (const bool direct : {false, true}) {
    std::vector<SolidCase> cases;
    std::vector<bool> ordinary(kSolidCases, false);
    for (std::size_t i = 0; i < kSolidCases; ++i) {
      SolidCase c = solid_case_at(i);
      if (direct) {
        c.solid = adversarial(options.seed, i, c.cx, c.cy);
      } else {
        const KernelTriangle t = kernel_triangle(options.seed, i, c.cx, c.cy);
        ordinary[i] = t.ordinary;
        c.solid = fatten(t);
      }
      cases.push_back(c);
    }
    const std::vector<SolidAnswer> answers = device_solids(context, solid, cases);
    for (std::size_t i = 0; i < kSolidCases; ++i) check(cases[i], answers[i], ordinary[i], tally);
    // A step of the buffer is 0.25 px, then 16 px: mostly about as much as from entry to exit.
    std::vector<SolidCase> stored = cases;
    if (options.late_stores) std::rotate(stored.begin(), stored.begin() + 1, stored.end());
    const std::vector<std::uint8_t> seen =
        device_seen(context, solid, stored, cases, direct ? 0x1p26 : 0x1p20);
    for (std::size_t i = 0; i < kSolidCases; ++i) {
      if (!answers[i].hit) continue;
      ++tally.checked;
      tally.lost += seen[i] == 0;
    }
  }
  return tally;
}

}  // namespace

std::vector<ProbeResult> solid_kernel_probes(const GlContext& context,
                                             const KernelProbeOptions& options) {
  using kernel_probe::result;
  const std::string tried =
      "solid_interval by the canvas's fragment program; triangles of every kind, and floats made "
      "to fail; each is seen behind itself, by the programs with flags and with queries, in both "
      "depth formats";
  return {result("oriented boxes", tried,
                 [&] {
                   return solids(
                       context, options, obb_fattener().solid,
                       [](const KernelTriangle& t) { return obb_of(t.corners, t.radius); },
                       adversarial_box, check_box);
                 }),
          result("exact offsets", tried, [&] {
            return solids(
                context, options, minkowski_fattener().solid,
                [](const KernelTriangle& t) {
                  return minkowski_solid(t.corners[0], t.corners[1], t.corners[2], t.radius);
                },
                adversarial_minkowski, check_minkowski);
          })};
}

std::vector<ProbeResult> all_probes(const GlContext& context,
                                    const std::function<void(const std::string&)>& started) {
  std::vector<ProbeResult> out = run_probes(context, {}, started);
  if (started) started("kernels");
  for (ProbeResult& r : pair_kernel_probes(context)) out.push_back(std::move(r));
  for (ProbeResult& r : solid_kernel_probes(context)) out.push_back(std::move(r));
  std::stable_sort(out.begin(), out.end(), [](const ProbeResult& a, const ProbeResult& b) {
    return std::pair(a.assumption.size(), a.assumption) <
           std::pair(b.assumption.size(), b.assumption);  // A10 after A2
  });
  return out;
}

std::vector<ProbeResult> drawing_probes(const GlContext& context) {
  std::vector<ProbeResult> out = run_probes(context, {.brief = true, .use = ProbeUse::drawing});
  for (ProbeResult& r : solid_kernel_probes(context, {.brief = true})) out.push_back(std::move(r));
  return out;
}

}  // namespace farcull
