// The probes of A4 that FAR pairs relies on. The device answers all intervals in one dispatch, and
// slices in one for each window; verify/kernel_check draws the cases and counts what answers lose.
#include "core/gl/probe/probe.h"
#include "experiments/method/kernel_probes_parts.h"

namespace farcull {

std::vector<ProbeResult> pair_kernel_probes(const GlContext& context,
                                            const KernelProbeOptions& options) {
  using kernel_probe::result;
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

}  // namespace farcull
