// Tests lemmas 1 and 2 (docs/reliability.md) by experiment: draws hard cases of fattened triangles,
// and checks in exact arithmetic whether a pixel's samples bound the depths of points in the pixel.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "core/canvas/fatten.h"
#include "core/cull/cull.h"

namespace farcull {

/// The counts of one generator. A point counts once for each pixel that contains it.
struct LemmaRow {
  std::string generator;
  std::uint64_t points = 0;
  std::uint64_t no_sample = 0;     // points whose pixel got no sample
  std::uint64_t not_bounding = 0;  // points whose depth is outside the samples of their pixel
  std::uint64_t rounded = 0;       // points outside by at most depth_rounding(); 0 without `stored`
  double largest_px = 0;           // largest distance of a depth from the samples' range, in px
  double largest_steps = 0;        // the same distance in steps of the depth buffer
  std::uint64_t violations() const { return no_sample + not_bounding; }
};

/// Returns the names of the generators, in the order of lemma_experiment().
std::vector<std::string> lemma_generators();

struct LemmaSettings {
  std::uint64_t points = 0;    // number of points; each generator gets an equal share
  std::string generator = {};  // the generator to run, with its share of points; empty: all
  std::uint64_t seed = 0;
  /// Returns the radius in px for a view's budget and depth step.
  std::function<double(const Budget& budget, double depth_step)> radius;
  /// True: corners of drawn triangles are displaced by kMaxDoubleError along each axis, the most by
  /// which double arithmetic may err. In half of the triangles, all corners move by one vector; in
  /// the other half, each corner has its own vector.
  bool displace = false;
  /// True: the samples are the values in the depth buffer (Canvas::depths). Errors up to
  /// depth_rounding() then count as LemmaRow::rounded, since monotone rounding loses no pair
  /// (docs/reliability.md, lemma 4).
  bool stored = false;
  int side = 0;        // side of the window in px, even, at least 128; 0: Generator::side
  double depth = 128;  // half the window's depth in px, at least 128
};

/// Returns one row per generator. Throws std::logic_error for an unknown generator.
std::vector<LemmaRow> lemma_experiment(Canvas& canvas, const Fattener& fattener,
                                       const LemmaSettings& settings,
                                       const Progress& progress = {});

/// Returns the radius in px by the rule, for a view's budget and depth step.
double lemma_radius(const RadiusRule& rule, const Budget& budget, double depth_step);

/// Returns a row "all" with the sums of the counts and the maxima of the largest values.
LemmaRow lemma_total(const std::vector<LemmaRow>& rows);

}  // namespace farcull
