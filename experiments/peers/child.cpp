// Starts, feeds, times and ends a process. The process cannot block the caller: pipes do not block,
// and a process that exceeds a time limit is killed with its group.
#include "experiments/peers/runner.h"

#include <fcntl.h>
#include <poll.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstring>
#include <optional>
#include <thread>

#include "core/base/error.h"

namespace farcull {
namespace {

using Clock = std::chrono::steady_clock;

[[noreturn]] void refuse(const std::string& program, const char* what) {
  throw Error(program, std::string(what) + ": " + std::strerror(errno),
              "end other programs, or raise the limits of the shell (ulimit)");
}

/// A file descriptor that the destructor closes.
class Descriptor {
 public:
  explicit Descriptor(int fd = -1) : fd_(fd) {}
  ~Descriptor() { close(); }
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;
  int get() const { return fd_; }
  void set(int fd) {
    close();
    fd_ = fd;
  }
  void close() {
    if (fd_ >= 0) ::close(fd_);
    fd_ = -1;
  }

 private:
  int fd_;
};

void make_pipe(const std::string& program, Descriptor& read, Descriptor& write) {
  std::array<int, 2> ends;
  if (::pipe2(ends.data(), O_CLOEXEC) != 0) refuse(program, "no pipe");
  read.set(ends[0]);
  write.set(ends[1]);
}

void limit(int resource, std::uint64_t soft, std::uint64_t hard) {
  const rlimit to = {soft, hard};
  ::setrlimit(static_cast<__rlimit_resource>(resource), &to);
}

constexpr std::uint64_t kMostPrinted = 16 << 20;  // bytes on standard error

/// Runs the program in the new process. Between fork and exec only async-signal-safe functions may
/// be called, since the process has threads. Writes the error to the pipe `failed` if there is no
/// such program.
[[noreturn]] void become(char* const* argv, const ChildLimits& limits, int in, int out, int err,
                         int failed) {
  ::setpgid(0, 0);
  ::prctl(PR_SET_PDEATHSIG, SIGKILL);
  limit(RLIMIT_CORE, 0, 0);
  limit(RLIMIT_CPU, limits.cpu_s, limits.cpu_s + 5);
  limit(RLIMIT_FSIZE, kMostPrinted, kMostPrinted);
  if (limits.memory_mib > 0) limit(RLIMIT_DATA, limits.memory_mib << 20, limits.memory_mib << 20);
  for (const int signal : {SIGPIPE, SIGINT, SIGTERM, SIGHUP}) ::signal(signal, SIG_DFL);
  ::signal(SIGXFSZ, SIG_IGN);
  ::dup2(in, STDIN_FILENO);
  ::dup2(out, STDOUT_FILENO);
  ::dup2(err, STDERR_FILENO);
  ::execvp(argv[0], argv);
  const int error = errno;
  [[maybe_unused]] const ssize_t said = ::write(failed, &error, sizeof error);
  ::_exit(127);
}

/// The last text in the file (standard error of the process), on one line.
std::string last_words(int file, off_t most = 400) {
  const off_t size = ::lseek(file, 0, SEEK_END);
  std::string text(static_cast<std::size_t>(std::clamp<off_t>(size, 0, most)), '\0');
  const ssize_t got = ::pread(file, text.data(), text.size(), std::max<off_t>(0, size - most));
  text.resize(static_cast<std::size_t>(std::max<ssize_t>(got, 0)));
  while (!text.empty() && static_cast<unsigned char>(text.back()) <= ' ') text.pop_back();
  for (char& c : text) {
    if (static_cast<unsigned char>(c) < ' ') c = ' ';
  }
  return text;
}

bool says_no_memory(const std::string& words) {
  for (const char* known : {"bad_alloc", "out of memory", "failed to allocate", "heap limit"}) {
    if (words.find(known) != std::string::npos) return true;
  }
  return false;
}

/// While this object exists, writing to a pipe that nobody reads gives an error instead of a
/// signal.
class NoPipeSignal {
 public:
  NoPipeSignal() {
    struct sigaction ignore = {};
    ignore.sa_handler = SIG_IGN;
    ::sigaction(SIGPIPE, &ignore, &before_);
  }
  ~NoPipeSignal() { ::sigaction(SIGPIPE, &before_, nullptr); }
  NoPipeSignal(const NoPipeSignal&) = delete;
  NoPipeSignal& operator=(const NoPipeSignal&) = delete;

