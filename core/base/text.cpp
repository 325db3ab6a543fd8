// Asks about a terminal by POSIX, or by the C runtime and the console of Windows.
#include "core/base/text.h"

#ifdef _WIN32
#include <io.h>
// windows.h after io.h, without its macros min and max.
#define NOMINMAX
#include <windows.h>
#else
#include <sys/ioctl.h>
#include <unistd.h>
#endif

namespace farcull {

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
