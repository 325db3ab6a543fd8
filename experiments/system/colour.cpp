// ANSI escape sequences, which every terminal that is not dumb understands.
#include "experiments/system/colour.h"

#include <unistd.h>

#include <cstdlib>
#include <string_view>

namespace farcull {

bool takes_colour(int stream) {
  const char* const unwanted = std::getenv("NO_COLOR");
  const char* const terminal = std::getenv("TERM");
  return ::isatty(stream) == 1 && (unwanted == nullptr || *unwanted == '\0') &&
         terminal != nullptr && std::string_view(terminal) != "dumb";
}

std::string coloured(const std::string& text, Colour colour, int stream) {
  if (!takes_colour(stream)) return text;
  const char* const number = colour == Colour::good ? "32" : colour == Colour::bad ? "31" : "33";
  return std::string("\033[1;") + number + "m" + text + "\033[0m";
}

}  // namespace farcull
