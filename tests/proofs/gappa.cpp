// Gappa reads a file and says on stderr what it cannot prove; its status is 0 if it proved all.
#include "tests/proofs/gappa.h"

#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <stdexcept>

namespace farcull::proofs {
namespace {

// A file that is removed at the end of its scope.
class TemporaryFile {
 public:
  explicit TemporaryFile(const std::string& text)
      : path_(std::filesystem::temp_directory_path() / "farcull-proof-XXXXXX") {
    std::string name = path_.string();
    const int file = mkstemp(name.data());
    if (file < 0) throw std::runtime_error("proofs: no temporary file");
    close(file);
    path_ = name;
    std::ofstream(path_) << text;
  }
  ~TemporaryFile() { std::filesystem::remove(path_); }
  TemporaryFile(const TemporaryFile&) = delete;
  TemporaryFile& operator=(const TemporaryFile&) = delete;
  std::string name() const { return path_.string(); }

 private:
  std::filesystem::path path_;
};

int run(const std::string& command, std::string& said) {
  FILE* const pipe = popen(command.c_str(), "r");
  if (pipe == nullptr) throw std::runtime_error("proofs: cannot run gappa");
  std::array<char, 4096> buffer;
  while (std::fgets(buffer.data(), buffer.size(), pipe) != nullptr) said += buffer.data();
  const int status = pclose(pipe);
  return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
}

}  // namespace

bool has_gappa() {
  std::string said;
  return run("command -v gappa 2>&1", said) == 0;
}

Answer ask_gappa(const std::string& script) {
  const TemporaryFile file(script);
  std::string said;
  // 60 bits, the default, are too few for errors of a few 2^-53. Without dichotomy: each claim is
  // proved in one piece, or not at all.
  const int status =
      run("gappa -Eprecision=200 -Eno-auto-dichotomy '" + file.name() + "' 2>&1", said);
  const bool understood = status == 0 ||
                          said.find("some properties were not satisfied") != std::string::npos ||
                          said.find("no contradiction was found") != std::string::npos;
  if (!understood || said.find("Warning") != std::string::npos) {
    throw std::runtime_error("proofs: gappa says\n" + said + "about\n" + script);
  }
  return {status == 0, said};
}

}  // namespace farcull::proofs
