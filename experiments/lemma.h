// Lemmas 1 and 2 as an experiment: points of triangles that aim at trouble, rasterized with their
// fattened triangles on a canvas, decided in exact arithmetic.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "core/canvas.h"
#include "core/cull.h"
#include "core/fatten.h"

namespace farcull {

/// A row per generator. A point counts once for each pixel that contains it.
struct LemmaRow {
  std::string generator;
  std::uint64_t points = 0;
  std::uint64_t no_sample = 0;     // the pixel got no sample
  std::uint64_t not_bounding = 0;  // its samples do not bound the point's depth
  std::uint64_t violations() const { return no_sample + not_bounding; }
};

/// Names of the generators, in the order of the rows.
std::vector<std::string> lemma_generators();

struct LemmaSettings {
  std::uint64_t points = 0;  // in all, shared evenly by the generators
  std::uint64_t seed = 0;
  /// The radius in px for a view's budget and depth step.
  std::function<double(const Budget& budget, double depth_step)> radius;
  /// Displaces what is drawn by as much as double arithmetic may (kMaxDoubleError per axis), away
  /// from the pixel centre: the budget's "double" term at its worst.
  bool displace = false;
};

std::vector<LemmaRow> lemma_experiment(Canvas& canvas, const Fattener& fattener,
                                       const LemmaSettings& settings,
                                       const Progress& progress = {});

/// The sum of all rows, named "all".
LemmaRow lemma_total(const std::vector<LemmaRow>& rows);

}  // namespace farcull
