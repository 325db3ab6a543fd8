// Texts in HTML and SVG.
#pragma once

#include <string>

namespace farcull {

/// With &, <, > and quotes as references; control characters but line ends become blanks.
std::string html_text(const std::string& text);

/// The same, and what stands between backticks as code.
std::string html_prose(const std::string& text);

}  // namespace farcull
