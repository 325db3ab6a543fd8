// Tests lemmas 1 and 2 (docs/reliability.md) by experiment: draws hard cases of fattened triangles,
// and checks in exact arithmetic whether the samples of a pixel bound the points in it.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "core/canvas/fatten.h"
#include "core/cull/cull.h"

namespace farcull {

/// A row per generator. A point counts once for each pixel that contains it.
struct LemmaRow {
  std::string generator;
  std::uint64_t points = 0;
  std::uint64_t no_sample = 0;     // the pixel got no sample
  std::uint64_t not_bounding = 0;  // its samples do not bound the point's depth
  std::uint64_t rounded = 0;       // outside by at most depth_rounding(), so not counted above;
                                   // only with LemmaSettings::stored
  double largest_px = 0;           // the most by which a depth is outside its samples; 0: none
  double largest_steps = 0;        // the same in steps of the depth buffer
  std::uint64_t violations() const { return no_sample + not_bounding; }
};

/// Names of the generators, in the order of the rows.
std::vector<std::string> lemma_generators();

struct LemmaSettings {
  std::uint64_t points = 0;    // in all, shared evenly by the generators
  std::string generator = {};  // the only one to run, with its share of points; empty: all
  std::uint64_t seed = 0;
  /// The radius in px for a view's budget and depth step.
  std::function<double(const Budget& budget, double depth_step)> radius;
  /// Displaces what is drawn by as much as double arithmetic may (kMaxDoubleError per axis and
  /// corner). Half of the triangles move as a whole, which is the budget's "double" term at its
  /// worst; in the others each corner moves by itself, which turns edges.
  bool displace = false;
  /// True: the samples are the values in the depth buffer (Canvas::depths), as needed for
  /// fixed-function depth. A monotone rounding of both ends costs nothing (docs/reliability.md,
  /// lemma 4), so errors up to depth_rounding() are counted apart (LemmaRow::rounded).
  bool stored = false;
  int side = 0;        // px of the window, even, at least 128; 0: the generator's own
  double depth = 128;  // px, half the window's depth, at least 128; if it is more, the triangles
                       // are spread over it
};

/// Throws std::logic_error for an unknown generator.
std::vector<LemmaRow> lemma_experiment(Canvas& canvas, const Fattener& fattener,
                                       const LemmaSettings& settings,
                                       const Progress& progress = {});

/// The radius in px by the rule, for a view's budget and depth step.
double lemma_radius(const RadiusRule& rule, const Budget& budget, double depth_step);

/// A row "all" with the sums of the counts and the maxima of the largest values of all rows.
LemmaRow lemma_total(const std::vector<LemmaRow>& rows);

}  // namespace farcull
