// Writes files that appear complete or not at all, and texts that grow during a long run and are
// complete after each addition. Handles signals that end the program.
#pragma once

#include <array>
#include <csignal>
#include <cstddef>
#include <cstdio>
#include <functional>
#include <memory>
#include <string>
#include <string_view>
#include <utility>

namespace farcull {

/// Throws Error naming the path if write_output() would certainly fail: the folder is missing, the
/// path is a directory or too long, a permission is missing, or standard output is closed. Call
/// this function before a long run, so that the run does not fail at its end.
void check_output(const std::string& path);

/// Writes the text to a new file in the same folder, and renames the new file to the path. "-" is
/// standard output. A symbolic link stays, and its target is replaced. Devices and pipes are
/// written to directly. Throws Error naming the path if the text cannot be written. No half-written
/// file is left, even if SIGINT, SIGTERM or SIGHUP ends the program. Precondition: SIGPIPE and
/// SIGXFSZ are ignored (prepare_output()).
void write_output(const std::string& path, const std::string& text);

/// Receives the parts of a text in order.
using TextSink = std::function<void(std::string_view)>;
/// Like write_output() above, for a long text: `write` passes the text part by part to a sink. If
/// `write` throws, the exception is passed on, and an existing file stays unchanged.
void write_output(const std::string& path, const std::function<void(const TextSink&)>& write);

/// Writes help to standard output. A closed pipe is no error, since the reader may stop early, as
/// in `help run | head`. Throws Error as write_output() does if the text cannot be written.
void write_help(const std::string& text);

/// Call once, at the start of the program. Afterwards, writing to a full disk or a closed pipe
/// gives an error instead of a signal, and no opened file gets the descriptor of a standard stream.
void prepare_output();

/// A text that grows by additions and has an end, such as the last bracket of a JSON array. After
/// each addition the file holds all additions and the end. Only a kill or a crash during an
/// addition can cut the text short. The first addition replaces the file as write_output() does.
/// Standard output, devices and pipes get each addition at once, but get the end only from
/// finish().
class GrowingOutput {
 public:
  /// Writes nothing; the first call of add() does.
  explicit GrowingOutput(std::string path) : path_(std::move(path)) {}
  ~GrowingOutput();
  GrowingOutput(const GrowingOutput&) = delete;
  GrowingOutput& operator=(const GrowingOutput&) = delete;

  /// Adds `text`, and replaces the previous end by `end`. Throws Error as write_output() does; a
  /// regular file is then unchanged.
  void add(const std::string& text, const std::string& end);
  /// Ends the text; no add() may follow. The destructor calls finish() and ignores an Error.
  void finish();

 private:
  std::string path_;
  std::string end_;
  bool begun_ = false, finished_ = false, streamed_ = false;
  int file_ = -1;       // descriptor of the file, device or pipe; -1 for standard output
  long long kept_ = 0;  // size of all additions in bytes
};

class HalfWritten;

/// Writes a file in the folder of the path; put() renames the file to the path. Without put() the
/// file is removed, even if SIGINT, SIGTERM or SIGHUP ends the program. Only one StreamedOutput may
/// exist in a process, and write_output() must not be called meanwhile. A symbolic link stays, and
/// its target is replaced.
class StreamedOutput {
 public:
  /// Throws Error naming the path if the path is standard output, a device or a pipe, or if the
  /// file cannot be created.
  explicit StreamedOutput(const std::string& path);
  ~StreamedOutput();
  StreamedOutput(const StreamedOutput&) = delete;
  StreamedOutput& operator=(const StreamedOutput&) = delete;

  /// Appends the text. Throws Error if writing fails.
  void add(std::string_view text);
  /// Path of the file before put(), for a library that opens and writes the file itself.
  const std::string& half() const { return half_; }
  /// Waits until the data are on the disk, then renames the file. Throws Error as add() does.
  void put();

 private:
  std::string path_, place_, half_;
  std::unique_ptr<HalfWritten> part_;
  std::FILE* file_ = nullptr;
};

/// While an object of this class lives, SIGINT, SIGTERM and SIGHUP call the handler. A signal that
/// was ignored before (as under nohup) stays ignored. The destructor restores the previous
/// handlers.
class SignalGuard {
 public:
  explicit SignalGuard(void (*handler)(int)) {
    for (std::size_t i = 0; i < kSignals.size(); ++i) {
      ::sigaction(kSignals[i], nullptr, &before_[i]);
      if (before_[i].sa_handler == SIG_IGN) continue;
      struct sigaction action = {};
      action.sa_handler = handler;
      ::sigaction(kSignals[i], &action, nullptr);
    }
  }
  ~SignalGuard() {
    for (std::size_t i = 0; i < kSignals.size(); ++i)
      ::sigaction(kSignals[i], &before_[i], nullptr);
  }
  SignalGuard(const SignalGuard&) = delete;
  SignalGuard& operator=(const SignalGuard&) = delete;

  /// For handlers: ends the program as the signal does by default.
  static void end_by(int signal) {
    std::signal(signal, SIG_DFL);
    std::raise(signal);
  }

 private:
  static constexpr std::array<int, 3> kSignals = {SIGINT, SIGTERM, SIGHUP};
  std::array<struct sigaction, 3> before_ = {};
};

/// While an object of this class lives, SIGINT, SIGTERM and SIGHUP print one line on standard
/// error, "farcull: interrupted: after DONE of WANTED WHAT; END", and then end the program. There
/// are objects with and without counts (see the constructors). One of each kind may live at once,
/// if the object with counts is created last.
class Interruptible {
 public:
  /// Without counts: the line is "farcull: interrupted; no file was written", or has the number of
  /// written files.
  Interruptible();
  ~Interruptible();
  /// With counts. The texts must outlive this object. terminal: the handler clears the line first.
  Interruptible(long wanted, const char* what, const char* end, bool terminal);

  void done(long count);

 private:
  SignalGuard signals_;
};

}  // namespace farcull
