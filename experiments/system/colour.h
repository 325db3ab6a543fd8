// Colours of text on a terminal.
#pragma once

#include <string>

namespace farcull {

enum class Colour { good, bad, doubtful };  // green, red, yellow

/// Whether a stream (STDOUT_FILENO, STDERR_FILENO) takes colours: a terminal that is not dumb, and
/// NO_COLOR is unset or empty (https://no-color.org).
bool takes_colour(int stream);

/// The text in bold and in the colour where the stream takes colours; else as it is.
std::string coloured(const std::string& text, Colour colour, int stream);

}  // namespace farcull
