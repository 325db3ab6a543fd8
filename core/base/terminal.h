// Whether a stream is a terminal, and how wide it is: the questions about a terminal that systems
// answer differently.
#pragma once

#include <cstdio>

namespace farcull {

/// True where the stream is a terminal; false too where it is closed.
bool is_terminal(std::FILE* stream);

/// Columns of the stream's terminal as it is now; 0 if the stream is no terminal or does not say.
unsigned terminal_columns(std::FILE* stream);

}  // namespace farcull
