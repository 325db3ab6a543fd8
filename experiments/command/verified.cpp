// Runs the checker that is proved in Coq. The checker reads the scene as 64-bit words, lowest byte
// first: the number of objects, one word per object, then all coordinates (see give_words()).
#include "experiments/command/command.h"

#include <fcntl.h>
#include <spawn.h>
#include <sys/mman.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <bit>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <sstream>

#include "core/base/bytes.h"
#include "experiments/scenes/mesh/text.h"
#include "experiments/system/output_file.h"

namespace farcull {
namespace {

constexpr const char* kProgram = "farcull-check-verified";
constexpr const char* kRemedy =
    "install coq, ocaml-findlib and libzarith-ocaml-dev and build again, or leave --verified out";

[[noreturn]] void refuse(const std::string& what) { throw Error(kProgram, what, kRemedy); }

// Throws Error unless the checker printed these SHA-256 sums, and the verdict that `proved` says.
void require_said(const std::string& said, const std::vector<std::string>& certificates,
                  const std::string& scene, bool proved) {
  std::istringstream lines(said);
  std::vector<std::string> read, scenes;
  std::string line, last;
  while (std::getline(lines, line)) {
    last = line;
    for (auto& [mark, hashes] : {std::pair{std::string("verified   certificate sha256 "), &read},
                                 std::pair{std::string("verified   scene       sha256 "), &scenes}})
      if (line.starts_with(mark)) hashes->push_back(line.substr(mark.size()));
  }
  if (read != certificates || scenes != std::vector<std::string>(certificates.size(), scene))
    refuse("does not say that it read these files: their SHA-256 are not in its output");
  if (proved != last.starts_with("verified   proved: "))
    refuse("ended with a status that is not that of its verdict");
}

// Runs the proved checker. Returns its exit status: 0 proved, 1 refuted or not proved, 2 a file
// that it cannot read. tiles: true if the certificates are those of all tiles, in their order.
// Passes the words of the scene to the checker in a file in memory.
int run_verified_checker(const std::vector<std::string>& certificates, bool tiles,
                         const std::function<void(const TakeWord&)>& words) {
  // The checker inherits the file descriptor, and opens /proc/self/fd/NUMBER.
  const int memory = ::memfd_create("scene", 0);
  std::FILE* file = memory < 0 ? nullptr : ::fdopen(memory, "wb");
  if (file == nullptr) refuse(std::string("no file in memory: ") + std::strerror(errno));
  Sha256 hash;
  std::string block;
  const auto flush = [&] {
    std::fwrite(block.data(), 1, block.size(), file);
    hash.add(block);
    block.clear();
  };
  words([&](std::uint64_t word) {
    for (int k = 0; k < 8; ++k, word >>= 8) block += static_cast<char>(word);
    if (block.size() >= (std::size_t{1} << 16)) flush();
  });
  flush();
  const bool written = std::fflush(file) == 0 && std::ferror(file) == 0;
  std::vector<std::string> hashes;
  for (const std::string& certificate : certificates) {
    hashes.push_back(sha256(read_file(certificate, kMaxCheckedBytes)));
    print("checked    certificate sha256 " + hashes.back() + "\n");
  }
  const std::string scene = hash.digest();
  print("checked    scene       sha256 " + scene + "\n");
  std::fflush(stdout);

  std::error_code none;
  const std::filesystem::path beside =
      std::filesystem::read_symlink("/proc/self/exe", none).parent_path() / kProgram;
  std::string path = std::filesystem::exists(beside, none) ? beside.string() : kProgram;
  std::vector<std::string> given = certificates;
  given.push_back("/proc/self/fd/" + std::to_string(memory));
  std::string option = "--tiles";
  std::vector<char*> arguments = {path.data()};
  if (tiles) arguments.push_back(option.data());
  for (std::string& word : given) arguments.push_back(word.data());
  arguments.push_back(nullptr);
  pid_t child = 0;
  // The checker gets the largest stack, since it recurses on the list of an object's triangles.
  rlimit stack{};
  const bool known = ::getrlimit(RLIMIT_STACK, &stack) == 0;
  const rlimit largest{stack.rlim_max, stack.rlim_max};
  if (known) ::setrlimit(RLIMIT_STACK, &largest);
  std::array<int, 2> pipe{};  // for the output of the checker
  if (::pipe2(pipe.data(), O_CLOEXEC) != 0) refuse(std::string("no pipe: ") + std::strerror(errno));
  posix_spawn_file_actions_t actions;
  ::posix_spawn_file_actions_init(&actions);
  ::posix_spawn_file_actions_adddup2(&actions, pipe[1], STDOUT_FILENO);
  const int error =
      written ? ::posix_spawnp(&child, path.c_str(), &actions, nullptr, arguments.data(), environ)
              : EIO;
  ::posix_spawn_file_actions_destroy(&actions);
  ::close(pipe[1]);
  if (known) ::setrlimit(RLIMIT_STACK, &stack);
  int status = 0;
  std::string said;
  if (error == 0) {
    std::array<char, 4096> some;
    for (ssize_t size = 0; (size = ::read(pipe[0], some.data(), some.size())) != 0;) {
      if (size < 0 && errno == EINTR) continue;
      if (size < 0) break;
      said.append(some.data(), static_cast<std::size_t>(size));
    }
    while (::waitpid(child, &status, 0) < 0 && errno == EINTR) {
    }
  }
  ::close(pipe[0]);
  std::fclose(file);
  write_output("-", said);
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
  constexpr int kUnread = 2;
  if (WEXITSTATUS(status) != kUnread) require_said(said, hashes, scene, WEXITSTATUS(status) == 0);
  return WEXITSTATUS(status);
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

void check_again(const CheckArguments& arguments, const std::vector<std::string>& files,
                 const std::function<void(const TakeWord&)>& words, int status) {
  const int verified = run_verified_checker(files, arguments.tiles.has_value(), words);
  if ((verified == kExitDone) == (status == kExitDone)) return;
  throw Error("--verified", "the two checkers disagree about " + clean_name(arguments.certificate),
              "keep the certificate and the scene, and report them: one of the checkers is wrong");
}

}  // namespace farcull
