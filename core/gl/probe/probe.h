// Probes of the device assumptions A1 to A10. Each probe looks for results that violate an
// assumption. It returns the worst measured value, and the bound that the proofs need
// (docs/budget.md). A probe can refute an assumption, but never prove the assumption.
#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "core/canvas/canvas.h"
#include "core/gl/base/context.h"

namespace farcull {

struct ProbeResult {
  std::string assumption;  // "A1" .. "A10"
  std::string name;
  double measured = 0;  // the worst measured value, in `unit`
  double bound = 0;     // in `unit`
  std::string unit;
  std::uint64_t samples = 0;  // number of comparisons (of edges, pixels, results, ...)
  bool pass = false;          // measured <= bound, and samples > 0
  std::string note;           // details, or the text of the Error that ended the probe
  bool broke_off = false;     // an Error ended the probe, so nothing was measured
};

/// The options from snap_bits on are for tests: each of these options makes a probe fail.
struct ProbeOptions {
  std::uint64_t seed = 1;
  std::string only = {};  // the only assumption to probe, such as "A3"; empty: all
  bool brief = false;     // draws about a third of the samples

  int snap_bits = 0;                // A2: bound 2^-snap_bits px; 0: uses the device's subpixel bits
  bool no_vertex_term = false;      // A1: requires vertex arithmetic without error
  bool dropped_triangle = false;    // A3: drops the second triangle of each proxy
  bool fat_zero_area = false;       // A3: gives an area to the triangles without area
  bool shifted_pixel = false;       // A9: shifts gl_FragCoord by half a pixel
  bool exact_arithmetic = false;    // A4: requires operations without rounding
  bool loose_text = false;          // A4: compiles shaders without `precise`
  bool damaged_operand = false;     // A4, A9: flips one bit of one operand
  bool reversed_depth_map = false;  // A4: maps farther depths nearer
  bool blind_queries = false;       // A6: ends queries too early, or tests unseen solids
  bool damaged_texel = false;       // A5: flips one bit of one texel
  bool skipped_faults = false;      // A7: simulates no fault
  bool plain_atomics = false;       // A8: uses a read and a write instead of an atomic
  bool unordered_reads = false;     // A8: reads values before they are written
  bool one_thread = false;          // A10: counts one more thread of the driver
};

/// Runs groups of probes in the order of the assumptions. Calls `started` (if given) before each
/// group, with its first assumption. The same device and options give the same results. If an Error
/// ends a group, its assumptions fail, and the next group runs. The state of GL is not restored.
std::vector<ProbeResult> run_probes(const GlContext& context, const ProbeOptions& options = {},
                                    const std::function<void(const std::string&)>& started = {});

// The functions below run farcull's kernels on a device, with the canvas's own fragment program.
// verify/kernel_check.h decides whether the answers are right.

/// Side (px) of the square window in which solids are drawn, one in each pixel.
constexpr int kSolidSide = 128;
constexpr std::size_t kSolidCases = std::size_t{kSolidSide} * kSolidSide;
/// Returns a case at the centre of pixel i, without a solid.
inline SolidCase solid_case_at(std::size_t i) {
  constexpr float kHalf = 0.5f * kSolidSide;
  return {static_cast<float>(i % kSolidSide) + 0.5f - kHalf,
          static_cast<float>(i / kSolidSide) + 0.5f - kHalf,
          {}};
}

/// Returns the entry and exit depths of `solid` for kSolidCases cases. Case i has the centre
/// solid_case_at(i). The context is current during the call. Throws Error as GlCanvas does.
std::vector<SolidAnswer> device_solids(const GlContext& context, const SolidProgram& solid,
                                       std::span<const SolidCase> cases);

/// In each of kSolidCases pixels, stores one solid and tests another for visibility. The window's
/// depths are -depth to depth (px). Returns 1 for a pixel if flags, queries, and queries on 24 bits
/// all see the tested solid. If both solids are equal, a pixel whose line hits them must get 1.
std::vector<std::uint8_t> device_seen(const GlContext& context, const SolidProgram& solid,
                                      std::span<const SolidCase> stored,
                                      std::span<const SolidCase> asked, double depth);

}  // namespace farcull