 private:
  struct sigaction before_ = {};
};

class Child {
 public:
  Child(const std::vector<std::string>& command, const ChildLimits& limits)
      : limits_(limits), errors_(::memfd_create("errors", MFD_CLOEXEC)) {
    if (errors_.get() < 0) refuse(command.front(), "no file in memory");
    Descriptor its_in, its_out, failed, its_failed;
    make_pipe(command.front(), failed, its_failed);
    make_pipe(command.front(), its_in, in_);
    make_pipe(command.front(), out_, its_out);
    std::vector<char*> argv;
    for (const std::string& word : command) argv.push_back(const_cast<char*>(word.c_str()));
    argv.push_back(nullptr);
    pid_ = ::fork();
    if (pid_ < 0) refuse(command.front(), "no process");
    if (pid_ == 0)
      become(argv.data(), limits, its_in.get(), its_out.get(), errors_.get(), its_failed.get());
    ::setpgid(pid_, pid_);  // called in both processes, so that the group exists in time
    its_failed.close();
    check_started(command.front(), failed.get());
    for (const Descriptor* end : {&in_, &out_}) ::fcntl(end->get(), F_SETFL, O_NONBLOCK);
    wait_until(limits.start_s);
  }
  ~Child() { end_now(); }
  Child(const Child&) = delete;
  Child& operator=(const Child&) = delete;

  ChildEnd run(const std::function<std::string()>& more,
               const std::function<bool(std::string_view)>& line) {
    bool open = true;
    while (open && !late_ && !wrong_) {
      fill(more);
      wait();
      open = read(line);
      late_ = open && Clock::now() > deadline_;
    }
    if (open) end_now();
    finish();
    return ending();
  }

 private:
  /// Throws if the program did not start. The pipe `failed` closes when the program starts; if it
  /// does not start, the pipe holds the error.
  void check_started(const std::string& program, int failed) {
    int error = 0;
    ssize_t got = 0;
    while ((got = ::read(failed, &error, sizeof error)) < 0 && errno == EINTR) {
    }
    if (got != static_cast<ssize_t>(sizeof error)) return;
    end_now();
    errno = error;
    refuse(program, "cannot be started");
  }

  void wait_until(double seconds) {
    deadline_ = Clock::now() +
                std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(seconds));
  }

  /// Writes as much input as the pipe takes.
  void fill(const std::function<std::string()>& more) {
    while (in_.get() >= 0) {
      if (sent_ == input_.size()) {
        input_ = more();
        sent_ = 0;
        if (input_.empty()) {
          in_.close();
          return;
        }
      }
      const ssize_t wrote = ::write(in_.get(), input_.data() + sent_, input_.size() - sent_);
      if (wrote < 0) {
        if (errno == EINTR) continue;
        if (errno != EAGAIN) in_.close();  // the process no longer reads
        return;
      }
      sent_ += static_cast<std::size_t>(wrote);
    }
  }

  void wait() {
    std::array<pollfd, 2> on = {{{out_.get(), POLLIN, 0}, {in_.get(), POLLOUT, 0}}};
    const auto left =
        std::chrono::duration_cast<std::chrono::milliseconds>(deadline_ - Clock::now()).count() + 1;
    ::poll(on.data(), in_.get() >= 0 ? 2 : 1, static_cast<int>(std::clamp<long>(left, 0, 1000)));
  }

