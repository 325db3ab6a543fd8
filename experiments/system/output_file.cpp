// Writes a new file in the folder of the destination, then renames the file to the destination.
// Signal handlers allocate no memory and take no lock.
#include "experiments/system/output_file.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <climits>
#include <cstdio>
#include <cstring>
#include <filesystem>

#include "core/base/error.h"
#include "core/base/text.h"

namespace farcull {

namespace {

// The signal handler prints `message`. The text is prepared beforehand, since a handler must not
// allocate memory. There are two buffers: the handler may read one buffer while the other buffer is
// filled.
std::array<std::array<char, 512>, 2> buffers;
std::atomic<const char*> message = "farcull: interrupted; no file was written\n";
static_assert(std::atomic<const char*>::is_always_lock_free);

long items_done = 0, items_wanted = 0, files_written = 0;
const char *items = "", *how_it_ends = "";
bool on_terminal = false;

// Allocates no memory, since destructors call this function and must not throw.
void make_message() {
  std::array<char, 512>& buffer = buffers[message == buffers[0].data() ? 1 : 0];
  const char* const start = on_terminal ? "\r\033[K" : "";
  if (items_wanted > 0) {
    std::snprintf(buffer.data(), buffer.size(), "%sfarcull: interrupted: after %ld of %ld %s; %s\n",
                  start, items_done, items_wanted, items, how_it_ends);
  } else if (files_written > 0) {
    std::snprintf(buffer.data(), buffer.size(),
                  "%sfarcull: interrupted; files that are written: %ld\n", start, files_written);
  } else {
    std::snprintf(buffer.data(), buffer.size(), "%sfarcull: interrupted; no file was written\n",
                  start);
  }
  message = buffer.data();
}

extern "C" void say_how_far(int signal) {
  const char* const text = message;
  (void)!::write(STDERR_FILENO, text, std::strlen(text));
  SignalGuard::end_by(signal);
}

constexpr const char* kStdoutRemedy = "let it go to a place that takes it, such as a file";
constexpr const char* kPathRemedy = "give a path in a folder with room that you may write to";

[[noreturn]] void refuse(const std::string& path, int code) {
  const bool standard = path == "-";
  throw Error(standard ? "standard output" : path,
              std::string("cannot be written: ") + std::strerror(code),
              standard ? kStdoutRemedy : kPathRemedy);
}

// The file that a path names, after links are followed. A regular or new file is written under
// another name, then renamed. Other files are `direct`: they are written in place.
struct Target {
  std::string path;
  bool exists = false;
  bool direct = false;
  mode_t mode = 0;  // mode of an existing file
};

Target target_of(const std::string& path) {
  Target target{.path = path};
  struct stat link = {}, status = {};
  target.exists = ::stat(path.c_str(), &status) == 0;
  const bool is_link = ::lstat(path.c_str(), &link) == 0 && S_ISLNK(link.st_mode);
  // A link in /dev or /proc, such as /dev/stdout, may lead to a file that another program has open.
  const bool kernels = path.starts_with("/dev/") || path.starts_with("/proc/");
  target.mode = status.st_mode;
  target.direct = (target.exists && !S_ISREG(status.st_mode)) || (is_link && kernels);
  if (is_link && target.exists && !target.direct)
    target.path = std::filesystem::canonical(path).string();
  return target;
}

std::string folder_of(const std::string& path) {
  const std::string folder = std::filesystem::path(path).parent_path().string();
  return folder.empty() ? "." : folder;
}

// The path of the file that is being written; empty between files.
char half_written[4096] = "";

// Returns the path of the half-written file for `path`: the same folder and name, with a suffix. If
// the name is too long for the file system, the name is cut, but not within a UTF-8 character.
std::string beside(const std::string& path) {
  const std::string end = ".part-" + std::to_string(::getpid());
  const std::size_t name = path.rfind('/') + 1;  // 0 if there is no folder
  const long most = ::pathconf(folder_of(path).c_str(), _PC_NAME_MAX);
  const std::size_t room = (most > 0 ? static_cast<std::size_t>(most) : NAME_MAX) - end.size();
  std::size_t size = std::min(path.size(), name + room);
  while (size > name && size < path.size() && (path[size] & 0xC0) == 0x80) --size;
  return path.substr(0, size) + end;
}

extern "C" void remove_half_written(int signal) {
  ::unlink(half_written);
  say_how_far(signal);
}

}  // namespace

// A file that is being written. The destructor removes the file unless put() renamed the file. If a
// signal ends the program, the signal handler removes the file. Only one object of this class may
// exist at a time.
class HalfWritten {
 public:
  // Precondition: the path fits into half_written.
  explicit HalfWritten(const std::string& path) : name_(path), signals_(remove_half_written) {}
  ~HalfWritten() {
    if (!in_place_) ::unlink(half_written);
  }

