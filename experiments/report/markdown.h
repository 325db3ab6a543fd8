// The report as Markdown, for a repository or a wiki: the same findings, figures by their files.
#pragma once

#include <string>

#include "experiments/report/page.h"

namespace farcull {

/// results.md: figures/NAME.svg and pictures/NAME.png are looked for beside it. `command`: the one
/// that makes the whole page again, for its readers.
std::string page_markdown(const Page& page, const std::string& command);

/// With what Markdown takes for signs escaped, but not between backticks; one line.
std::string markdown_prose(const std::string& text);

}  // namespace farcull
