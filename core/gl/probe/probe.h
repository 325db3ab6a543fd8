// Probes of the device assumptions A1 to A10. Each probe tries to catch the device breaking an
// assumption. It reports the worst measured value and the bound that the proofs need
// (docs/budget.md). A probe can refute an assumption, but never prove it.
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
  std::uint64_t samples = 0;  // edges, pixels, results, ... that were compared
  bool pass = false;          // measured <= bound, and something was compared
  std::string note;           // details, or the text of the Error that ended the probe
  bool broke_off = false;     // an Error ended the probe: nothing is known
};

/// The options from snap_bits on are for tests: each option makes a probe fail.
struct ProbeOptions {
  std::uint64_t seed = 1;
  std::string only = {};  // one assumption, as in "A3"; empty: all
  bool brief = false;     // about a third of the samples

  int snap_bits = 0;                // A2: demands 2^-snap_bits px; 0: the device's own bits
  bool no_vertex_term = false;      // A1: vertex arithmetic may not err at all
  bool dropped_triangle = false;    // A3: the second triangle of each proxy is lost
  bool fat_zero_area = false;       // A3: the triangles without area get an area
  bool shifted_pixel = false;       // A9: gl_FragCoord is half a pixel off
  bool exact_arithmetic = false;    // A4: operations may not round
  bool loose_text = false;          // A4: shaders without `precise`
  bool damaged_operand = false;     // A4, A9: one bit of one operand changes on its way
  bool reversed_depth_map = false;  // A4: farther is mapped nearer
  bool blind_queries = false;       // A6: queries end before their draws or ask in front of all
  bool damaged_texel = false;       // A5: one bit of one texel changes on its way
  bool skipped_faults = false;      // A7: no fault happens
  bool plain_atomics = false;       // A8: a read and a write instead of an atomic
  bool unordered_reads = false;     // A8: what is read may not have been written yet
  bool one_thread = false;          // A10: the driver draws in a thread of its own
};

/// Runs the probes in the order of the assumptions. If `started` is given, it is called with the
/// assumption before each group. The same device and options give the same results. A probe that
/// ends with an Error fails; the others go on. The state of GL is not restored.
std::vector<ProbeResult> run_probes(const GlContext& context, const ProbeOptions& options = {},
                                    const std::function<void(const std::string&)>& started = {});

// The functions below run farcull's kernels on a device as its methods do, with the canvas's own
// fragment program. verify/kernel_check.h decides whether the answers are right.

/// Side (px) of the square window on which solids are asked, one in each pixel.
constexpr int kSolidSide = 128;
constexpr std::size_t kSolidCases = std::size_t{kSolidSide} * kSolidSide;
/// The pixel centre at which case i is asked.
inline SolidCase solid_case_at(std::size_t i) {
  constexpr float kHalf = 0.5f * kSolidSide;
  return {static_cast<float>(i % kSolidSide) + 0.5f - kHalf,
          static_cast<float>(i / kSolidSide) + 0.5f - kHalf,
          {}};
}

/// Returns the answers of `solid` for kSolidCases cases. Case i has the centre of solid_case_at(i).
/// Makes the context current while it runs, and throws Error as GlCanvas does.
std::vector<SolidAnswer> device_solids(const GlContext& context, const SolidProgram& solid,
                                       std::span<const SolidCase> cases);

/// In each of kSolidCases pixels, stores one solid and asks another in a window of this depth (px).
/// Returns per pixel 1 if the asked solid is seen in three ways: with flags, with queries, and with
/// queries on 24 bits. A solid must be seen behind itself if the pixel's line hits it.
std::vector<std::uint8_t> device_seen(const GlContext& context, const SolidProgram& solid,
                                      std::span<const SolidCase> stored,
                                      std::span<const SolidCase> asked, double depth);

}  // namespace farcull
