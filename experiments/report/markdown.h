// The report as Markdown, for a repository or a wiki: the same findings, figures by their files.
#pragma once

#include <string>

#include "experiments/report/page.h"

namespace farcull {

/// results.md: figures/NAME.svg and pictures/NAME.png are looked for beside it. Promises that were
/// not kept stand first. `folder`: of the store, for the command that makes the whole page again.
std::string page_markdown(const Page& page, const std::string& folder);

/// Code within a line, whatever backticks it holds.
std::string markdown_code(const std::string& text);

/// With what Markdown takes for signs escaped, but not between backticks; one line.
std::string markdown_prose(const std::string& text);

}  // namespace farcull
