// Figures as files: gnuplot draws each as SVG and PDF from a script and a file of data, which stay
// beside them so that a reader can draw them otherwise.
#pragma once

#include <string>

#include "experiments/report/chapters/chapter.h"

namespace farcull {

/// The script for gnuplot: NAME.gp, which reads NAME.dat in its own folder and writes NAME.svg, or
/// NAME.pdf with -e "kind='pdf'".
struct FigureScript {
  std::string script;
  std::string data;
};

/// Throws std::logic_error for a figure that breaks its header: no panel, lengths that differ, a
/// name that is none of a file.
FigureScript figure_script(const Figure& figure);

/// Writes NAME.gp, NAME.dat, NAME.svg and NAME.pdf into the folder, which is there. The SVG carries
/// title and caption for readers who cannot see it. Throws Error where gnuplot is missing, says
/// anything (a warning too), or leaves no file.
void draw_figure(const Figure& figure, const std::string& folder);

/// An SVG of draw_figure() to be put into a page with others: without what stands before <svg>, its
/// ids and what refers to them after `prefix`, as wide as the page lets it be.
std::string inline_svg(const std::string& svg, const std::string& prefix);

}  // namespace farcull
