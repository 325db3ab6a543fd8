// The probes of A4. Kernels of FAR pairs: the device answers all intervals in one dispatch, and
// slices in one for each window. Kernels of both offsets: by the canvas's fragment program, each on
// fattened triangles and on solids made of floats. verify/kernel_check draws the cases and counts
// what answers lose.
#include "experiments/method/kernel_probes.h"

#include <algorithm>
#include <utility>

#include "core/base/error.h"
#include "core/gl/probe/probe.h"
#include "offsets/offsets.h"
#include "verify/kernel_check.h"

namespace farcull {
namespace {

// A probe whose measured value is how much was lost; answers that are loose too often fail it as
// well. One that breaks off by an Error fails.
ProbeResult result(const std::string& name, const std::string& tried,
                   const std::function<KernelTally()>& run) {
  ProbeResult out{.assumption = "A4", .name = name, .unit = "lost", .note = {}};
  try {
    const KernelTally t = run();
    const bool loose = static_cast<double>(t.loose) > kLooseShare * static_cast<double>(t.ordinary);
    out.measured = static_cast<double>(t.lost);
    out.samples = t.checked;
    out.pass = t.checked > 0 && t.lost == 0 && !loose;
    out.note = tried;
    if (t.ordinary > 0) {
      out.note += "; " + std::to_string(t.loose) + " of " + std::to_string(t.ordinary) +
                  " ordinary ones wider than exact by 0.1 px" + (loose ? ": TOO MANY" : "");
    }
  } catch (const Error& error) {
    out.note = error.what();
    out.broke_off = true;
  }
  return out;
}

// Fattened triangles of every kind, then solids made of floats directly.
KernelTally solids(const GlContext& context, const KernelProbeOptions& options,
                   const SolidKernel& kernel) {
  SolidProgram solid = kernel.program;
  if (options.bare) solid.glsl = "#define FAR_WIDEN 0.0f\n" + solid.glsl;
  KernelTally tally;
  for (const bool direct : {false, true}) {
    std::vector<SolidCase> cases;
    std::vector<bool> ordinary(kSolidCases, false);
    for (std::size_t i = 0; i < kSolidCases; ++i) {
      SolidCase c = solid_case_at(i);
      if (direct) {
        c.solid = kernel.adversarial(options.seed, i, c.cx, c.cy);
      } else {
        const KernelTriangle t = kernel_triangle(options.seed, i, c.cx, c.cy);
        ordinary[i] = t.ordinary;
        c.solid = kernel.fatten(t);
      }
      cases.push_back(c);
    }
    const std::vector<SolidAnswer> answers = device_solids(context, solid, cases);
    for (std::size_t i = 0; i < kSolidCases; ++i)
      kernel.check(cases[i], answers[i], ordinary[i], tally);
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

std::vector<SolidKernel> solid_kernels() {
  return {{"oriented boxes", obb_fattener().solid,
           [](const KernelTriangle& t) { return obb_of(t.corners, t.radius); }, adversarial_box,
           check_box},
          {"exact offsets", minkowski_fattener().solid,
           [](const KernelTriangle& t) {
             return minkowski_solid(t.corners[0], t.corners[1], t.corners[2], t.radius);
           },
           adversarial_minkowski, check_minkowski}};
}

std::vector<ProbeResult> pair_kernel_probes(const GlContext& context,
                                            const KernelProbeOptions& options) {
  std::vector<ProbeResult> out;
  out.push_back(result(
      "intervals of FAR pairs",
      "far_bounds, far_margin, far_strip, far_depths; real triangles at their limit, over a pixel",
      [&] {
        const std::size_t count = options.brief ? 600 : 1800;
        KernelTally tally;
        const std::vector<IntervalCase> cases = interval_kernel_cases(options.seed, count);
        const std::vector<IntervalAnswer> answers = device_intervals(
            context, cases, options.bare ? "#define FAR_PAIR_ROUNDING 0.0f\n" : "");
        for (std::size_t i = 0; i < cases.size(); ++i) check_interval(cases[i], answers[i], tally);
        return tally;
      }));
  out.push_back(result(
      "depth slices, float to int",
      "far_slice as rationals give it, at borders of steps and beside them", [&] {
        KernelTally tally;
        for (std::uint64_t window = 0; window < (options.brief ? 3 : 8); ++window) {
          const std::vector<SliceCase> cases = slice_kernel_cases(options.seed * 64 + window, 8192);
          std::vector<SliceCase> sent = cases;
          if (options.reversed_slices) {
            for (SliceCase& c : sent) c.steps_per_px = -c.steps_per_px;
          }
          check_slices(cases, device_slices(context, sent), tally);
        }
        return tally;
      }));
  for (ProbeResult& r : out) {
    r.drawing = false;
    r.pairs = true;
  }
  return out;
}

std::vector<ProbeResult> solid_kernel_probes(const GlContext& context,
                                             const KernelProbeOptions& options) {
  const std::string tried =
      "solid_interval by the canvas's fragment program; triangles of every kind, and floats made "
      "to fail; each is seen behind itself, by the programs with flags and with queries, in both "
      "depth formats";
  std::vector<ProbeResult> out;
  for (const SolidKernel& kernel : solid_kernels())
    out.push_back(result(kernel.name, tried, [&] { return solids(context, options, kernel); }));
  return out;
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
