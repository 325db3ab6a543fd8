// Finds the intended word by edit distance. Asks POSIX or Windows about the terminal.
#include "core/base/text.h"

#include <algorithm>
#include <cctype>

#ifdef _WIN32
#include <io.h>
// NOMINMAX keeps windows.h from defining the macros min and max.
#define NOMINMAX
#include <windows.h>
#else
#include <sys/ioctl.h>
#include <unistd.h>
#endif

namespace farcull {
namespace {

// Returns the least number of edits that turn `a` into `b` (optimal string alignment distance).
// The comment at likely_word() in text.h defines an edit. apart[i][k] is the distance between the
// first i letters of `a` and the first k letters of `b`.
std::size_t letters_apart(const std::string& a, const std::string& b) {
  std::vector<std::vector<std::size_t>> apart(a.size() + 1, std::vector<std::size_t>(b.size() + 1));
  const auto same = [&](std::size_t i, std::size_t k) {
    return std::tolower(static_cast<unsigned char>(a[i])) ==
           std::tolower(static_cast<unsigned char>(b[k]));
  };
  for (std::size_t i = 0; i <= a.size(); ++i) {
    for (std::size_t k = 0; k <= b.size(); ++k) {
      std::size_t& least = apart[i][k] = std::max(i, k);
      if (i == 0 || k == 0) continue;
      least = std::min(
          {apart[i - 1][k] + 1, apart[i][k - 1] + 1, apart[i - 1][k - 1] + !same(i - 1, k - 1)});
      if (i > 1 && k > 1 && same(i - 1, k - 2) && same(i - 2, k - 1))
        least = std::min(least, apart[i - 2][k - 2] + 1);
    }
  }
  return apart[a.size()][b.size()];
}

}  // namespace

std::string likely_word(const std::string& word, const std::vector<std::string>& known) {
  constexpr std::size_t kLongest = 40, kFew = 2;
  std::string best;
  std::size_t least = kFew + 1;
  for (const std::string& name : known) {
    if (word.size() > kLongest || name.size() > kLongest) continue;
    const std::size_t apart = letters_apart(word, name);
    if (apart < least && 2 * apart < word.size()) least = apart, best = name;
  }
  return best;
}

#ifdef _WIN32

bool is_terminal(std::FILE* stream) { return ::_isatty(::_fileno(stream)) != 0; }

unsigned terminal_columns(std::FILE* stream) {
  CONSOLE_SCREEN_BUFFER_INFO info = {};
  const auto console = reinterpret_cast<HANDLE>(::_get_osfhandle(::_fileno(stream)));
  if (!::GetConsoleScreenBufferInfo(console, &info)) return 0;
  return static_cast<unsigned>(info.srWindow.Right - info.srWindow.Left + 1);
}

#else

bool is_terminal(std::FILE* stream) { return ::isatty(::fileno(stream)) != 0; }

unsigned terminal_columns(std::FILE* stream) {
  winsize size = {};
  return ::ioctl(::fileno(stream), TIOCGWINSZ, &size) == 0 ? size.ws_col : 0;
}

#endif

}  // namespace farcull
