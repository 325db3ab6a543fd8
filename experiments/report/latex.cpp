// Writes a section for each chapter: findings, figures, tables, limits.
#include "experiments/report/latex.h"

#include <fmt/format.h>

#include "experiments/report/chapters/numbers.h"
#include "experiments/report/tables.h"

namespace farcull {
namespace {

constexpr const char* kPreamble = R"(\documentclass[a4paper]{article}
\usepackage{graphicx}
\usepackage[margin=25mm]{geometry}
\IfFileExists{booktabs.sty}{\usepackage{booktabs}}{%
  \let\toprule\hline \let\midrule\hline \let\bottomrule\hline}
% Tables and figures of a section stay in it, however many they are.
\setcounter{topnumber}{9}\setcounter{bottomnumber}{9}\setcounter{totalnumber}{18}
\sloppy
)";

std::string items(const std::vector<std::string>& sentences) {
  if (sentences.empty()) return {};
  std::string out = "\\begin{itemize}\n";
  for (const std::string& text : sentences) out += "  \\item " + latex_text(sentence(text)) + "\n";
  return out + "\\end{itemize}\n";
}

std::string figure(const Figure& figure) {
  return fmt::format(
      "\\begin{{figure}}[htbp]\n  \\centering\n"
      "  \\includegraphics[width=\\linewidth,height=0.8\\textheight,keepaspectratio]"
      "{{figures/{}.pdf}}\n  \\caption{{{} {}}}\n  \\label{{fig:{}}}\n\\end{{figure}}\n",
      figure.name, latex_text(sentence(figure.title)), latex_text(sentence(figure.caption)),
      figure.name);
}

}  // namespace

std::string page_latex(const Page& page) {
  std::string out = std::string(kPreamble) + fmt::format(
                                                 "\\title{{Reliable collision culling: results}}\n"
                                                 "\\author{{farcull {}}}\n\\date{{{}}}\n"
                                                 "\\begin{{document}}\n\\maketitle\n",
                                                 latex_text(page.commit), latex_text(page.written));
  for (const DrawnChapter& drawn : page.chapters) {
    const Chapter& chapter = drawn.chapter;
    out += fmt::format("\n\\section{{{}}}\n{}\n", latex_text(chapter.title),
                       latex_text(chapter.question));
    std::vector<std::string> findings;
    for (const Finding& finding : chapter.findings) findings.push_back(printed(finding));
    out += items(findings);
    for (const Figure& f : chapter.figures) out += figure(f);
    for (const DataTable& table : chapter.tables) {
      if (table.in_text)
        out += fmt::format("{{\\footnotesize\\input{{tables/{}.tex}}}}\n", table.name);
    }
    if (!chapter.limits.empty()) {
      out += "\\paragraph{What it does not show.}\n" + items(chapter.limits);
    }
    out += fmt::format("Measured by {}.\n\\clearpage\n", latex_text(chapter.command));
  }
  return out + "\\end{document}\n";
}

}  // namespace farcull
