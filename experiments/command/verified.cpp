// The scene is written as 64-bit words, lowest byte first, so that the proved checker needs no
// reader of meshes: the number of objects, the sizes of the objects, then all coordinates.
#include "experiments/command/check.h"

#include <spawn.h>
#include <sys/mman.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <bit>
#include <cerrno>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <fstream>

#include "core/base/bytes.h"
#include "core/base/error.h"
#include "experiments/system/output_file.h"

namespace farcull {
namespace {

constexpr const char* kProgram = "farcull-check-verified";
constexpr const char* kRemedy =
    "install coq, ocaml-findlib and libzarith-ocaml-dev and build again, or leave --verified out";

[[noreturn]] void refuse(const std::string& what) { throw Error(kProgram, what, kRemedy); }

std::string program() {
  std::error_code error;
  const std::filesystem::path beside =
      std::filesystem::read_symlink("/proc/self/exe", error).parent_path() / kProgram;
  return std::filesystem::exists(beside, error) ? beside.string() : kProgram;
}

// Writes words, lowest byte first, and hashes them.
class WordFile {
 public:
  explicit WordFile(std::FILE* file) : file_(file) {}
  void add(std::uint64_t word) {
    for (int k = 0; k < 8; ++k, word >>= 8) block_ += static_cast<char>(word);
    if (block_.size() >= (std::size_t{1} << 16)) flush();
  }
  void flush() {
    std::fwrite(block_.data(), 1, block_.size(), file_);
    hash_.add(block_);
    block_.clear();
  }
  std::string digest() { return hash_.digest(); }

 private:
  std::FILE* file_;
  std::string block_;
  Sha256 hash_;
};

std::string sha256_of_file(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  Sha256 hash;
  std::string block(std::size_t{1} << 16, '\0');
  while (file.read(block.data(), static_cast<std::streamsize>(block.size())) || file.gcount() > 0)
    hash.add(std::string_view(block).substr(0, static_cast<std::size_t>(file.gcount())));
  return hash.digest();
}

}  // namespace

void give_coordinates(const Scene& scene, const TakeWord& take) {
  for (std::uint32_t t = 0; t < scene.triangles.size(); ++t) {
    for (const Vec3& p : scene.corners(t)) {
      for (int i = 0; i < 3; ++i) take(std::bit_cast<std::uint64_t>(p[i]));
    }
  }
}

void give_words(const Scene& scene, const TakeWord& take) {
  take(scene.objects.size());
  for (const Object& object : scene.objects)
    take(object.triangle_count | std::uint64_t{object.self} << 32);
  give_coordinates(scene, take);
}

int run_verified_checker(const std::vector<std::string>& certificates, bool tiles,
                         const std::function<void(const TakeWord&)>& words) {
  // The new process inherits the descriptor, and opens the file by its number.
  const int memory = ::memfd_create("scene", 0);
  std::FILE* file = memory < 0 ? nullptr : ::fdopen(memory, "wb");
  if (file == nullptr) refuse(std::string("no file in memory: ") + std::strerror(errno));
  WordFile out(file);
  words([&](std::uint64_t word) { out.add(word); });
  out.flush();
  const bool written = std::fflush(file) == 0 && std::ferror(file) == 0;
  for (const std::string& certificate : certificates)
    write_output("-", "checked    certificate sha256 " + sha256_of_file(certificate) + "\n");
  write_output("-", "checked    scene       sha256 " + out.digest() + "\n");
  std::fflush(stdout);

  std::string path = program();
  std::vector<std::string> given = certificates;
  given.push_back("/proc/self/fd/" + std::to_string(memory));
  std::string option = "--tiles";
  std::vector<char*> arguments = {path.data()};
  if (tiles) arguments.push_back(option.data());
  for (std::string& word : given) arguments.push_back(word.data());
  arguments.push_back(nullptr);
  pid_t child = 0;
  // Lists of the checker are as long as objects have triangles, and some of its functions recur.
  rlimit stack{};
  const bool known = ::getrlimit(RLIMIT_STACK, &stack) == 0;
  const rlimit largest{stack.rlim_max, stack.rlim_max};
  if (known) ::setrlimit(RLIMIT_STACK, &largest);
  const int error =
      written ? ::posix_spawnp(&child, path.c_str(), nullptr, nullptr, arguments.data(), environ)
              : EIO;
  if (known) ::setrlimit(RLIMIT_STACK, &stack);
  int status = 0;
  if (error == 0) {
    while (::waitpid(child, &status, 0) < 0 && errno == EINTR) {
    }
  }
  std::fclose(file);
  if (error != 0) refuse(std::string("cannot be run: ") + std::strerror(error));
  constexpr int kUndecided = 3, kTooSmall = 4;
  if (WIFEXITED(status) && WEXITSTATUS(status) == kTooSmall) {
    throw Error(kProgram, "ran out of stack or memory",
                "raise the limit, as ulimit -s unlimited does");
  }
  if (WIFEXITED(status) && WEXITSTATUS(status) == kUndecided) {
    throw Error(kProgram, "could not decide the pair that it names",
                "leave --verified out, and report the scene: docs/verified.md says why this should "
                "not happen");
  }
  if (!WIFEXITED(status) || WEXITSTATUS(status) > kUndecided) refuse("ended without a verdict");
  return WEXITSTATUS(status);
}

}  // namespace farcull
