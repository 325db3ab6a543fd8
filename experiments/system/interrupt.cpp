// Writes the line of an interrupted run, from within the handler of a signal: no memory is taken
// and no lock.
#include "experiments/system/interrupt.h"

#include <unistd.h>

#include <atomic>
#include <cstddef>

namespace farcull {
namespace {

// Read by the handler of signals: atomics without locks alone.
std::atomic<long> items_done = 0, items_wanted = 0;
static_assert(std::atomic<long>::is_always_lock_free);
std::atomic<const char*> items = "", how_it_ends = "";
static_assert(std::atomic<const char*>::is_always_lock_free);
volatile std::sig_atomic_t on_terminal = 0;

constexpr std::size_t kLine = 240;

std::size_t append(char* text, std::size_t at, const char* more) {
  while (*more != '\0' && at < kLine) text[at++] = *more++;
  return at;
}

std::size_t append(char* text, std::size_t at, long number) {
  char digits[24];
  std::size_t n = 0;
  do {
    digits[n++] = static_cast<char>('0' + number % 10);
    number /= 10;
  } while (number > 0);
  while (n > 0 && at < kLine) text[at++] = digits[--n];
  return at;
}

extern "C" void say_how_far(int signal) {
  char text[kLine + 1];
  std::size_t size = append(text, 0, on_terminal ? "\r\033[K" : "");
  size = append(text, size, "farcull: interrupted: after ");
  size = append(text, size, items_done.load());
  size = append(text, size, " of ");
  size = append(text, size, items_wanted.load());
  size = append(text, size, " ");
  size = append(text, size, items.load());
  size = append(text, size, "; ");
  size = append(text, size, how_it_ends.load());
  text[size++] = '\n';
  (void)!::write(STDERR_FILENO, text, size);
  SignalGuard::end_by(signal);
}

void note(long wanted, const char* what, const char* end, bool terminal) {
  items_done = 0;
  items_wanted = wanted;
  items = what;
  how_it_ends = end;
  on_terminal = terminal;
}

}  // namespace

Interruptible::Interruptible(long wanted, const char* what, const char* end, bool terminal)
    : signals_((note(wanted, what, end, terminal), say_how_far)) {}

void Interruptible::done(long count) { items_done = count; }

}  // namespace farcull