  int put(const std::string& place) {
    if (std::rename(half_written, place.c_str()) != 0) return errno;
    in_place_ = true;
    ++files_written;
    make_message();
    return 0;
  }

 private:
  // Sets half_written before the handler is installed, and clears it after the handler is removed.
  struct Name {
    explicit Name(const std::string& path) {
      path.copy(half_written, path.size());
      half_written[path.size()] = '\0';
    }
    ~Name() { half_written[0] = '\0'; }
  };
  Name name_;
  SignalGuard signals_;
  bool in_place_ = false;
};

namespace {

// Writes the whole text: from byte `at` of the file on, or at the current position if `at` is
// negative. Returns 0 or the errno of the first failure.
int write_all(int file, const std::string& text, long long at) {
  for (std::size_t done = 0; done < text.size();) {
    const ssize_t n = at < 0 ? ::write(file, text.data() + done, text.size() - done)
                             : ::pwrite(file, text.data() + done, text.size() - done,
                                        at + static_cast<long long>(done));
    if (n < 0 && errno == EINTR) continue;
    if (n <= 0) return n < 0 ? errno : EIO;
    done += static_cast<std::size_t>(n);
  }
  return 0;
}

void note(long wanted, const char* what, const char* end, bool terminal) {
  items_done = 0;
  items_wanted = wanted;
  items = what;
  how_it_ends = end;
  on_terminal = terminal;
  make_message();
}

}  // namespace

Interruptible::Interruptible(long wanted, const char* what, const char* end, bool terminal)
    : signals_((note(wanted, what, end, terminal), say_how_far)) {}

Interruptible::Interruptible() : Interruptible(0, "", "", is_terminal(stderr)) {}

Interruptible::~Interruptible() {
  items_wanted = 0;
  make_message();
}

void Interruptible::done(long count) {
  items_done = count;
  make_message();
}

void check_output(const std::string& path) {
  if (path == "-") {
    const int flags = ::fcntl(STDOUT_FILENO, F_GETFL);
    if (flags < 0 || (flags & O_ACCMODE) == O_RDONLY) refuse(path, EBADF);
    return;
  }
  const Target target = target_of(path);
  if (S_ISDIR(target.mode)) refuse(path, EISDIR);
  struct stat status = {};
  if (!target.exists && ::lstat(path.c_str(), &status) != 0 && errno == ENAMETOOLONG)
    refuse(path, errno);
  if (!target.direct && beside(target.path).size() >= sizeof half_written)
    refuse(path, ENAMETOOLONG);
  if (target.exists && ::access(target.path.c_str(), W_OK) != 0) refuse(path, errno);
  if (!target.direct && ::access((folder_of(target.path) + "/").c_str(), W_OK | X_OK) != 0)
    refuse(path, errno);
}

void write_output(const std::string& path, const std::string& text) {
  write_output(path, [&](const TextSink& sink) { sink(text); });
}

StreamedOutput::StreamedOutput(const std::string& path) : path_(path) {
  check_output(path);
  const Target target = target_of(path);
  if (path == "-" || target.direct) {
    throw Error(path == "-" ? "standard output" : path, "cannot appear whole or not at all",
                "name a file");
  }
  place_ = target.path;
  half_ = beside(place_);
  if (half_.size() >= sizeof half_written) refuse(path_, ENAMETOOLONG);
  part_ = std::make_unique<HalfWritten>(half_);
  file_ = std::fopen(half_.c_str(), "wb");
  if (file_ == nullptr) refuse(path_, errno);
  if (target.exists) ::fchmod(::fileno(file_), target.mode & 07777);
}

StreamedOutput::~StreamedOutput() {
  if (file_ != nullptr) std::fclose(file_);
}

void StreamedOutput::add(std::string_view text) {
  if (std::fwrite(text.data(), 1, text.size(), file_) != text.size()) refuse(path_, errno);
}

void StreamedOutput::put() {
  if (std::fflush(file_) != 0 || ::fsync(::fileno(file_)) != 0) refuse(path_, errno);
  if (std::fclose(std::exchange(file_, nullptr)) != 0) refuse(path_, errno);
  if (const int failure = part_->put(place_)) refuse(path_, failure);
}

void write_output(const std::string& path, const std::function<void(const TextSink&)>& write) {
  check_output(path);
  if (path != "-" && !target_of(path).direct) {
    StreamedOutput file(path);
    write([&](std::string_view text) { file.add(text); });
    file.put();
    return;
  }
  const auto close = [](std::FILE* file) {
    return file == stdout ? std::fflush(file) : std::fclose(file);
  };
  std::unique_ptr<std::FILE, decltype(close)> file(
      path == "-" ? stdout : std::fopen(path.c_str(), "wb"), close);
  if (!file) refuse(path, errno);
  write([&](std::string_view text) {
    if (std::fwrite(text.data(), 1, text.size(), file.get()) != text.size()) refuse(path, errno);
  });
  if (close(file.release()) != 0) refuse(path, errno);
}

void write_help(const std::string& text) {
  check_output("-");
  if (std::fwrite(text.data(), 1, text.size(), stdout) == text.size() && std::fflush(stdout) == 0)
    return;
  if (errno != EPIPE) refuse("-", errno);
}

GrowingOutput::~GrowingOutput() {
  try {
    finish();
  } catch (const Error&) {
    // A destructor must not throw. A regular file is already complete; a stream may lack its end.
  }
  if (file_ >= 0) ::close(file_);
}

void GrowingOutput::add(const std::string& text, const std::string& end) {
  if (!begun_) {
    check_output(path_);
    streamed_ = path_ == "-" || target_of(path_).direct;
    if (!streamed_) write_output(path_, text + end);
    if (path_ != "-") {
      file_ = ::open(path_.c_str(), O_WRONLY | O_CLOEXEC);
      if (file_ < 0) refuse(path_, errno);
    }
    begun_ = true;
    if (!streamed_) {
      kept_ = static_cast<long long>(text.size());
      end_ = end;
      return;
    }
  }
  if (streamed_) {
    end_ = end;
    if (path_ == "-") {
      write_output(path_, text);
    } else if (const int failure = write_all(file_, text, -1)) {
      refuse(path_, failure);
    }
    return;
  }
  if (const int failure = write_all(file_, text + end, kept_)) {
    // Restores the previous end. The file had these bytes before, so the disk has room for them.
    (void)write_all(file_, end_, kept_);
    (void)!::ftruncate(file_, kept_ + static_cast<long long>(end_.size()));
    refuse(path_, failure);
  }
  kept_ += static_cast<long long>(text.size());
  end_ = end;
  if (::ftruncate(file_, kept_ + static_cast<long long>(end_.size())) != 0) refuse(path_, errno);
}

void GrowingOutput::finish() {
  if (!begun_ || std::exchange(finished_, true)) return;
  if (!streamed_) {
    if (::fsync(file_) != 0) refuse(path_, errno);
  } else if (path_ == "-") {
    write_output(path_, end_);
  } else if (const int failure = write_all(file_, end_, -1)) {
    refuse(path_, failure);
  }
}

void prepare_output() {
  std::signal(SIGPIPE, SIG_IGN);
  std::signal(SIGXFSZ, SIG_IGN);
  // If a standard stream is closed, the next opened file would get the descriptor of the stream,
  // and output for the stream would go into that file. So /dev/null takes the descriptor. It is
  // opened in the mode that makes every use of the stream fail.
  for (const int stream : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO}) {
    if (::fcntl(stream, F_GETFD) < 0)
      (void)!::open("/dev/null", stream == STDIN_FILENO ? O_WRONLY : O_RDONLY);
  }
}

}  // namespace farcull
