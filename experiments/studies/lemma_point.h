// The lemma experiment (experiments/lemma.h) as a point of a study: one generator on one canvas.
#pragma once

#include <cstdint>
#include <string>

#include "experiments/studies/lab.h"

namespace farcull {

/// What stands in Point::scene: lemma:GENERATOR:POINTS:DEPTH.
struct LemmaScene {
  std::string generator;     // one of lemma_generators()
  std::uint64_t points = 0;  // of this generator, at least
  double depth = 256;        // px, of the window

  std::string name() const;
};
/// Precondition: the text is a name(); std::logic_error otherwise.
LemmaScene parse_lemma_scene(const std::string& text);

/// Point::method: "lemma" on the lab's device, "lemma-worst" on verify/worst_canvas.h with what is
/// drawn displaced as far as double arithmetic may. depth_mode "fixed": the boxes as surfaces.
/// depth_format: given, or with fixed depth: the samples are what a buffer of it holds
/// (LemmaSettings::stored); not given: what the shader computes. resolution: the window's side; 0:
/// the generator's own. counts: points, violations, no_sample, not_bounding, rounded, largest_px,
/// largest_steps, step_px (of the depth buffer), radius_px, budget_px, promises (fragment depth at
/// the budget radius or more: a violation breaks the guarantee). times: total.
Measurement measure_lemma(const Point& point, Lab& lab);

}  // namespace farcull
