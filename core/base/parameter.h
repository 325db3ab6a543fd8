// Names of parameters in texts. A text names a parameter as {depth_format}, so that nothing below
// the command line knows how its words are written.
#pragma once

#include <string>

namespace farcull {

/// The text as its reader writes parameters: by the name alone, unless the program has another
/// spelling.
std::string spelled(const std::string& text);
/// The program's spelling of a parameter's name, such as --depth-format on a command line; empty:
/// it has no such parameter, so the text stays as it is (a file may be called a{b}.obj). To be
/// called before any thread runs.
void spell_parameters(std::string (*spelling)(const std::string& name));

}  // namespace farcull