  /// Reads the output of the process. False at the end of the output.
  bool read(const std::function<bool(std::string_view)>& line) {
    std::array<char, 1 << 16> buffer;
    const ssize_t got = ::read(out_.get(), buffer.data(), buffer.size());
    if (got < 0) return errno == EAGAIN || errno == EINTR;
    if (got == 0) return false;
    output_.append(buffer.data(), static_cast<std::size_t>(got));
    std::size_t from = 0;
    for (std::size_t at; (at = output_.find('\n', from)) != std::string::npos; from = at + 1) {
      wait_until(limits_.line_s);
      if (!line(std::string_view(output_).substr(from, at - from))) {
        wrong_ = output_.substr(from, std::min<std::size_t>(at - from, 80));
        return true;
      }
    }
    output_.erase(0, from);
    constexpr std::size_t kLongest = 1 << 20;
    if (output_.size() > kLongest) wrong_ = "a line without an end";
    return true;
  }

  void end_now() {
    if (pid_ > 0) ::kill(-pid_, SIGKILL);
    reap(0);
  }
  bool reap(int options) {
    if (pid_ <= 0) return true;
    const pid_t got = ::wait4(pid_, &status_, options, &usage_);
    if (got == 0 || (got < 0 && errno == EINTR)) return false;
    pid_ = -1;
    return true;
  }
  /// Called at the end of the output: gives the process some time to end by itself.
  void finish() {
    wait_until(limits_.line_s);
    const pid_t group = pid_;
    while (!reap(WNOHANG)) {
      if (Clock::now() > deadline_) {
        late_ = true;
        end_now();
        return;
      }
      std::this_thread::sleep_for(std::chrono::microseconds(200));
    }
    if (group > 0) ::kill(-group, SIGKILL);  // ends processes that the program started, too
  }

  ChildEnd ending() const {
    using How = ChildEnd::How;
    const std::string words = last_words(errors_.get());
    const auto end = [&](How how, std::string reason) {
      if (!words.empty() && !late_ && !wrong_) reason += ": " + words;
      return ChildEnd{how, std::move(reason)};
    };
    if (wrong_) return end(How::crash, "wrote what is no answer: " + *wrong_);
    if (late_) return end(How::time, "no answer within the limit");
    const int signal = WIFSIGNALED(status_) ? WTERMSIG(status_) : 0;
    if (signal == 0 && WEXITSTATUS(status_) == 0) return {How::peace, ""};
    const std::string reason = signal != 0 ? std::string("SIG") + ::sigabbrev_np(signal)
                                           : "exit status " + std::to_string(WEXITSTATUS(status_));
    const double used = static_cast<double>(usage_.ru_utime.tv_sec + usage_.ru_stime.tv_sec);
    if (signal == SIGXCPU || (signal == SIGKILL && used >= static_cast<double>(limits_.cpu_s)))
      return used_up(end(How::time, "CPU time beyond the limit"));
    // A process begins with the peak of its parent, so only a larger peak tells about its own
    // memory.
    const bool nearly_all =
        limits_.memory_mib > 0 && usage_.ru_maxrss > parents_peak_ &&
        static_cast<std::uint64_t>(usage_.ru_maxrss) / 1024 * 4 >= limits_.memory_mib * 3;
    // Node prints a long stack trace after the message.
    if (says_no_memory(last_words(errors_.get(), 1 << 14)) || nearly_all || signal == SIGKILL)
      return used_up(end(How::memory, reason));
    return end(How::crash, reason);
  }
  static ChildEnd used_up(ChildEnd end) {
    end.used_up = true;
    return end;
  }

  static long peak_of_this() {
    rusage usage = {};
    ::getrusage(RUSAGE_SELF, &usage);
    return usage.ru_maxrss;
  }

  const ChildLimits limits_;
  const long parents_peak_ = peak_of_this();  // KiB
  Descriptor errors_, in_, out_;
  pid_t pid_ = -1;
  int status_ = 0;
  rusage usage_ = {};
  Clock::time_point deadline_;
  std::string input_, output_;
  std::size_t sent_ = 0;
  bool late_ = false;
  std::optional<std::string> wrong_;
};

}  // namespace

ChildEnd run_child(const std::vector<std::string>& command, const ChildLimits& limits,
                   const std::function<std::string()>& more,
                   const std::function<bool(std::string_view)>& line) {
  const NoPipeSignal guard;
  return Child(command, limits).run(more, line);
}

}  // namespace farcull
