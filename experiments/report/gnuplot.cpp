// Starts gnuplot as a child process and takes any output of it for a failure.
#include "experiments/report/gnuplot.h"

#include <fcntl.h>
#include <poll.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstring>
#include <vector>

#include "core/base/error.h"

extern char** environ;

namespace farcull {
namespace {

constexpr const char* kRemedy = "install it (Debian: gnuplot-nox), or run experiments/setup.sh";

struct Answer {
  int status = 0;
  std::string said;  // on both outputs
};

// The environment with a locale that writes numbers with points and knows UTF-8.
std::vector<std::string> environment() {
  std::vector<std::string> out;
  for (char** entry = environ; *entry != nullptr; ++entry) {
    const std::string text = *entry;
    if (text.starts_with("LC_") || text.starts_with("LANG=") || text.starts_with("GNUTERM=") ||
        text.starts_with("GNUPLOT")) {
      continue;
    }
    out.push_back(text);
  }
  out.push_back("LC_ALL=C.UTF-8");
  return out;
}

std::vector<char*> pointers(std::vector<std::string>& texts) {
  std::vector<char*> out;
  for (std::string& text : texts) out.push_back(text.data());
  out.push_back(nullptr);
  return out;
}

Answer run(std::vector<std::string> arguments, const std::string& folder) {
  std::array<int, 2> ends = {};
  if (::pipe2(ends.data(), O_CLOEXEC) != 0) {
    throw Error("gnuplot", std::strerror(errno), "close other programs and try again");
  }
  posix_spawn_file_actions_t actions;
  ::posix_spawn_file_actions_init(&actions);
  ::posix_spawn_file_actions_addopen(&actions, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
  ::posix_spawn_file_actions_adddup2(&actions, ends[1], STDOUT_FILENO);
  ::posix_spawn_file_actions_adddup2(&actions, ends[1], STDERR_FILENO);
  if (!folder.empty()) ::posix_spawn_file_actions_addchdir_np(&actions, folder.c_str());
  std::vector<std::string> variables = environment();
  const std::vector<char*> argv = pointers(arguments), envp = pointers(variables);
  pid_t child = 0;
  const int failure =
      ::posix_spawnp(&child, "gnuplot", &actions, nullptr, argv.data(), envp.data());
  ::posix_spawn_file_actions_destroy(&actions);
  ::close(ends[1]);
  if (failure != 0) {
    ::close(ends[0]);
    if (failure == ENOENT) throw Error("gnuplot", "is not installed", kRemedy);
    throw Error("gnuplot", std::string("cannot be run: ") + std::strerror(failure), kRemedy);
  }
  Answer answer;
  std::array<char, 4096> buffer = {};
  for (;;) {
    const ssize_t count = ::read(ends[0], buffer.data(), buffer.size());
    if (count < 0 && errno == EINTR) continue;
    if (count <= 0) break;
    answer.said.append(buffer.data(), static_cast<std::size_t>(count));
  }
  ::close(ends[0]);
  while (::waitpid(child, &answer.status, 0) < 0 && errno == EINTR) {
  }
  return answer;
}

// The first lines, as one.
std::string shortened(const std::string& said) {
  std::string out;
  for (const char c : said) {
    const bool blank = static_cast<unsigned char>(c) <= ' ';
    if (blank && (out.empty() || out.back() == ' ')) continue;
    out += blank ? ' ' : c;
    if (out.size() >= 400) break;
  }
  while (!out.empty() && out.back() == ' ') out.pop_back();
  return out;
}

}  // namespace

void require_gnuplot() {
  const Answer answer = run({"gnuplot", "--version"}, "");
  if (answer.status != 0)
    throw Error("gnuplot", "does not run: " + shortened(answer.said), kRemedy);
}

void run_gnuplot(const std::string& folder, const std::string& script, const std::string& kind) {
  const Answer answer =
      run({"gnuplot", "--default-settings", "-e", "kind='" + kind + "'", script}, folder);
  if (answer.status == 0 && shortened(answer.said).empty()) return;
  const std::string how = WIFSIGNALED(answer.status)
                              ? "was ended by signal " + std::to_string(WTERMSIG(answer.status))
                          : answer.status != 0 ? "failed"
                                               : "warned";
  throw Error("gnuplot " + script, how + ": " + shortened(answer.said),
              "see the script; gnuplot 5.4 is what it is written for");
}

std::string gnuplot_text(const std::string& text) {
  std::string out = "'";
  for (const char c : text) {
    if (c == '\'') out += '\'';
    const auto byte = static_cast<unsigned char>(c);
    out += byte < ' ' || byte == 127 ? ' ' : c;
  }
  return out + "'";
}

}  // namespace farcull
