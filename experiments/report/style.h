// How series look: one colour, dash and point for a method in every figure of a report.
//
// The colours are those of Okabe and Ito (2008) and of Tol's "muted" scheme, told apart with any
// colour vision; dashes and points tell the same apart in grey.
#pragma once

#include <string>
#include <vector>

#include "experiments/report/chapters/chapter.h"

namespace farcull {

struct SeriesStyle {
  std::string colour;  // #rrggbb
  int dash = 0;        // 0: solid; else an index into dashes()
  int point = 7;       // gnuplot's number of the point
};

/// gnuplot's dash types by SeriesStyle::dash, such as "(8,4)"; the first is "solid".
const std::vector<std::string>& dashes();

/// The style of each name of a figure. Names that begin with the same method (far, cullide,
/// fcl-...) share its colour, the later ones with other dashes and points; names of no method take
/// colours that no method has, in their order. Up to ten names of one method, and up to a hundred
/// of none, all differ in colour or point.
std::vector<SeriesStyle> styles_of(const std::vector<std::string>& names);

/// The names of a figure's series, each once, in the order of first appearance.
std::vector<std::string> series_names(const Figure& figure);

}  // namespace farcull
