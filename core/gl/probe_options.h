// Options and results of the probes of a device (core/gl/probe.h).
#pragma once

#include <cstdint>
#include <string>

namespace farcull {

/// The user of an assumption. drawing: the canvas, A1 to A10. pairs: FAR pairs, which rasterizes
/// nothing: A4 in compute shaders, A7 and A8.
enum class ProbeUse { all, drawing, pairs };

struct ProbeResult {
  std::string assumption;  // "A1" .. "A9"
  std::string name;
  double measured = 0;  // the worst seen, in `unit`
  double bound = 0;     // in `unit`
  std::string unit;
  std::uint64_t samples = 0;  // edges, pixels, results, ... that were compared
  bool pass = false;          // measured <= bound, and something was compared
  std::string note;  // what was tried and seen besides; the error's text where the probe broke off
  bool drawing = true;     // drawing relies on it
  bool pairs = false;      // FAR pairs relies on it
  bool broke_off = false;  // an Error ended it: nothing was found out
};

/// All but the first four are deliberate defects, one for each probe, so that tests can see
/// every probe fail.
struct ProbeOptions {
  std::uint64_t seed = 1;
  std::string only = {};         // an assumption, as in "A3"; empty: all of them
  bool brief = false;            // about a third of the samples
  ProbeUse use = ProbeUse::all;  // probes that something else relies on are left out

  int snap_bits = 0;                // A2: demand 2^-snap_bits px instead of what the device says
  bool no_vertex_term = false;      // A1: vertex arithmetic may not err at all
  bool dropped_triangle = false;    // A3: the second triangle of each proxy is lost
  bool fat_zero_area = false;       // A3: the triangles without area get one
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

}  // namespace farcull
