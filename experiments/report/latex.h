// The report as a LaTeX document, for papers: the same findings, figures and tables by their files.
#pragma once

#include <string>

#include "experiments/report/page.h"

namespace farcull {

/// report.tex: figures/NAME.pdf and tables/NAME.tex are looked for beside it. It compiles with
/// pdflatex and the packages of texlive-latex-base; where booktabs is missing, tables have plain
/// rules. Pictures are left out: a PNG of a screen is no figure of a paper.
std::string page_latex(const Page& page);

}  // namespace farcull
