// The figures of the paper (docs/reliability.md, docs/budget.md). Each is drawn from what the
// program's own functions return: proxies, kernels, passes, budget. Nothing in them is typed in but
// the scenes.
#pragma once

#include <string>
#include <vector>

namespace farcull {

struct PaperFigure {
  std::string name;  // of the file docs/figures/NAME.svg
  std::string svg;
};

/// The figures in the order of the paper. `pair`: the path of
/// tests/cases/published-far-loses-this-pair.obj, which the last one is drawn from. Throws Error
/// where it cannot be read.
std::vector<PaperFigure> paper_figures(const std::string& pair);

// Each by itself. Those of paper_cull.cpp come last.
PaperFigure ball_figure();
PaperFigure coverage_figure();
PaperFigure entry_and_exit_figure();
PaperFigure strip_figure();
PaperFigure passes_figure();
PaperFigure published_figure(const std::string& pair);

}  // namespace farcull
