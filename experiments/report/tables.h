// Tables as files: CSV for programs, LaTeX (booktabs) for papers, HTML for the page.
#pragma once

#include <string>

#include "experiments/report/chapters/chapter.h"

namespace farcull {

/// The names of the columns.
std::vector<std::string> names_of(const std::vector<Column>& columns);

/// RFC 4180: cells in quotes where they have to be, a header row. Numbers are as people read them.
std::string table_csv(const DataTable& table);

/// A float with caption, label tab:NAME and the rules of the package booktabs.
std::string table_latex(const DataTable& table);

/// <table> without a caption.
std::string table_html(const DataTable& table);

/// Everything that the store holds of the study, a line for each row: the axes, then all counts and
/// times by their names, the device, the run, and why nothing was measured.
std::string rows_csv(const StoredStudy& stored);

/// Plain text in LaTeX: characters of commands are escaped, signs that no text font has become
/// mathematics.
std::string latex_text(const std::string& text);

}  // namespace farcull
